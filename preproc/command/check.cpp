#include "export/formats.hpp"
#include "preproc/command/figures.hpp"
#include "preproc/command/sub_commands.hpp"
#include "preproc/mesh/error.hpp"
#include "preproc/mesh/read_surface.hpp"

namespace scan2fea::command {
namespace {

struct CheckFlags {
  CommonFlags common;
  std::optional<std::filesystem::path> reference;
};

// The surface, or a volume mesh's boundary.
struct Loaded {
  SurfaceMesh surface;
  std::optional<TetMesh> volume_mesh;
};

Loaded load(const std::filesystem::path& file) {
  if (!volume_format(file)) return {.surface = read_surface(file), .volume_mesh = {}};
  Loaded loaded;
  loaded.volume_mesh = read_volume(file);
  loaded.surface = boundary_surface(*loaded.volume_mesh);
  return loaded;
}

int check(const CheckFlags& flags) {
  const std::vector<Gate> gates = parse_gates(flags.common);
  std::vector<std::filesystem::path> inputs = inputs_of(flags.common);
  if (flags.reference) inputs.push_back(*flags.reference);
  require_writable(report_outputs(flags.common), inputs, flags.common.force);
  ProgressDisplay display(flags.common.quiet);
  const Loaded mesh = load(flags.common.input);
  display.line(describe_input(mesh.surface, flags.common));
  std::optional<SurfaceMesh> reference;
  if (flags.reference) reference = load(*flags.reference).surface;
  const Subject subject{.surface = &mesh.surface,
                        .reference = reference ? &*reference : nullptr,
                        .solid_volume = {},
                        .volume_mesh = mesh.volume_mesh ? &*mesh.volume_mesh : nullptr,
                        .stages = nullptr,
                        .repaired = nullptr};
  StagedOutputs outputs;
  const bool all_pass = report_figures(subject, flags.common, gates, display, outputs);
  outputs.commit();
  return all_pass ? 0 : 1;
}

}  // namespace

SubCommand add_check(CLI::App& root) {
  const auto flags = std::make_shared<CheckFlags>();
  CLI::App* app = root.add_subcommand("check", "Figures and gates of a surface or a volume mesh");
  add_common_flags(*app, flags->common);
  app->add_option("--reference", flags->reference, "What the surface is compared with, usually the scan")
      ->type_name("FILE");
  return {app, [flags] { return check(*flags); }};
}

}  // namespace scan2fea::command
