#include "export/formats.hpp"
#include "export/units.hpp"
#include "preproc/command/caller.hpp"
#include "preproc/command/console.hpp"
#include "preproc/command/expected_stages.hpp"
#include "preproc/command/face_files.hpp"
#include "preproc/command/figures.hpp"
#include "preproc/command/gates_asked.hpp"
#include "preproc/command/option_text.hpp"
#include "preproc/command/sub_commands.hpp"
#include "preproc/mesh/error.hpp"
#include "preproc/surface/repair/repair.hpp"

#include <nlohmann/json.hpp>

#include <cstdio>

namespace scan2fea::command {
namespace {

struct FacesFlags {
  CommonFlags common;
  std::optional<std::filesystem::path> output;
  RepairOptions repair;
  SimplifyOptions simplify;  // for its features
};

// A surface of any format, or the boundary of a volume mesh.
NamedSurface read_part(CommonFlags& flags) {
  NamedSurface surface;
  if (const MemoryMesh* given = flags.caller != nullptr ? flags.caller->input(0) : nullptr) {
    surface = surface_in(*given);
  } else {
    MeshFile read = read_mesh(file_to_read(flags.input, flags.formats.from));
    surface = read.is_volume() ? named_boundary(std::get<TetMesh>(read.mesh), read.warnings)
                               : std::get<NamedSurface>(std::move(read.mesh));
    for (const std::string& warning : read.warnings) warn(flags.input.string() + ": " + warning);
  }
  const std::string unit = settled_unit(surface.unit, flags.unit, flags.input.string());
  if (!unit.empty()) flags.unit = unit;
  return surface;
}

// Names that the file has, which --set takes as well as those of the faces.
Json given_sets(const NamedSurface& surface) {
  Json list = Json::array();
  for (const NamedSet& set : surface.face_sets) {
    double area = 0;
    for (const std::uint32_t f : set.members) area += area_vector(surface.mesh, surface.mesh.triangles[f]).norm() / 2;
    list.push_back({{"name", set.name}, {"kind", "faces"}, {"area", area}, {"triangles", set.members.size()}});
  }
  return list;
}

std::vector<NamedSet> sets_of(const SurfaceFaces& faces) {
  std::vector<NamedSet> sets;
  for (const SurfaceFace& face : faces.list) sets.push_back(named_set(face.name, face.triangles));
  return sets;
}

Subject subject_of(const SurfaceMesh& mesh, const std::vector<NamedSet>& sets, const CommonFlags& flags) {
  Subject subject;
  subject.surface = &mesh;
  subject.face_sets = &sets;
  subject.inputs = {{"scan", flags.input}};
  subject.first_element = 0;
  return subject;
}

int list_faces(FacesFlags flags) {
  const std::vector<Gate> gates = gates_for(parse_gates(flags.common), false);
  if (flags.output && !is_face_file(*flags.output))
    throw WrongUsage({.what = "unknown format of the output",
                      .where = flags.output->string(),
                      .value = flags.output->extension().string(),
                      .limit = {},
                      .advice = ".ply, .vtp (surface) or .vtu (VTK)"});
  std::vector<OutputPath> files = report_outputs(flags.common);
  if (flags.output) files.push_back({*flags.output});
  require_writable(files, inputs_of(flags.common), flags.common.force);
  std::optional<ProgressDisplay> own;
  ProgressDisplay& display = display_of(flags.common, own);
  display.begin("read");
  NamedSurface surface = read_part(flags.common);
  SurfaceMesh& mesh = surface.mesh;
  display.line(describe_input(mesh, flags.common));
  const Json given = given_sets(surface);
  display.expect(expected_faces(static_cast<double>(mesh.triangles.size())));
  display.begin("repair");
  repair(mesh, flags.repair, display.progress());
  display.begin("faces");
  const SurfaceFaces faces = find_faces(mesh, flags.simplify.features, display.progress());

  OutputFiles outputs;
  std::string table = face_table(faces);
  for (const Json& set : given) {
    char line[160];
    std::snprintf(line, sizeof line, "%-9.80s set       area %-10.6g of the file\n",
                  set["name"].get_ref<const std::string&>().c_str(), set["area"].get<double>());
    table += line;
  }
  Json report{{"schema", report_schema}, {"input", flags.common.input.string()}};
  if (flags.common.unit) report["unit"] = *flags.common.unit;
  report["noise"] = faces.noise;
  report["faces"] = face_list(faces);
  report["sets"] = given;
  report["gates"] = Json::array();
  surface = {
      .mesh = std::move(mesh), .node_sets = {}, .face_sets = sets_of(faces), .unit = flags.common.unit.value_or("")};
  const std::vector<GateResult> results =
      finish_report(report, subject_of(surface.mesh, surface.face_sets, flags.common), flags.common, gates, outputs);
  const bool passed = all_pass(results);
  if (flags.output && passed)
    for (const std::string& note : write_face_file(surface, faces, *flags.output, outputs))
      if (!flags.common.quiet) warn(note);
  if (!flags.common.quiet && flags.common.caller == nullptr && flags.common.json != "-" && flags.common.junit != "-")
    write_to_stdout(table);
  tell_failures(results, flags.common.input);
  outputs.commit();
  display.finish();
  if (flags.common.caller != nullptr && passed)
    flags.common.caller->made = std::make_shared<MemoryMesh>(MemoryMesh{
        .held = MeshFile{.mesh = std::move(surface), .numbers = {}, .warnings = {}}, .name = flags.common.input});
  return passed ? 0 : 1;
}

}  // namespace

SubCommand add_faces(CLI::App& root) {
  const auto flags = std::make_shared<FacesFlags>();
  CLI::App* app = root.add_subcommand("faces", "The faces of a part: names for --set, what each is, figures, areas");
  app->group(look_group);
  app->footer(
      "Examples:\n"
      "  scan2fea faces part.stl -o faces.vtu");
  add_common_flags(*app, flags->common);
  const OptionGroup group(*app, "Files");
  app->add_option("-o,--output", flags->output, "Write the surface with the number of each triangle's face")
      ->type_name("FILE.ply|vtp|vtu");
  add_repair_flags(*app, flags->repair);
  add_feature_angle_flag(*app, flags->simplify.features);
  return {app, [flags] { return list_faces(*flags); }, &flags->common};
}

}  // namespace scan2fea::command
