#include "preproc/made_up.hpp"

#include "preproc/surface/kernel/nearest.hpp"
#include "quality/triangle_tree.hpp"

#include <algorithm>
#include <cstdint>
#include <utility>

namespace scan2fea {
namespace {

double longest_edge(const SurfaceMesh& mesh, const Triangle& t) {
  double longest = 0;
  for (std::size_t k = 0; k < 3; ++k)
    longest = std::max(longest, (mesh.vertices[t[k]] - mesh.vertices[t[(k + 1) % 3]]).norm());
  return longest;
}

}  // namespace

std::vector<FaceOrigin> origins_by_place(const SurfaceMesh& made, const SurfaceMesh& seen) {
  // The middle of a face that spans a hole is a third of its height from the hole's border.
  constexpr double off_the_seen = 0.02;  // longest edges
  std::vector<FaceOrigin> origins;
  origins.reserve(made.triangles.size());
  if (seen.triangles.empty()) return std::vector<FaceOrigin>(made.triangles.size(), FaceOrigin::filled);
  const TriangleTree tree(seen);
  for (const Triangle& t : made.triangles) {
    const bool is_seen = tree.closest_within(centroid(made, t), off_the_seen * longest_edge(made, t)).has_value();
    origins.push_back(is_seen ? FaceOrigin::measured : FaceOrigin::filled);
  }
  return origins;
}

std::vector<FaceOrigin> carried_origins(const SurfaceMesh& made, const SurfaceMesh& from,
                                        const std::vector<FaceOrigin>& of_from) {
  if (made.triangles == from.triangles) return of_from;
  std::vector<FaceOrigin> origins;
  origins.reserve(made.triangles.size());
  for (const std::uint32_t f : nearest_faces(centroids(made), from)) origins.push_back(of_from[f]);
  return origins;
}

void mark_enriched(const SurfaceMesh& made, std::size_t measured_vertices, std::vector<FaceOrigin>& origins) {
  for (std::size_t f = 0; f < made.triangles.size(); ++f) {
    const bool has_new = std::ranges::any_of(made.triangles[f], [&](auto v) { return v >= measured_vertices; });
    if (has_new && origins[f] == FaceOrigin::measured) origins[f] = FaceOrigin::enriched;
  }
}

std::vector<NamedSet> made_up_sets(const std::vector<FaceOrigin>& origins) {
  std::vector<NamedSet> sets;
  for (const auto& [origin, name] :
       {std::pair{FaceOrigin::filled, filled_set}, std::pair{FaceOrigin::enriched, enriched_set}}) {
    NamedSet set{.name = name, .members = {}};
    for (std::uint32_t f = 0; f < origins.size(); ++f)
      if (origins[f] == origin) set.members.push_back(f);
    if (!set.members.empty()) sets.push_back(std::move(set));
  }
  return sets;
}

}  // namespace scan2fea
