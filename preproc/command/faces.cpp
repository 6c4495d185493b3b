#include "preproc/command/face_files.hpp"
#include "preproc/command/figures.hpp"
#include "preproc/command/sub_commands.hpp"
#include "preproc/mesh/error.hpp"
#include "preproc/mesh/read_surface.hpp"
#include "preproc/surface/repair/repair.hpp"

#include <nlohmann/json.hpp>

namespace scan2fea::command {
namespace {

struct FacesFlags {
  CommonFlags common;
  std::optional<std::filesystem::path> output;
  RepairOptions repair;
  SimplifyOptions simplify;  // for its features
};

int list_faces(const FacesFlags& flags) {
  if (flags.output && !is_face_file(*flags.output))
    throw WrongUsage({.what = "unknown format of the output",
                      .where = flags.output->string(),
                      .value = flags.output->extension().string(),
                      .limit = {},
                      .advice = ".ply, .vtp (surface) or .vtu (VTK)"});
  std::vector<OutputPath> files = report_outputs(flags.common);
  if (flags.output) files.push_back({*flags.output});
  require_writable(files, inputs_of(flags.common), flags.common.force);
  ProgressDisplay display(flags.common.quiet);
  SurfaceMesh mesh = read_surface(flags.common.input);
  display.line(describe_input(mesh, flags.common));
  repair(mesh, flags.repair, display.progress());
  const SurfaceFaces faces = find_faces(mesh, flags.simplify.features, display.progress());

  StagedOutputs outputs;
  const std::string table = face_table(faces);
  Json report{{"schema", "scan2fea/1"}, {"input", flags.common.input.string()}};
  if (flags.common.unit) report["unit"] = *flags.common.unit;
  report["noise"] = faces.noise;
  report["faces"] = face_list(faces);
  if (flags.common.json) outputs.add_json(report, *flags.common.json);
  if (flags.common.report) outputs.add_report(report, table, *flags.common.report);
  if (flags.output) outputs.add(*flags.output, face_file(mesh, faces, *flags.output));
  if (!flags.common.quiet && flags.common.json != "-") write_to_stdout(table);
  outputs.commit();
  return 0;
}

}  // namespace

SubCommand add_faces(CLI::App& root) {
  const auto flags = std::make_shared<FacesFlags>();
  CLI::App* app = root.add_subcommand("faces", "The faces of a part: names for --set, what each is, figures, areas");
  add_common_flags(*app, flags->common);
  app->add_option("-o,--output", flags->output, "Write the surface with the number of each triangle's face")
      ->type_name("FILE.ply|vtp|vtu");
  add_repair_flags(*app, flags->repair);
  add_feature_angle_flag(*app, flags->simplify.features);
  return {app, [flags] { return list_faces(*flags); }};
}

}  // namespace scan2fea::command
