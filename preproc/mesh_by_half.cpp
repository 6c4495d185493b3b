#include "preproc/mesh_by_half.hpp"

#include "preproc/mesh/error.hpp"
#include "preproc/mesh/error_text.hpp"
#include "preproc/mesh_of_scan.hpp"
#include "preproc/mirrored_surface.hpp"
#include "preproc/stage_descriptions.hpp"
#include "preproc/surface/kernel/cut_surface.hpp"

#include <cmath>
#include <utility>
#include <variant>

namespace scan2fea {
namespace {

// Of the half with its cut, so that the whole has what was asked for.
TargetSize size_of_half(const TargetSize& size, const SurfaceMesh& scan, const HalfScan& half) {
  const auto of_whole = [&](double faces) {
    return FaceCount{static_cast<std::size_t>(std::lround(faces / 2 / (1 - half.cut_share)))};
  };
  if (const auto* count = std::get_if<FaceCount>(&size)) return of_whole(static_cast<double>(count->faces));
  if (const auto* ratio = std::get_if<FaceRatio>(&size))
    return of_whole(ratio->of_input * static_cast<double>(scan.triangles.size()));
  return in_model_units(size, bounding_box(scan.vertices));
}

void add_lines(const FeatureLines& lines, FeatureLines& to) {
  const auto first = static_cast<std::uint32_t>(to.points.size());
  to.points.insert(to.points.end(), lines.points.begin(), lines.points.end());
  for (const auto& [a, b] : lines.segments) to.segments.push_back({first + a, first + b});
}

MirrorPlane mirror_plane_of(const SurfaceMesh& scan, const SymmetryOptions& options, const Progress& progress) {
  const MirrorPlane plane = find_mirror_plane(scan, options.axis, progress);
  const MirrorLimits limits = mirror_limits(scan);
  const bool is_near = plane.rms_distance <= limits.rms;
  if (is_near && plane.largest_distance <= limits.largest) return plane;
  throw NotMeshable(
      {.what = options.axis ? "the scan has no mirror plane across this axis" : "the scan has no mirror plane",
       .where = {},
       .value = is_near ? "its mirror image is " + error_text(plane.largest_distance) + " from it"
                        : "its mirror image is " + error_text(plane.rms_distance) + " from it in the mean",
       .limit = error_text(is_near ? limits.largest : limits.rms),
       .advice = "--symmetry off",
       .at = plane.farthest});
}

void require_mirrorable(const SurfaceMesh& scan, const PipelineOptions& options) {
  const auto refuse = [](const char* what, const char* advice) {
    throw WrongUsage({.what = what, .where = {}, .value = {}, .limit = {}, .advice = advice});
  };
  if (!boundary_edges(scan).empty())
    refuse("half of an open surface cannot be closed along its mirror plane", "--holes close, or --symmetry off");
  if (!options.simplify) return;
  if (options.simplify->method != SimplifyMethod::lattice)
    refuse("the collapse keeps no mirror plane", "--method lattice, or --symmetry off");
  if (!options.simplify->limits.boxes.empty() || !options.simplify->limits.balls.empty())
    refuse("edge lengths in boxes and balls have two sides, and one of them is mirrored",
           "--symmetry off, or no --size-box and --size-ball");
}

}  // namespace

FilledSurface mesh_by_half(const SurfaceMesh& scan, const std::optional<StairSteps>& stairs, PipelineOptions options,
                           const Progress& progress, PipelineResult& result, StageLog& log) {
  require_mirrorable(scan, options);
  std::optional<MirrorFrame> frame;
  HalfScan half;
  log.run("symmetry", [&](StageRecord& record) {
    const MirrorPlane plane = mirror_plane_of(scan, *options.symmetry, progress);
    frame.emplace(plane);
    half = halve(scan, *frame);
    describe(plane, record);
  });
  if (options.simplify) {
    options.simplify->size = size_of_half(options.simplify->size, scan, half);
    options.simplify->kept_lines = lines_on_half(options.simplify->kept_lines, *frame);
    add_lines(half.cut_lines, options.simplify->kept_lines);
    if (auto& given = options.simplify->given_features) given = lines_on_half(*given, *frame);
  }
  const Half of_scan{half, *frame};
  FilledSurface made = mesh_of_scan(half.mesh, stairs, options, &of_scan, {}, progress, result, log);
  MirroredSurface whole;
  log.run("mirror", [&](StageRecord& record) {
    whole = mirrored(std::move(made), *frame);
    record.changes = {{"faces_after", static_cast<double>(whole.made.surface.triangles.size())},
                      {"tetrahedra", static_cast<double>(whole.made.filled.mesh.tetrahedra.size())},
                      {"nodes_on_plane", static_cast<double>(whole.nodes_on_plane)}};
  });
  return std::move(whole.made);
}

}  // namespace scan2fea
