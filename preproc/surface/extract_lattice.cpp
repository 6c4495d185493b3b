#include "preproc/surface/extract_lattice.hpp"

#include "preproc/surface/components.hpp"
#include "preproc/surface/halfedge_mesh.hpp"
#include "preproc/surface/parallel_blocks.hpp"
#include "preproc/surface/union_find.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace scan2fea {
namespace {

constexpr std::uint32_t none = std::numeric_limits<std::uint32_t>::max();
constexpr double farthest_join = 0.6;              // edge lengths between lattice points that may become one
constexpr double smallest_cluster = 0.3;           // cells
constexpr double cell_area = 0.86602540378443865;  // of a lattice of edge length 1, sqrt(3)/2
constexpr int rounds_of_mending = 10;

struct Join {
  std::uint32_t a, b;
};

// Sets of nodes that become one vertex each.
class Clusters {
 public:
  Clusters(const GraphLevel& graph, const std::vector<Complex>& directions, const PositionField& position)
      : graph_(&graph),
        sets_(graph.size()),
        next_(graph.size()),
        points_(graph.size()),
        counts_(graph.size(), 1.0),
        lengths_(graph.size()),
        cells_(graph.size()) {
    const Complex sixth = std::polar(1.0, M_PI / 3);
    for_each_block(graph.size(), [&](std::size_t first, std::size_t last) {
      for (std::size_t i = first; i < last; ++i) {
        next_[i] = static_cast<std::uint32_t>(i);
        lengths_[i] = std::exp(graph.log_length[i]);
        const auto [u, v] = position.offsets[i];
        const Complex to_point =
            -lengths_[i] * directions[i] * (static_cast<double>(u) + static_cast<double>(v) * sixth);
        points_[i] = graph.positions[i] + TangentFrame(graph.normals[i]).vector(to_point);
        cells_[i] = graph.areas[i] / (cell_area * lengths_[i] * lengths_[i]);
      }
    });
  }

  std::uint32_t find(std::uint32_t node) { return sets_.find(node); }
  double cells(std::uint32_t root) const { return cells_[root]; }
  Vec3 point(std::uint32_t root) const { return points_[root] / counts_[root]; }

  void join_if_near(const Join& join) {
    const std::uint32_t a = find(join.a), b = find(join.b);
    if (a == b) return;
    const double most = farthest_join * 0.5 * (lengths_[a] + lengths_[b]);
    if ((point(a) - point(b)).squaredNorm() > most * most) return;
    const Vec3 sum = points_[a] + points_[b];
    const double count = counts_[a] + counts_[b];
    const std::uint32_t root = merge(a, b);
    points_[root] = sum;
    counts_[root] = count;
  }

  // Gives all nodes of the set to the neighbouring set whose lattice point is nearest. False where there is no other.
  bool dissolve(std::uint32_t root) {
    std::uint32_t nearest = none;
    double nearest_distance = std::numeric_limits<double>::infinity();
    const Vec3 here = point(root);
    for_each_neighbour_set(root, [&](std::uint32_t other) {
      const double distance = (point(other) - here).squaredNorm();
      if (distance < nearest_distance || (distance == nearest_distance && other < nearest)) {
        nearest = other;
        nearest_distance = distance;
      }
    });
    if (nearest == none) return false;
    // The receiver keeps its place.
    const Vec3 sum = points_[nearest];
    const double count = counts_[nearest];
    const std::uint32_t joint = merge(root, nearest);
    points_[joint] = sum;
    counts_[joint] = count;
    return true;
  }

  template <class Visit>
  void for_each_neighbour_set(std::uint32_t root, const Visit& visit) {
    std::uint32_t i = root;
    do {
      for (std::uint32_t e = graph_->first[i]; e < graph_->first[i + 1]; ++e) {
        const std::uint32_t other = find(graph_->neighbours[e]);
        if (other != root) visit(other);
      }
      i = next_[i];
    } while (i != root);
  }

 private:
  std::uint32_t merge(std::uint32_t a, std::uint32_t b) {
    std::swap(next_[a], next_[b]);  // two rings become one
    const double cells = cells_[a] + cells_[b];
    const std::uint32_t root = sets_.unite(a, b);
    cells_[root] = cells;
    return root;
  }

