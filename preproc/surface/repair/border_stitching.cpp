#include "preproc/surface/repair/border_stitching.hpp"

#include "preproc/mesh/union_find.hpp"
#include "preproc/surface/repair/border_gaps.hpp"
#include "preproc/surface/repair/soup_adjacency.hpp"
#include "preproc/surface/repair/soup_cleaning.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <span>

namespace scan2fea {
namespace {

constexpr double between_groups = 4;

// Distances beyond which the next is much wider, ascending.
std::vector<double> ends_of_groups(const SurfaceMesh& mesh, std::span<const BorderGap> gaps) {
  const double least = 1e-12 * bounding_box(mesh.vertices).diagonal();  // rounding of doubles is one group
  std::vector<double> ends;
  for (const BorderGap& gap : gaps) {
    const double distance = std::max(gap.distance, least);
    if (!ends.empty() && distance < between_groups * ends.back())
      ends.back() = std::max(ends.back(), distance);
    else
      ends.push_back(distance);
  }
  return ends;
}

// Vertices on the three sides of a face, each side's in its direction.
using OnSides = std::array<std::vector<std::uint32_t>, 3>;

// Splits a face at the vertices on its sides, the middle one of the longest row first.
void split_face(const Triangle& t, const OnSides& on_sides, std::vector<Triangle>& into) {
  std::size_t i = 0;
  for (std::size_t side : {1, 2})
    if (on_sides[side].size() > on_sides[i].size()) i = side;
  const std::vector<std::uint32_t>& row = on_sides[i];
  if (row.empty()) {
    into.push_back(t);
    return;
  }
  const auto middle = row.begin() + static_cast<std::ptrdiff_t>(row.size() / 2);
  const std::uint32_t a = t[i], b = t[(i + 1) % 3], c = t[(i + 2) % 3];
  split_face({a, *middle, c}, {std::vector(row.begin(), middle), {}, on_sides[(i + 2) % 3]}, into);
  split_face({*middle, b, c}, {std::vector(middle + 1, row.end()), on_sides[(i + 1) % 3], {}}, into);
}

// The soup with all gaps within a tolerance closed.
class Stitching {
 public:
  Stitching(const SurfaceMesh& mesh, std::span<const BorderGap> gaps, double tolerance)
      : mesh_(mesh), joined_(mesh.vertices.size()) {
    for (const BorderGap& gap : gaps) {
      if (gap.distance > tolerance) break;
      const std::uint32_t a = start_vertex(mesh, gap.halfedge), b = end_vertex(mesh, gap.halfedge);
      const double to_a = distance(gap.vertex, a), to_b = distance(gap.vertex, b);
      if (std::min(to_a, to_b) <= tolerance)
        joined_.unite(gap.vertex, to_a <= to_b ? a : b);
      else
        beside_.push_back(gap);
    }
    std::sort(beside_.begin(), beside_.end(), [](const BorderGap& a, const BorderGap& b) {
      if (a.halfedge != b.halfedge) return a.halfedge < b.halfedge;
      return a.along != b.along ? a.along < b.along : a.vertex < b.vertex;
    });
  }

  SurfaceMesh run(RepairResult& result) {
    SurfaceMesh stitched{mesh_.vertices, {}};
    for (std::uint32_t v = 0; v < mesh_.vertices.size(); ++v)
      if (joined_.find(v) != v)
        result.changes.push_back({RepairKind::WeldedVertex, mesh_.vertices[v], distance(v, joined_.find(v))});
    auto gap = beside_.begin();
    for (std::uint32_t f = 0; f < mesh_.triangles.size(); ++f) {
      Triangle t = mesh_.triangles[f];
      for (std::uint32_t& v : t) v = joined_.find(v);
      OnSides on_sides;
      for (; gap != beside_.end() && gap->halfedge / 3 == f; ++gap) {
        std::vector<std::uint32_t>& side = on_sides[gap->halfedge % 3];
        const std::uint32_t v = joined_.find(gap->vertex);
        if (v == t[0] || v == t[1] || v == t[2] || std::find(side.begin(), side.end(), v) != side.end()) continue;
        side.push_back(v);
        result.changes.push_back({RepairKind::SplitEdge, mesh_.vertices[v], gap->distance});
      }
      split_face(t, on_sides, stitched.triangles);
    }
    drop_collapsed_faces(stitched, result);
    return stitched;
  }

 private:
  double distance(std::uint32_t v, std::uint32_t w) const { return (mesh_.vertices[v] - mesh_.vertices[w]).norm(); }

  const SurfaceMesh& mesh_;
  UnionFind joined_;
  std::vector<BorderGap> beside_;  // of vertices that lie beside the inside of an edge, along each edge
};

// Of edges with an odd number of faces.
double length_of_borders(const SurfaceMesh& mesh) {
  double sum = 0;
  EdgeGroups(mesh).for_each([&](const std::uint32_t* first, const std::uint32_t* last) {
    if ((last - first) % 2 == 1)
      sum += (mesh.vertices[start_vertex(mesh, *first)] - mesh.vertices[end_vertex(mesh, *first)]).norm();
  });
  return sum;
}

}  // namespace

void stitch_borders(SurfaceMesh& mesh, RepairResult& result) {
  const std::vector<BorderGap> gaps = find_border_gaps(mesh);
  double least = length_of_borders(mesh);
  std::optional<SurfaceMesh> best;
  RepairResult best_result;
  for (const double tolerance : ends_of_groups(mesh, gaps)) {
    RepairResult of_try;
    SurfaceMesh stitched = Stitching(mesh, gaps, tolerance).run(of_try);
    const double open = length_of_borders(stitched);
    if (open >= (1 - 1e-6) * least) continue;
    least = open;
    best = std::move(stitched);
    best_result = std::move(of_try);
  }
  if (!best) return;
  mesh = std::move(*best);
  result.changes.insert(result.changes.end(), best_result.changes.begin(), best_result.changes.end());
  result.faces_removed += best_result.faces_removed;
}

}  // namespace scan2fea
