#include "preproc/surface/features/feature_selection.hpp"

#include "preproc/mesh/union_find.hpp"
#include "preproc/surface/kernel/adjacency.hpp"
#include "preproc/surface/kernel/components.hpp"
#include "preproc/surface/kernel/cut_surface.hpp"
#include "quality/triangle_measures.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <set>

namespace scan2fea {
namespace {

// Each round joins patches with neighbours; a nest of small ones takes several.
constexpr int most_rounds = 20;

// A crease and the patches beside it, the smaller number first.
struct CreaseEdge {
  FeatureEdge edge;
  std::array<std::uint32_t, 2> patches;
  double length;
  double bend;  // angle between the faces' normals
};

std::vector<CreaseEdge> creases_with_patches(const SurfaceMesh& scan, const std::vector<FeatureEdge>& sharp,
                                             const std::vector<std::uint32_t>& patch_of_face,
                                             const std::vector<Vec3>& normals) {
  struct Side {
    FeatureEdge edge;
    std::uint32_t face;
  };
  std::vector<Side> sides;
  for (std::uint32_t f = 0; f < scan.triangles.size(); ++f)
    for (std::size_t k = 0; k < 3; ++k) {
      const FeatureEdge edge = feature_edge(scan.triangles[f][k], scan.triangles[f][(k + 1) % 3]);
      if (std::binary_search(sharp.begin(), sharp.end(), edge)) sides.push_back({edge, f});
    }
  std::sort(sides.begin(), sides.end(),
            [](const Side& a, const Side& b) { return a.edge != b.edge ? a.edge < b.edge : a.face < b.face; });
  std::vector<CreaseEdge> creases;
  for (std::size_t i = 1; i < sides.size(); ++i) {
    if (sides[i].edge != sides[i - 1].edge) continue;
    const auto [low, high] = std::minmax(patch_of_face[sides[i].face], patch_of_face[sides[i - 1].face]);
    const Vec3 &m = normals[sides[i].face], &n = normals[sides[i - 1].face];
    creases.push_back({sides[i].edge,
                       {low, high},
                       (scan.vertices[sides[i].edge[0]] - scan.vertices[sides[i].edge[1]]).norm(),
                       angle_between(m, n)});
  }
  return creases;
}

// One round. Returns whether anything was joined.
bool join_small_patches(const SurfaceMesh& scan, const std::vector<Vec3>& normals, std::span<const double> edge_length,
                        double least_triangles, std::vector<FeatureEdge>& sharp) {
  const CutSurface cut = cut_along(scan, sharp);
  const Components patches = find_components(cut.mesh);
  std::vector<std::uint32_t> patch_of_face;
  std::vector<double> room(patches.count, 0);  // triangles
  for (std::size_t f = 0; f < cut.mesh.triangles.size(); ++f) {
    const Triangle& t = scan.triangles[f];
    patch_of_face.push_back(patches.of_vertex[cut.mesh.triangles[f][0]]);
    const double length = (edge_length[t[0]] + edge_length[t[1]] + edge_length[t[2]]) / 3;
    room[patch_of_face.back()] += area_vector(scan, t).norm() / (2 * equilateral_area * length * length);
  }
  const std::vector<CreaseEdge> creases = creases_with_patches(scan, sharp, patch_of_face, normals);
  // Between two patches: how long their border is, and how it bends.
  struct Border {
    double length = 0, bend = 0;
  };
  std::map<std::array<std::uint32_t, 2>, Border> borders;
  for (const CreaseEdge& c : creases) {
    if (c.patches[0] == c.patches[1]) continue;
    borders[c.patches].length += c.length;
    borders[c.patches].bend += c.length * c.bend;
  }
  struct Smoothest {
    double bend = std::numeric_limits<double>::infinity();
    std::array<std::uint32_t, 2> border{};
  };
  std::vector<Smoothest> smoothest(patches.count);
  for (const auto& [pair, border] : borders)
    for (const std::uint32_t p : pair) {
      const double bend = border.bend / border.length;
      if (room[p] < least_triangles && bend < smoothest[p].bend) smoothest[p] = {bend, pair};
    }
  std::vector<std::array<std::uint32_t, 2>> opened;
  for (const Smoothest& s : smoothest)
    if (std::isfinite(s.bend)) opened.push_back(s.border);
  if (opened.empty()) return false;
  std::sort(opened.begin(), opened.end());
  // A crease that ends inside a small patch goes with it.
  for (const CreaseEdge& c : creases) {
    const bool inside = c.patches[0] == c.patches[1] && room[c.patches[0]] < least_triangles;
    if (inside || std::binary_search(opened.begin(), opened.end(), c.patches))
      sharp.erase(std::lower_bound(sharp.begin(), sharp.end(), c.edge));
  }
  return true;
}

// Creases that hang together, named by their smallest vertex.
class Chains {
 public:
  Chains(const SurfaceMesh& scan, const std::vector<FeatureEdge>& sharp)
      : sets_(scan.vertices.size()),
        length_(scan.vertices.size(), 0),
        free_ends_(scan.vertices.size(), 0),
        bodies_(find_components(scan)),
        diagonals_(diagonals(scan, bodies_)) {
    std::vector<int> degree(scan.vertices.size(), 0);
    for (const auto& [a, b] : sharp) {
      sets_.unite(a, b);
      ++degree[a];
      ++degree[b];
    }
    for (const auto& [a, b] : sharp) length_[sets_.find(a)] += (scan.vertices[a] - scan.vertices[b]).norm();
    for (const auto& [a, b] : boundary_edges(scan)) degree[a] = degree[b] = 0;  // ends there are not free
    for (std::uint32_t v = 0; v < degree.size(); ++v)
      if (degree[v] == 1) ++free_ends_[sets_.find(v)];
  }

