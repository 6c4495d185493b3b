#include "preproc/surface/repair/openings.hpp"

#include "preproc/surface/repair/kept_bodies.hpp"
#include "preproc/surface/repair/soup_adjacency.hpp"
#include "preproc/surface/repair/soup_cleaning.hpp"

#include <algorithm>

namespace scan2fea {

std::vector<Opening> find_openings(const SurfaceMesh& scan) {
  SurfaceMesh mesh = scan;
  RepairResult changes;
  check_input(mesh);
  clean_soup(mesh, changes);
  make_manifold(mesh, changes);
  drop_debris(mesh, BodiesOfNote{}, changes);
  std::vector<Opening> openings;
  for (const BorderLoop& loop : find_border_loops(mesh, find_twins(mesh))) {
    Opening& opening = openings.emplace_back();
    for (const std::uint32_t h : loop) {
      const Vec3& from = mesh.vertices[start_vertex(mesh, h)];
      opening.length += (mesh.vertices[end_vertex(mesh, h)] - from).norm();
      opening.border.push_back(from);
    }
    const BoundingBox box = bounding_box(opening.border);
    opening.size = box.diagonal();
    opening.place = (box.low + box.high) / 2;
  }
  std::stable_sort(openings.begin(), openings.end(),
                   [](const Opening& a, const Opening& b) { return a.size > b.size; });
  return openings;
}

}  // namespace scan2fea