  const GraphLevel* graph_;
  UnionFind sets_;
  std::vector<std::uint32_t> next_;  // the members of a set, in a ring
  std::vector<Vec3> points_;         // per root, sum of lattice points
  std::vector<double> counts_;       // per root, of how many
  std::vector<double> lengths_;
  std::vector<double> cells_;  // per root, area in cells of the lattice
};

// Edges whose ends share a lattice point, by ascending disagreement about where it is (to 1/256 of an edge length).
std::vector<Join> joins_by_residual(const GraphLevel& graph, const PositionField& position) {
  constexpr std::size_t buckets = 256;
  constexpr std::uint16_t no_join = buckets;
  std::vector<std::uint16_t> residual(graph.neighbours.size(), no_join);
  for_each_block(graph.size(), [&](std::size_t first, std::size_t last) {
    for (std::size_t i = first; i < last; ++i) {
      for (std::uint32_t e = graph.first[i]; e < graph.first[i + 1]; ++e) {
        const std::uint32_t j = graph.neighbours[e];
        if (j > i) continue;
        const LatticeCoordinates predicted = carried(position.steps[e], position.offsets[j]);
        const LatticeCoordinates change{predicted[0] - position.offsets[i][0], predicted[1] - position.offsets[i][1]};
        const LatticeCoordinates image = nearest_lattice_point(change);
        if (image[0] == 0 && image[1] == 0)
          residual[e] =
              static_cast<std::uint16_t>(std::min<float>(buckets - 1, std::sqrt(squared_length(change)) * buckets));
      }
    }
  });
  std::array<std::size_t, buckets + 1> start{};
  for (const std::uint16_t r : residual)
    if (r != no_join) ++start[r + 1U];
  for (std::size_t b = 0; b < buckets; ++b) start[b + 1] += start[b];
  std::vector<Join> joins(start[buckets]);
  for (std::uint32_t i = 0; i < graph.size(); ++i)
    for (std::uint32_t e = graph.first[i]; e < graph.first[i + 1]; ++e)
      if (residual[e] != no_join) joins[start[residual[e]]++] = {graph.neighbours[e], i};
  return joins;
}

void dissolve_small(Clusters& clusters, std::size_t nodes) {
  std::vector<std::uint32_t> small;
  for (std::uint32_t i = 0; i < nodes; ++i)
    if (clusters.find(i) == i && clusters.cells(i) < smallest_cluster) small.push_back(i);
  std::stable_sort(small.begin(), small.end(),
                   [&](std::uint32_t a, std::uint32_t b) { return clusters.cells(a) < clusters.cells(b); });
  for (const std::uint32_t root : small)
    if (clusters.find(root) == root && clusters.cells(root) < smallest_cluster) clusters.dissolve(root);
}

std::vector<Triangle> faces_between(const SurfaceMesh& mesh, Clusters& clusters) {
  std::vector<Triangle> faces;
  for (const Triangle& t : mesh.triangles) {
    const Triangle f{clusters.find(t[0]), clusters.find(t[1]), clusters.find(t[2])};
    if (f[0] != f[1] && f[1] != f[2] && f[2] != f[0]) faces.push_back(f);
  }
  return faces;
}

// Sets at places where the faces do not make a closed manifold: of each such place the smallest.
std::vector<std::uint32_t> offenders(const std::vector<Triangle>& faces, Clusters& clusters, std::size_t nodes) {
  // Faces by the set at one of their corners.
  std::vector<std::uint32_t> first(nodes + 1, 0);
  for (const Triangle& f : faces)
    for (const std::uint32_t v : f) ++first[v + 1];
  for (std::size_t v = 0; v < nodes; ++v) first[v + 1] += first[v];
  std::vector<std::uint32_t> corners(3 * faces.size());
  std::vector<std::uint32_t> next(first.begin(), first.end() - 1);
  for (std::uint32_t c = 0; c < corners.size(); ++c) corners[next[faces[c / 3][c % 3]]++] = c;

  std::vector<std::uint32_t> found;
  const auto smaller = [&](std::uint32_t a, std::uint32_t b) {
    return clusters.cells(a) < clusters.cells(b) || (clusters.cells(a) == clusters.cells(b) && a < b);
  };
  for (std::uint32_t v = 0; v < nodes; ++v) {
    if (clusters.find(v) != v) continue;
    const std::uint32_t count = first[v + 1] - first[v];
    std::uint32_t smallest = v;
    // Turn around v from face to face; a manifold umbrella comes back after all of them, with one way on from each.
    bool good = count >= 3;
    std::uint32_t met = 0;
    if (good) {
      const auto ahead = [&](std::uint32_t c) { return faces[c / 3][(c + 1) % 3]; };
      const auto behind = [&](std::uint32_t c) { return faces[c / 3][(c + 2) % 3]; };
      const std::uint32_t start = corners[first[v]];
      std::uint32_t c = start;
      do {
        ++met;
        std::uint32_t following = none;
        int ways = 0;
        for (std::uint32_t k = first[v]; k < first[v + 1]; ++k)
          if (ahead(corners[k]) == behind(c)) {
            following = corners[k];
            ++ways;
          }
        if (ways != 1 || met > count) {
          met = none;
          break;
        }
        c = following;
      } while (c != start);
      good = met == count;
    }
    if (good) continue;
    for (std::uint32_t k = first[v]; k < first[v + 1]; ++k)
      for (const std::uint32_t w : faces[corners[k] / 3])
        if (smaller(w, smallest)) smallest = w;
    found.push_back(smallest);
  }
  std::sort(found.begin(), found.end());
  found.erase(std::unique(found.begin(), found.end()), found.end());
  return found;
}

// Whether the result is closed and manifold is known by then: then these numbers say the rest.
bool has_topology_of(const SurfaceMesh& scan, const ExtractedLattice& result) {
  const Components before = find_components(scan), after = find_components(result.mesh);
  if (after.count != before.count) return false;
  const std::vector<long> euler_before = euler_characteristics(scan, before);
  const std::vector<long> euler_after = euler_characteristics(result.mesh, after);
  for (std::size_t i = 0; i < scan.vertices.size(); ++i)
    if (euler_before[before.of_vertex[i]] != euler_after[after.of_vertex[result.vertex_of_node[i]]]) return false;
  return true;
}

// Dissolves what offends until nothing does; false where that does not end.
bool merge_into_manifold(const SurfaceMesh& scan, Clusters& clusters, ExtractedLattice& result) {
  std::vector<Triangle> faces;
  bool manifold = false;
  for (int round = 0; round < rounds_of_mending && !manifold; ++round) {
    faces = faces_between(scan, clusters);
    const std::vector<std::uint32_t> bad = offenders(faces, clusters, scan.vertices.size());
    for (const std::uint32_t root : bad)
      if (clusters.find(root) == root) clusters.dissolve(root);
    manifold = bad.empty();
  }
  if (!manifold) return false;
  result.vertex_of_node.resize(scan.vertices.size());
  std::vector<std::uint32_t> number(scan.vertices.size(), none);
  for (std::uint32_t i = 0; i < number.size(); ++i) {
    const std::uint32_t root = clusters.find(i);
    if (number[root] == none) {
      number[root] = static_cast<std::uint32_t>(result.mesh.vertices.size());
      result.mesh.vertices.push_back(clusters.point(root));
    }
    result.vertex_of_node[i] = number[root];
  }
  for (Triangle& f : faces) f = {number[f[0]], number[f[1]], number[f[2]]};
  result.mesh.triangles = std::move(faces);
  return has_topology_of(scan, result);
}

// Contracts edges inside the clusters while there are any that may be.
ExtractedLattice contract(const SurfaceMesh& scan, Clusters& clusters) {
  HalfedgeMesh mesh(scan);
  std::vector<std::uint32_t> into(scan.vertices.size());
  for (std::uint32_t i = 0; i < into.size(); ++i) into[i] = i;
  for (bool changed = true; changed;) {
    changed = false;
    for (HalfedgeMesh::Index h = 0; h < 3 * mesh.face_slots(); ++h) {
      if (!mesh.is_face_alive(HalfedgeMesh::face(h))) continue;
      const std::uint32_t kept = mesh.origin(h), removed = mesh.target(h);
      if (clusters.find(kept) != clusters.find(removed) || !mesh.can_collapse(h)) continue;
      mesh.collapse(h);
      into[removed] = kept;
      changed = true;
    }
  }
  // A cluster that became one vertex lies at its lattice point, parts of others where their nodes were.
  std::vector<std::uint32_t> parts(scan.vertices.size(), 0);
  std::vector<Vec3> sums(scan.vertices.size(), Vec3::Zero());
  std::vector<double> counts(scan.vertices.size(), 0);
  for (std::uint32_t i = 0; i < into.size(); ++i) {
    std::uint32_t end = i;
    while (into[end] != end) end = into[end];
    into[i] = end;
    sums[end] += scan.vertices[i];
    ++counts[end];
    if (end == i) ++parts[clusters.find(i)];
  }
  std::vector<std::uint32_t> number(scan.vertices.size(), none);
  std::uint32_t alive = 0;
  for (std::uint32_t i = 0; i < into.size(); ++i) {
    if (!mesh.is_alive(i)) continue;
    const std::uint32_t root = clusters.find(i);
    mesh.points[i] = parts[root] == 1 ? clusters.point(root) : Vec3(sums[i] / counts[i]);
    number[i] = alive++;
  }
  ExtractedLattice result;
  result.contracted = true;
  result.mesh = mesh.to_surface();
  result.vertex_of_node.resize(into.size());
  for (std::size_t i = 0; i < into.size(); ++i) result.vertex_of_node[i] = number[into[i]];
  return result;
}

Clusters clusters_of(const GraphLevel& graph, const std::vector<Complex>& directions, const PositionField& position) {
  Clusters clusters(graph, directions, position);
  for (const Join& join : joins_by_residual(graph, position)) clusters.join_if_near(join);
  dissolve_small(clusters, graph.size());
  return clusters;
}

}  // namespace

ExtractedLattice extract_lattice(const RefinedScan& scan, const GraphLevel& graph, const OrientationField& orientation,
                                 const PositionField& position) {
  const std::vector<Complex>& directions = orientation.directions;
  ExtractedLattice result;
  Clusters clusters = clusters_of(graph, directions, position);
  if (merge_into_manifold(scan.mesh, clusters, result)) return result;
  clusters = clusters_of(graph, directions, position);  // without what the attempt has dissolved
  return contract(scan.mesh, clusters);
}

}  // namespace scan2fea