  std::uint32_t of(const FeatureEdge& edge) { return sets_.find(edge[0]); }
  double length(std::uint32_t chain) const { return length_[chain]; }
  double length_of_body(std::uint32_t chain) const { return length_[chain] / diagonals_[bodies_.of_vertex[chain]]; }
  bool has_free_end(std::uint32_t chain) const { return free_ends_[chain] > 0; }

 private:
  UnionFind sets_;
  std::vector<double> length_;
  std::vector<int> free_ends_;
  Components bodies_;
  std::vector<double> diagonals_;
};

// The creases at each vertex, and how they bend.
class CreaseGraph {
 public:
  struct Branch {
    std::vector<std::uint32_t> vertices;  // from the corner on
    double length = 0, bend = 0;          // angle between the faces' normals, times length
  };

  CreaseGraph(const SurfaceMesh& scan, const std::vector<FeatureEdge>& sharp) : scan_(scan) {
    for (const auto& [a, b] : sharp) {
      next_[a].push_back(b);
      next_[b].push_back(a);
    }
    const VertexStars stars(scan);
    const std::vector<Triangle> neighbours = face_neighbours(scan, stars);
    const std::vector<Vec3> normals = face_normals(scan);
    for (std::uint32_t f = 0; f < scan.triangles.size(); ++f)
      for (std::size_t k = 0; k < 3; ++k) {
        const FeatureEdge edge = feature_edge(scan.triangles[f][(k + 1) % 3], scan.triangles[f][(k + 2) % 3]);
        const std::uint32_t g = neighbours[f][k];
        if (g != no_face && std::binary_search(sharp.begin(), sharp.end(), edge))
          bend_[edge] = angle_between(normals[f], normals[g]);
      }
  }

  std::uint32_t nearest(const Vec3& place) const {
    std::uint32_t best = 0;
    double least = std::numeric_limits<double>::infinity();
    for (const auto& [v, around] : next_)
      if (const double distance = (scan_.vertices[v] - place).squaredNorm(); distance < least) {
        least = distance;
        best = v;
      }
    return best;
  }

  // Along the creases from a corner as far as `reach` from it, or to the next corner.
  std::vector<Branch> branches(std::uint32_t corner, double reach) const {
    std::vector<Branch> result;
    for (std::uint32_t v : next_.at(corner)) {
      Branch branch{{corner}};
      for (std::uint32_t last = corner; v != corner;) {
        const double length = (scan_.vertices[v] - scan_.vertices[last]).norm();
        branch.vertices.push_back(v);
        branch.length += length;
        if (const auto bend = bend_.find(feature_edge(last, v)); bend != bend_.end())
          branch.bend += length * bend->second;
        const std::vector<std::uint32_t>& around = next_.at(v);
        if (around.size() != 2 || (scan_.vertices[v] - scan_.vertices[corner]).norm() > reach) break;
        const std::uint32_t ahead = around[0] == last ? around[1] : around[0];
        last = v;
        v = ahead;
      }
      result.push_back(std::move(branch));
    }
    return result;
  }

  double distance(const Vec3& p, const Branch& branch) const {
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i + 1 < branch.vertices.size(); ++i) {
      const Vec3 &a = scan_.vertices[branch.vertices[i]], &b = scan_.vertices[branch.vertices[i + 1]];
      const double along = std::clamp((p - a).dot(b - a) / (b - a).squaredNorm(), 0.0, 1.0);
      least = std::min(least, (p - a - along * (b - a)).norm());
    }
    return least;
  }

