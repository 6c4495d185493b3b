#include "export/formats.hpp"
#include "export/units.hpp"
#include "preproc/command/caller.hpp"
#include "preproc/command/console.hpp"
#include "preproc/command/deck_needs.hpp"
#include "preproc/command/flags.hpp"
#include "preproc/command/loaded_mesh.hpp"
#include "preproc/command/option_text.hpp"
#include "preproc/command/output_files.hpp"
#include "preproc/command/piped_files.hpp"
#include "preproc/command/progress_display.hpp"
#include "preproc/command/quality_fields.hpp"
#include "preproc/command/sub_commands.hpp"
#include "preproc/command/write_mesh.hpp"
#include "preproc/command/written_file_flags.hpp"
#include "preproc/mesh/error.hpp"
#include "preproc/mesh/error_text.hpp"
#include "preproc/mesh/joined.hpp"
#include "preproc/mesh/length_unit.hpp"

namespace scan2fea::command {
namespace {

struct ConvertFlags {
  std::filesystem::path input;
  std::filesystem::path output;
  bool force = false;
  std::optional<std::string> unit, scale;
  std::vector<std::filesystem::path> references;  // several are bodies
  std::optional<DeckKind> deck;
  std::size_t parts = 0;          // of a volume mesh; 0: it is not divided
  std::vector<std::string> sets;  // NEW=OLD
  MshVersion msh_version = MshVersion::v4_1;
  bool ascii = false;
  NumberFlags numbering;
  PipeFlags formats;
  DisplayFlags display;
};

void settle_unit(MeshFile& mesh, const ConvertFlags& flags, ProgressDisplay& display) {
  const std::string name = flags.input.string();
  std::visit([&](auto& held) { held.unit = settled_unit(held.unit, flags.unit, name); }, mesh.mesh);
  if (flags.scale) {
    const UnitScale scale = parse_unit_scale(*flags.scale);
    apply_scale(mesh, scale, name);
    display.line("converted from " + scale.from + " to " + scale.to + ": coordinates times " +
                 error_text(scale.factor()));
  }
  const std::string& unit = std::visit([](const auto& held) -> const std::string& { return held.unit; }, mesh.mesh);
  if (!length_unit(unit)) return;
  const auto& points =
      mesh.is_volume() ? std::get<TetMesh>(mesh.mesh).nodes : std::get<NamedSurface>(mesh.mesh).mesh.vertices;
  if (const auto doubt = implausible_size(bounding_box(points).diagonal(), unit)) warn(name + ": " + *doubt);
}

// What is lost is told even where nothing else is.
void tell(const Notes& notes) {
  for (const std::string& note : notes) warn(note);
}

void name_sets_again(MeshFile& mesh, const ConvertFlags& flags) {
  if (auto* volume = std::get_if<TetMesh>(&mesh.mesh)) {
    add_named_again(flags.sets, volume->node_sets, volume->face_sets, &volume->element_sets);
  } else {
    auto& surface = std::get<NamedSurface>(mesh.mesh);
    add_named_again(flags.sets, surface.node_sets, surface.face_sets, nullptr);
  }
}

void require_deck(const TetMesh& mesh, const ConvertFlags& flags) {
  DeckSubject subject{
      .input = flags.input.string(), .sets = {}, .offered = {}, .points = &mesh.nodes, .unit = mesh.unit};
  for (const NamedSet& set : mesh.face_sets) subject.offered.push_back(set.name);
  subject.sets = subject.offered;
  for (const NamedSet& set : mesh.node_sets) subject.sets.push_back(set.name);
  require_for_deck(*flags.deck, subject);
}

void require_usable(const ConvertFlags& flags) {
  if (!writes_volume(flags.output) && !writes_surface(flags.output))
    throw WrongUsage({.what = "unknown format of the output",
                      .where = flags.output.string(),
                      .value = flags.output.extension().string(),
                      .limit = {},
                      .advice = known_volume_formats() + ", " + known_surface_formats_to_write()});
  require_parts_fit(flags.output, flags.parts);
  const FileFormat& format = *find_format(flags.output);
  if (!flags.references.empty() && !holds_fields(format.volume) && !holds_fields(format.surface))
    throw WrongUsage({.what = "the format holds no distances from a reference",
                      .where = flags.output.string(),
                      .value = "--reference",
                      .limit = {},
                      .advice = ".vtu, .vtp, or scan2fea check --reference"});
}

void scale(SurfaceMesh& surface, const ConvertFlags& flags) {
  if (!flags.scale) return;
  for (Vec3& p : surface.vertices) p *= parse_unit_scale(*flags.scale).factor();
}

// In the unit of what is written; nothing where none is given.
std::optional<SurfaceMesh> read_reference(const MeshFile& read, const ConvertFlags& flags) {
  if (flags.references.empty()) return {};
  const std::string unit = std::visit([](const auto& mesh) { return mesh.unit; }, read.mesh);
  LoadedReference reference = load_references(flags.references, unit, flags.display.caller);
  if (!reference.surface)
    throw WrongUsage({.what = "the reference is a point cloud, which has no sides",
                      .where = flags.references.front().string(),
                      .value = {},
                      .limit = {},
                      .advice = "a surface: scan2fea reconstruct"});
  scale(*reference.surface, flags);
  return std::move(reference.surface);
}

void tell_other_arrays(const MeshFile& read, const ConvertFlags& flags) {
  std::vector<std::string> names;
  for (const std::string& name : read.other_arrays) {
    const bool is_made_again = is_quality_field(name) || (name == "deviation" && !flags.references.empty());
    if (!is_made_again) names.push_back(name);
  }
  if (!names.empty())
    tell({flags.input.string() + ": values of points and cells are not kept: left out " + joined(names)});
}

// Of what a program made the distances are from what it was made of, where nothing else is given.
void take_reference(const MemoryMesh& given, const ConvertFlags& flags, std::optional<SurfaceMesh>& reference) {
  const FileFormat& format = *find_format(flags.output);
  if (reference || !given.reference || !(holds_fields(format.volume) || holds_fields(format.surface))) return;
  reference = *given.reference;
  scale(*reference, flags);
}

int convert(ConvertFlags flags) {
  const PipedOutput piped(flags.output, flags.formats.to);
  std::vector<OutputPath> files;
  if (!piped.is_pipe()) add_outputs(files_of_volume(flags.output, flags.parts), files);
  flags.output = piped.file();
  if (flags.deck && piped.is_pipe())
    throw WrongUsage(
        {.what = "a deck names its mesh", .where = "--deck", .value = "-o -", .limit = {}, .advice = "-o FILE"});
  if (flags.deck) files.push_back({deck_file(flags.output, *flags.deck)});
  std::vector<std::filesystem::path> inputs{flags.input};
  inputs.insert(inputs.end(), flags.references.begin(), flags.references.end());
  require_writable(files, inputs, flags.force);
  require_usable(flags);
  std::optional<ProgressDisplay> own;
  ProgressDisplay& display = display_of(flags.display, own);
  display.begin("read");
  const MemoryMesh* given = flags.display.caller != nullptr ? flags.display.caller->input(0) : nullptr;
  MeshFile read = given != nullptr ? mesh_in(*given) : read_mesh(file_to_read(flags.input, flags.formats.from));
  for (const std::string& warning : read.warnings) tell({flags.input.string() + ": " + warning});
  tell_other_arrays(read, flags);
  std::optional<SurfaceMesh> reference = read_reference(read, flags);
  if (given != nullptr) take_reference(*given, flags, reference);
  const MeasuredFrom from{.reference = reference ? &*reference : nullptr,
                          .measured_vertices = given != nullptr ? given->measured_vertices : std::nullopt};
  settle_unit(read, flags, display);
  name_sets_again(read, flags);
  OutputFiles outputs;
  FileOptions options{
      .provenance = given != nullptr && !given->provenance.empty() ? given->provenance : name_of_input(flags.input),
      .msh_version = flags.msh_version,
      .element_fields = {},
      .node_fields = {},
      .ascii = flags.ascii,
      .set_prefix = flags.numbering.set_prefix,
      .numbers = flags.numbering.numbers,
      .together = &outputs};
  tell(keep_numbers(read, flags.output, options));
  if (const auto* surface = std::get_if<NamedSurface>(&read.mesh)) {
    if (!writes_surface(flags.output))
      throw WrongUsage({.what = "a surface holds no tetrahedra to write",
                        .where = flags.input.string(),
                        .value = {},
                        .limit = {},
                        .advice = "scan2fea tetrahedralize, or scan2fea run"});
    tell(write_mesh(*surface, flags.output, from, options));
  } else if (auto& mesh = std::get<TetMesh>(read.mesh); writes_volume(flags.output)) {
    if (const std::string told = divide(mesh, flags.parts, options); !told.empty()) display.line(told);
    if (flags.deck) {
      require_deck(mesh, flags);
      outputs.add(files.back().file, deck_text(mesh, flags.output, *flags.deck, options));
    }
    tell(write_mesh(mesh, flags.output, from, options));
  } else {
    display.line("the boundary was written; " + flags.output.string() + " holds no tetrahedra");
    Notes notes;
    const NamedSurface boundary = named_boundary(mesh, notes);
    tell(notes);
    tell(write_mesh(boundary, flags.output, from, options));
  }
  outputs.commit();
  piped.send();
  display.finish();
  return 0;
}

}  // namespace

SubCommand add_convert(CLI::App& root) {
  const auto flags = std::make_shared<ConvertFlags>();
  CLI::App* app =
      root.add_subcommand("convert", "Between all formats; a volume mesh into a surface gives its boundary");
  app->group(look_group);
  app->footer("Volume meshes: " + known_volume_formats() + "\nSurfaces: " + known_surface_formats_to_write() +
              "\n\nExamples:\n"
              "  scan2fea convert part.inp -o part.msh\n"
              "  zcat part.stl.gz | scan2fea convert - --from stl -o - --to obj > part.obj");
  app->add_option("input", flags->input, "What to read")->required()->type_name("FILE");
  add_output_flag(*app, flags->output);
  add_from_flag(*app, flags->formats.from);
  add_to_flag(*app, flags->formats.to);
  add_force_flag(*app, flags->force);
  add_unit_flag(*app, flags->unit);
  const OptionGroup group(*app, "What files hold");
  app->add_option("--scale", flags->scale, "Convert from one unit to another, e.g. mm:m")->type_name("FROM:TO");
  app->add_flag("--ascii", flags->ascii, "STL and PLY as text");
  app->add_option("--set", flags->sets, "A set of the input gets another name, too: fixed=CLAMP")
      ->type_name("NEW=OLD")
      ->allow_extra_args(false);
  app->add_option("--reference", flags->references,
                  "For viewers, also each point's signed distance from this surface, usually the scan; of several "
                  "bodies, the option for each")
      ->type_name("FILE")
      ->allow_extra_args(false);
  add_deck_flag(*app, flags->deck);
  add_parts_flag(*app, flags->parts);
  add_msh_version_flag(*app, flags->msh_version);
  add_number_flags(*app, flags->numbering);
  add_display_flags(*app, flags->display);
  return {app, [flags] { return convert(*flags); }, &flags->display};
}

}  // namespace scan2fea::command
