#include "quality/report_page/thinned_view.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <unordered_map>

namespace scan2fea {
namespace {

constexpr auto not_seen = std::numeric_limits<std::uint32_t>::max();

void drop_unused_vertices(SurfaceMesh& mesh) {
  std::vector<std::uint32_t> renumbered(mesh.vertices.size(), not_seen);
  for (const Triangle& t : mesh.triangles)
    for (const std::uint32_t v : t) renumbered[v] = 0;
  std::uint32_t count = 0;
  for (std::size_t v = 0; v < mesh.vertices.size(); ++v)
    if (renumbered[v] != not_seen) {
      mesh.vertices[count] = mesh.vertices[v];
      renumbered[v] = count++;
    }
  mesh.vertices.resize(count);
  for (Triangle& t : mesh.triangles)
    for (std::uint32_t& v : t) v = renumbered[v];
}

// Each vertex replaced by the first one in its cell.
std::vector<std::uint32_t> firsts_in_cells(const SurfaceMesh& mesh, double cell) {
  const Vec3 low = bounding_box(mesh.vertices).low;
  std::unordered_map<std::uint64_t, std::uint32_t> first;
  std::vector<std::uint32_t> of_vertex;
  of_vertex.reserve(mesh.vertices.size());
  for (std::uint32_t v = 0; v < mesh.vertices.size(); ++v) {
    const Vec3 place = (mesh.vertices[v] - low) / cell;
    constexpr int bits = 21;
    std::uint64_t key = 0;
    for (int k = 0; k < 3; ++k) key = key << bits | static_cast<std::uint64_t>(place[k]);
    of_vertex.push_back(first.try_emplace(key, v).first->second);
  }
  return of_vertex;
}

ThinnedView clustered(const SurfaceMesh& mesh, double cell) {
  const std::vector<std::uint32_t> first = firsts_in_cells(mesh, cell);
  ThinnedView view{.mesh = {mesh.vertices, {}}, .origin = {}, .is_thinned = true};
  std::set<Triangle> known;
  for (std::uint32_t f = 0; f < mesh.triangles.size(); ++f) {
    Triangle t;
    for (std::size_t k = 0; k < 3; ++k) t[k] = first[mesh.triangles[f][k]];
    if (t[0] == t[1] || t[1] == t[2] || t[2] == t[0]) continue;
    // Small folds of the cells would show their backs.
    if (area_vector(mesh, t).dot(area_vector(mesh, mesh.triangles[f])) < 0) std::swap(t[1], t[2]);
    std::rotate(t.begin(), std::min_element(t.begin(), t.end()), t.end());
    if (!known.insert(t).second) continue;
    view.mesh.triangles.push_back(t);
    view.origin.push_back(f);
  }
  drop_unused_vertices(view.mesh);
  return view;
}

}  // namespace

ThinnedView thinned_view(const SurfaceMesh& mesh, std::size_t most) {
  if (mesh.triangles.size() <= most) {
    ThinnedView view{.mesh = mesh, .origin = {}, .is_thinned = false};
    drop_unused_vertices(view.mesh);
    for (std::uint32_t f = 0; f < mesh.triangles.size(); ++f) view.origin.push_back(f);
    return view;
  }
  // A cell of a surface's grid holds about two triangles.
  double cell = std::max(std::sqrt(2 * surface_area(mesh) / static_cast<double>(most)),
                         1e-6 * bounding_box(mesh.vertices).diagonal());
  ThinnedView view = clustered(mesh, cell);
  while (view.mesh.triangles.size() > most) view = clustered(mesh, cell *= 1.2);
  return view;
}

}  // namespace scan2fea