  // As seen from a distance.
  Vec3 direction(const Branch& branch, double distance) const {
    const Vec3& corner = scan_.vertices[branch.vertices.front()];
    for (const std::uint32_t v : branch.vertices)
      if ((scan_.vertices[v] - corner).norm() > distance) return (scan_.vertices[v] - corner).normalized();
    return (scan_.vertices[branch.vertices.back()] - corner).normalized();
  }

 private:
  const SurfaceMesh& scan_;
  std::map<std::uint32_t, std::vector<std::uint32_t>> next_;
  std::map<FeatureEdge, double> bend_;
};

}  // namespace

std::vector<FeatureEdge> select_features(const SurfaceMesh& scan, std::vector<FeatureEdge> sharp, double edge_length,
                                         const FeatureSelection& selection) {
  return select_features(scan, std::move(sharp), std::vector<double>(scan.vertices.size(), edge_length), selection);
}

std::vector<FeatureEdge> select_features(const SurfaceMesh& scan, std::vector<FeatureEdge> sharp,
                                         std::span<const double> edge_length, const FeatureSelection& selection) {
  std::sort(sharp.begin(), sharp.end());
  const std::vector<Vec3> normals = face_normals(scan);
  for (int round = 0; round < most_rounds && !sharp.empty(); ++round)
    if (!join_small_patches(scan, normals, edge_length, selection.least_triangles, sharp)) break;
  Chains chains(scan, sharp);
  std::erase_if(sharp, [&](const FeatureEdge& e) {
    const std::uint32_t chain = chains.of(e);
    return chains.has_free_end(chain) ? chains.length_of_body(chain) < selection.shortest_open_of_diagonal
                                      : chains.length(chain) < selection.shortest_closed * edge_length[e[0]];
  });
  return sharp;
}

std::vector<FeatureEdge> without_short_creases_near(const SurfaceMesh& scan, const std::vector<FeatureEdge>& sharp,
                                                    const std::vector<Vec3>& places, double reach, double longest) {
  Chains chains(scan, sharp);
  std::set<std::uint32_t> dropped;
  for (const FeatureEdge& e : sharp) {
    if (chains.length(chains.of(e)) >= longest) continue;
    for (const Vec3& place : places)
      if ((scan.vertices[e[0]] - place).norm() < reach || (scan.vertices[e[1]] - place).norm() < reach)
        dropped.insert(chains.of(e));
  }
  std::vector<FeatureEdge> kept = sharp;
  std::erase_if(kept, [&](const FeatureEdge& e) { return dropped.contains(chains.of(e)); });
  return kept;
}

std::vector<FeatureEdge> without_creases_near(const SurfaceMesh& scan, const std::vector<FeatureEdge>& sharp,
                                              const std::vector<Vec3>& places, double reach) {
  std::vector<FeatureEdge> kept;
  for (const FeatureEdge& e : sharp)
    if (std::ranges::none_of(places, [&](const Vec3& place) {
          return (scan.vertices[e[0]] - place).norm() < reach || (scan.vertices[e[1]] - place).norm() < reach;
        }))
      kept.push_back(e);
  return kept;
}

std::vector<FeatureEdge> without_narrow_corners(const SurfaceMesh& scan, const std::vector<FeatureEdge>& sharp,
                                                const std::vector<SharpCorner>& corners) {
  constexpr double narrow = 0.6, reach = 4;  // edges
  // Corners of borders alone have no crease to be given up.
  if (corners.empty() || sharp.empty()) return sharp;
  const CreaseGraph graph(scan, sharp);
  std::set<FeatureEdge> dropped;
  for (const SharpCorner& corner : corners) {
    const std::vector<CreaseGraph::Branch> branches =
        graph.branches(graph.nearest(corner.place), reach * corner.edge_length);
    const CreaseGraph::Branch *kept = nullptr, *smoother = nullptr;
    double closest = 0;  // cosine: a right angle is not narrow
    for (const auto& a : branches)
      for (const auto& b : branches)
        if (const double cosine =
                graph.direction(a, corner.edge_length / 2).dot(graph.direction(b, corner.edge_length / 2));
            &a < &b && cosine > closest) {
          closest = cosine;
          const bool a_is_smoother = a.bend / a.length < b.bend / b.length;
          smoother = a_is_smoother ? &a : &b;
          kept = a_is_smoother ? &b : &a;
        }
    if (smoother == nullptr) continue;
    for (std::size_t i = 0; i + 1 < smoother->vertices.size(); ++i) {
      dropped.insert(feature_edge(smoother->vertices[i], smoother->vertices[i + 1]));
      if (graph.distance(scan.vertices[smoother->vertices[i + 1]], *kept) > narrow * corner.edge_length) break;
    }
  }
  std::vector<FeatureEdge> left = sharp;
  std::erase_if(left, [&](const FeatureEdge& e) { return dropped.contains(e); });
  return left;
}

}  // namespace scan2fea
