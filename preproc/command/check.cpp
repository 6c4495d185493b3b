#include "export/formats.hpp"
#include "export/units.hpp"
#include "preproc/command/figures.hpp"
#include "preproc/command/output_files.hpp"
#include "preproc/command/sub_commands.hpp"
#include "preproc/mesh/error.hpp"
#include "preproc/mesh/error_text.hpp"
#include "preproc/mesh/read_cloud.hpp"
#include "preproc/surface/features/feature_file.hpp"
#include "preproc/surface/repair/openings.hpp"
#include "quality/curved_surface.hpp"

#include <algorithm>

namespace scan2fea::command {
namespace {

struct CheckFlags {
  CommonFlags common;
  std::optional<std::filesystem::path> reference;
  std::optional<std::filesystem::path> leaks;
};

// The surface, or a volume mesh's boundary.
struct Loaded {
  SurfaceMesh surface;
  std::optional<TetMesh> volume_mesh;
  std::string unit;  // that the file says; empty where it says none
};

Loaded load(const std::filesystem::path& file) {
  MeshFile read = read_mesh(file);
  if (auto* surface = std::get_if<NamedSurface>(&read.mesh))
    return {.surface = std::move(surface->mesh), .volume_mesh = {}, .unit = std::move(surface->unit)};
  Loaded loaded;
  loaded.volume_mesh = std::get<TetMesh>(std::move(read.mesh));
  loaded.surface = boundary_surface(*loaded.volume_mesh);
  loaded.unit = loaded.volume_mesh->unit;
  return loaded;
}

// A cloud tells distances of its points only. Of a mesh of second order the surface is curved, in flat pieces, and the
// volume is told.
void load_reference(const std::filesystem::path& file, std::optional<SurfaceMesh>& surface,
                    std::optional<PointCloud>& cloud, std::optional<double>& volume) {
  if (find_format(file) != nullptr && find_format(file)->volume) {
    Loaded loaded = load(file);
    const bool is_curved = loaded.volume_mesh && loaded.volume_mesh->order() == 2;
    volume = is_curved ? std::optional(total_volume(*loaded.volume_mesh)) : std::nullopt;
    const double tolerance = flat_enough_of_diagonal * bounding_box(loaded.surface.vertices).diagonal();
    surface = is_curved ? flat_pieces(*loaded.volume_mesh, tolerance).mesh : std::move(loaded.surface);
    return;
  }
  Scan scan = read_scan(file);
  if (auto* points = std::get_if<PointCloud>(&scan))
    cloud = std::move(*points);
  else
    surface = std::move(std::get<SurfaceMesh>(scan));
}

// The openings' borders, for viewers, and the largest as lines of text.
void tell_leaks(const std::vector<Opening>& openings, ProgressDisplay& display) {
  constexpr std::size_t most_lines = 8;
  display.line(openings.empty() ? "no openings: the surface bounds a volume"
                                : std::to_string(openings.size()) + (openings.size() == 1 ? " opening" : " openings"));
  for (std::size_t i = 0; i < std::min(openings.size(), most_lines); ++i)
    display.line("  at " + error_text(openings[i].place) + ", size " + error_text(openings[i].size) +
                 ", border of length " + error_text(openings[i].length));
  if (openings.size() > most_lines) display.line("  ... and " + std::to_string(openings.size() - most_lines) + " more");
}

FeatureLines lines_of(const std::vector<Opening>& openings) {
  FeatureLines lines;
  for (const Opening& opening : openings) {
    const auto first = static_cast<std::uint32_t>(lines.points.size());
    lines.points.insert(lines.points.end(), opening.border.begin(), opening.border.end());
    for (auto i = first; i < lines.points.size(); ++i)
      lines.segments.push_back({i, i + 1 < lines.points.size() ? i + 1 : first});
  }
  return lines;
}

int check(CheckFlags flags) {
  const std::vector<Gate> gates = parse_gates(flags.common);
  std::vector<std::filesystem::path> inputs = inputs_of(flags.common);
  if (flags.reference) inputs.push_back(*flags.reference);
  std::vector<OutputPath> files = report_outputs(flags.common);
  if (flags.leaks) files.push_back({*flags.leaks});
  require_writable(files, inputs, flags.common.force);
  ProgressDisplay display(flags.common.quiet);
  const Loaded mesh = load(flags.common.input);
  const std::string unit = settled_unit(mesh.unit, flags.common.unit, flags.common.input.string());
  if (!unit.empty()) flags.common.unit = unit;
  display.line(describe_input(mesh.surface, flags.common));
  std::optional<SurfaceMesh> reference;
  std::optional<PointCloud> cloud;
  std::optional<double> volume;
  if (flags.reference) load_reference(*flags.reference, reference, cloud, volume);
  const Subject subject{.surface = &mesh.surface,
                        .reference = reference ? &*reference : nullptr,
                        .solid_volume = volume,
                        .volume_mesh = mesh.volume_mesh ? &*mesh.volume_mesh : nullptr,
                        .stages = nullptr,
                        .repaired = nullptr,
                        .cloud = cloud ? &*cloud : nullptr,
                        .outliers = nullptr,
                        .primitives = nullptr,
                        .sets = nullptr,
                        .faces = nullptr,
                        .bodies = nullptr,
                        .contacts = nullptr};
  StagedOutputs outputs;
  if (flags.leaks) {
    const std::vector<Opening> openings = find_openings(mesh.surface);
    tell_leaks(openings, display);
    outputs.add(*flags.leaks, text_of(lines_of(openings)));
  }
  const bool all_pass = report_figures(subject, flags.common, gates, display, outputs);
  outputs.commit();
  return all_pass ? 0 : 1;
}

}  // namespace

SubCommand add_check(CLI::App& root) {
  const auto flags = std::make_shared<CheckFlags>();
  CLI::App* app = root.add_subcommand("check", "Figures and gates of a surface or a volume mesh");
  add_common_flags(*app, flags->common);
  app->add_option("--reference", flags->reference,
                  "What the surface is compared with, usually the scan; of a cloud, its points' distances")
      ->type_name("FILE");
  app->add_option("--leaks", flags->leaks,
                  "Write the borders of the openings that the surface leaks through: OBJ lines")
      ->type_name("FILE");
  return {app, [flags] { return check(*flags); }};
}

}  // namespace scan2fea::command
