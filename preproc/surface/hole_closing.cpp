#include "preproc/surface/hole_closing.hpp"

#include "preproc/mesh/error_text.hpp"
#include "preproc/surface/hole_filling.hpp"
#include "preproc/surface/shells.hpp"
#include "preproc/surface/soup_adjacency.hpp"
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
  std::vector<std::uint32_t> shell_of_face(mesh.triangles.size());
  for (std::uint32_t s = 0; s < shells.size(); ++s)
    for (const std::uint32_t f : shells[s].faces) shell_of_face[f] = s;
  std::vector<std::optional<LargeHole>> large(shells.size());
  for (const BorderLoop& loop : find_border_loops(mesh, twins)) {
    const std::uint32_t s = shell_of_face[loop[0] / 3];
    const BoundingBox box = box_of(mesh, loop);
    const LargeHole hole{box.diagonal(), limit * shells[s].box.diagonal(), (box.low + box.high) / 2};
    if (hole.size > hole.limit && (!large[s] || hole.size > large[s]->size)) large[s] = hole;
  }
  return large;
}

// A patch that comes out crossing something is made again, plainer.
void fill_holes(SurfaceMesh& mesh, const Twins& twins, RepairResult& result, const Progress& progress) {
  const std::vector<BorderLoop> loops = find_border_loops(mesh, twins);
  const auto vertex_count = static_cast<std::ptrdiff_t>(mesh.vertices.size());
  const std::size_t face_count = mesh.triangles.size();
  std::vector<PatchShape> shapes(loops.size(), PatchShape::Faired);
  std::vector<std::uint32_t> loop_of_face;  // of the patches
  for (bool again = true; again;) {
    mesh.vertices.erase(mesh.vertices.begin() + vertex_count, mesh.vertices.end());
    mesh.triangles.resize(face_count);
    loop_of_face.clear();
    for (std::uint32_t i = 0; i < loops.size(); ++i) {
      if (i % 64 == 0) progress("close holes", i / static_cast<double>(loops.size()));
      fill_hole(mesh, twins, loops[i], shapes[i]);
      loop_of_face.resize(mesh.triangles.size() - face_count, i);
    }
    std::vector<std::uint32_t> patches(loop_of_face.size());
    std::iota(patches.begin(), patches.end(), static_cast<std::uint32_t>(face_count));
    std::vector<char> crosses(loops.size(), 0);
    for (const FacePair& pair : find_self_intersections(mesh, patches))
      for (const std::uint32_t f : {pair.face, pair.other})
        if (f >= face_count) crosses[loop_of_face[f - face_count]] = 1;
    again = false;
    for (std::size_t i = 0; i < loops.size(); ++i) {
      if (!crosses[i] || shapes[i] == PatchShape::Triangles) continue;
      shapes[i] = shapes[i] == PatchShape::Faired ? PatchShape::Membrane : PatchShape::Triangles;
      again = true;
    }
  }
  for (const BorderLoop& loop : loops) {
    const BoundingBox box = box_of(mesh, loop);
    result.changes.push_back({RepairKind::ClosedHole, (box.low + box.high) / 2, box.diagonal()});
  }
  result.faces_added += mesh.triangles.size() - face_count;
}

}  // namespace

void close_holes(SurfaceMesh& mesh, const HoleClosingOptions& options, RepairResult& result, const Progress& progress) {
  Twins twins = find_twins(mesh);
  if (std::find(twins.begin(), twins.end(), no_twin) == twins.end()) return;
  if (options.largest_of_diagonal) {
    const std::vector<Shell> shells = find_shells(mesh);
    const auto large = find_large_holes(mesh, shells, twins, *options.largest_of_diagonal);
    const double fragment_area = options.fragment_of_area * surface_area(mesh);
    std::vector<char> fragments(shells.size(), 0);
    for (std::size_t s = 0; s < shells.size(); ++s) {
      if (!large[s]) continue;
      fragments[s] = 1;
      if (shells[s].area >= fragment_area)
        throw NotMeshable({.what = "the surface is open: its hole is too large to close",
                           .where = error_text(large[s]->place),
                           .value = "size " + error_text(large[s]->size),
                           .limit = error_text(large[s]->limit),
                           .advice = "--largest-hole all, or a scan of what is missing"});
    }
    drop_shells(mesh, shells, fragments, RepairKind::DroppedFragment, result);
    twins = find_twins(mesh);
  }
  fill_holes(mesh, twins, result, progress);
}

}  // namespace scan2fea
