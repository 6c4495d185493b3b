#include "preproc/surface/reference_surface.hpp"

#include <algorithm>
#include <numeric>
#include <tuple>

namespace scan2fea {

// Qualified calls: the members have the functions' names.
ReferenceSurface::ReferenceSurface(const SurfaceMesh& cut, const SurfaceMesh& scan)
    : mesh(cut),
      whole(scan),
      stars(cut),
      neighbours(scan2fea::face_neighbours(cut, stars)),
      face_normals(scan2fea::face_normals(cut)),
      vertex_normals(scan2fea::vertex_normals(cut)),
      diagonal(bounding_box(cut.vertices).diagonal()),
      area(surface_area(cut)) {}

ReferenceSurface::ReferenceSurface(const SurfaceMesh& scan) : ReferenceSurface(scan, scan) {}

ReferenceSurface::ReferenceSurface(const FeatureScan& scan) : ReferenceSurface(scan.cut.mesh, scan.scan) {
  patch_of_vertex = scan.patches.of_vertex;
  next_copy.resize(patch_of_vertex.size());
  std::iota(next_copy.begin(), next_copy.end(), 0U);
  const std::vector<std::uint32_t>& original = scan.cut.vertex_of_copy;
  std::vector<std::uint32_t> order = next_copy;
  std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
    return std::tuple(original[a], patch_of_vertex[a], a) < std::tuple(original[b], patch_of_vertex[b], b);
  });
  for (std::size_t i = 1; i < order.size(); ++i)
    if (original[order[i]] == original[order[i - 1]] && patch_of_vertex[order[i]] == patch_of_vertex[order[i - 1]])
      std::swap(next_copy[order[i]], next_copy[order[i - 1]]);
}

}  // namespace scan2fea
