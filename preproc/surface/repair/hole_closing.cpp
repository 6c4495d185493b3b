#include "preproc/surface/repair/hole_closing.hpp"

#include "preproc/mesh/error_text.hpp"
#include "preproc/surface/repair/face_marks.hpp"
#include "preproc/surface/repair/hole_filling.hpp"
#include "preproc/surface/repair/shells.hpp"
#include "preproc/surface/repair/soup_adjacency.hpp"
#include "quality/self_intersections.hpp"

#include <algorithm>
#include <numeric>

namespace scan2fea {
namespace {

BoundingBox box_of(const SurfaceMesh& mesh, const BorderLoop& loop) {
  std::vector<Vec3> border;
  for (const std::uint32_t h : loop) border.push_back(mesh.vertices[start_vertex(mesh, h)]);
  return bounding_box(border);
}

// Each shell's largest hole, if it is larger than the options allow to close.
struct LargeHole {
  double size = 0;
  double limit = 0;
  Vec3 place = Vec3::Zero();
};

std::vector<std::optional<LargeHole>> find_large_holes(const SurfaceMesh& mesh, const std::vector<Shell>& shells,
                                                       const Twins& twins, double limit) {
  const std::vector<std::uint32_t> shell_of_face = shell_of_faces(shells, mesh.triangles.size());
  std::vector<std::optional<LargeHole>> large(shells.size());
  for (const BorderLoop& loop : find_border_loops(mesh, twins)) {
    const std::uint32_t s = shell_of_face[loop[0] / 3];
    const BoundingBox box = box_of(mesh, loop);
    const LargeHole hole{box.diagonal(), limit * shells[s].box.diagonal(), (box.low + box.high) / 2};
    if (hole.size > hole.limit && (!large[s] || hole.size > large[s]->size)) large[s] = hole;
  }
  return large;
}

// Whoever scanned one side of a panel needs something else than whoever scanned most of a solid.
[[noreturn]] void fail_of_hole(const SurfaceMesh& mesh, const Shell& shell, const LargeHole& hole) {
  const bool is_solid = nearly_encloses(mesh, shell);
  throw NotMeshable(
      {.what = is_solid ? "the surface is open: its hole is too large to close"
                        : "the surface is a sheet that encloses no volume: its opening is too large to close",
       .where = error_text(hole.place),
       .value = "size " + error_text(hole.size),
       .limit = error_text(hole.limit),
       .advice = is_solid
                     ? "a scan of what is missing, or --largest-hole all, which makes it up; check --leaks FILE shows "
                       "where"
                     : "--thickness T, which makes a solid of the sheet, or a scan of all sides"});
}

std::optional<PatchShape> plainer(PatchShape shape) {
  switch (shape) {
    case PatchShape::Faired:
      return PatchShape::Membrane;
    case PatchShape::Membrane:
      return PatchShape::Triangles;
    case PatchShape::Triangles:
      return {};
  }
  return {};
}

// The holes whose patches, appended to the surface with all others, cross something.
std::vector<std::size_t> find_crossing_patches(SurfaceMesh mesh, const std::vector<Patch>& patches) {
  const std::size_t face_count = mesh.triangles.size();
  std::vector<std::size_t> patch_of_face;
  for (std::size_t i = 0; i < patches.size(); ++i) {
    append_patch(mesh, patches[i]);
    patch_of_face.resize(mesh.triangles.size() - face_count, i);
  }
  std::vector<std::uint32_t> faces(patch_of_face.size());
  std::iota(faces.begin(), faces.end(), static_cast<std::uint32_t>(face_count));
  std::vector<std::size_t> crossing;
  for (const FacePair& pair : find_self_intersections(mesh, faces))
    for (const std::uint32_t f : {pair.face, pair.other})
      if (f >= face_count) crossing.push_back(patch_of_face[f - face_count]);
  std::sort(crossing.begin(), crossing.end());
  crossing.erase(std::unique(crossing.begin(), crossing.end()), crossing.end());
  return crossing;
}

// A patch that comes out crossing something is made again, plainer.
void fill_holes(SurfaceMesh& mesh, const Twins& twins, RepairResult& result, const Progress& progress) {
  const std::vector<BorderLoop> loops = find_border_loops(mesh, twins);
  std::vector<PatchShape> shapes(loops.size(), PatchShape::Faired);
  std::vector<Patch> patches;
  for (std::size_t i = 0; i < loops.size(); ++i) {
    if (i % 64 == 0) progress("close holes", static_cast<double>(i) / static_cast<double>(loops.size()));
    patches.push_back(make_patch(mesh, twins, loops[i], shapes[i]));
  }
  for (bool changed = true; changed;) {
    changed = false;
    for (const std::size_t i : find_crossing_patches(mesh, patches)) {
      const std::optional<PatchShape> shape = plainer(shapes[i]);
      if (!shape) continue;
      shapes[i] = *shape;
      patches[i] = make_patch(mesh, twins, loops[i], *shape);
      changed = true;
    }
  }
  for (std::size_t i = 0; i < loops.size(); ++i) {
    const BoundingBox box = box_of(mesh, loops[i]);
    const std::size_t first = mesh.triangles.size();
    append_patch(mesh, patches[i]);
    double area = 0;
    for (std::size_t f = first; f < mesh.triangles.size(); ++f) area += area_of(mesh, static_cast<std::uint32_t>(f));
    result.faces_added += patches[i].triangles.size();
    result.changes.push_back({RepairKind::ClosedHole, (box.low + box.high) / 2, box.diagonal(), area});
  }
}

}  // namespace

void close_holes(SurfaceMesh& mesh, const HoleClosingOptions& options, RepairResult& result, const Progress& progress) {
  Twins twins = find_twins(mesh);
  if (std::find(twins.begin(), twins.end(), no_twin) == twins.end()) return;
  if (options.largest_of_diagonal) {
    const std::vector<Shell> shells = find_shells(mesh, true);
    const auto large = find_large_holes(mesh, shells, twins, *options.largest_of_diagonal);
    const double fragment_area = options.fragment_of_area * surface_area(mesh);
    std::vector<std::optional<RepairKind>> reasons(shells.size());
    for (std::size_t s = 0; s < shells.size(); ++s) {
      if (!large[s]) continue;
      reasons[s] = RepairKind::DroppedFragment;
      if (shells[s].area >= fragment_area) fail_of_hole(mesh, shells[s], *large[s]);
    }
    drop_shells(mesh, shells, reasons, result);
    twins = find_twins(mesh);
  }
  fill_holes(mesh, twins, result, progress);
}

}  // namespace scan2fea
