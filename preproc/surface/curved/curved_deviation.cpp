#include "preproc/surface/curved/curved_deviation.hpp"

#include "quality/curved_surface.hpp"
#include "quality/triangle_tree.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <numeric>
#include <unordered_map>
#include <utility>

namespace scan2fea {
namespace {

// Plane pieces are this near to the curved faces, over the distance that is to be kept.
constexpr double coarse = 0.1, fine = 0.01;

// Faces cut into plane pieces, and the face of each.
struct Pieces {
  SurfaceMesh mesh;
  std::vector<std::uint32_t> face;
};

// Vertices of pieces that are one point of the surface are one vertex: from one piece to the next a bound walks, but
// not over a border. Edges that are cut into different numbers of pieces keep theirs.
class JoinedVertices {
 public:
  JoinedVertices(const CurvedSurface& surface, std::size_t first) : surface_(surface), next_(first) {}

  // Of the second and third coordinates on a face, whether it is inside the face or at its border.
  std::uint32_t number(std::uint32_t face, const Eigen::Vector2d& place) {
    // Of parts of up to most_cuts, all are whole here.
    constexpr double scale = 720720;
    const std::array parts{std::llround(scale * (1 - place[0] - place[1])), std::llround(scale * place[0]),
                           std::llround(scale * place[1])};
    const Triangle& corners = surface_.corners.triangles[face];
    for (std::size_t k = 0; k < 3; ++k) {
      const std::size_t next = (k + 1) % 3, last = (k + 2) % 3;
      if (parts[next] == 0 && parts[last] == 0) return known(~std::uint64_t{corners[k]});
      if (parts[k] != 0 || parts[next] == 0 || parts[last] == 0) continue;
      const std::uint64_t edge = surface_.mid_of_face[face][next];
      return known(edge << 20 | static_cast<std::uint64_t>(parts[corners[next] < corners[last] ? next : last]));
    }
    return static_cast<std::uint32_t>(next_++);
  }

 private:
  std::uint32_t known(std::uint64_t key) {
    const auto [at, is_new] = numbers_.try_emplace(key, static_cast<std::uint32_t>(next_));
    if (is_new) ++next_;
    return at->second;
  }

  const CurvedSurface& surface_;
  std::size_t next_;
  std::unordered_map<std::uint64_t, std::uint32_t> numbers_;
};

void add_pieces(const CurvedSurface& surface, const std::vector<std::uint32_t>& faces, double tolerance,
                Pieces& pieces) {
  std::vector<Vec3> nodes = surface.corners.vertices;
  nodes.insert(nodes.end(), surface.mid.begin(), surface.mid.end());
  std::vector<CurvedTriangle> triangles(faces.size());
  for (std::size_t i = 0; i < faces.size(); ++i)
    std::ranges::copy(surface.nodes_of(faces[i]), triangles[i].nodes.begin());
  const FlatPieces flat = flat_pieces(std::move(nodes), triangles, tolerance);
  constexpr std::uint32_t unknown = ~std::uint32_t{0};
  JoinedVertices joined(surface, pieces.mesh.vertices.size());
  std::vector<std::uint32_t> number(flat.mesh.vertices.size(), unknown);
  for (std::size_t piece = 0; piece < flat.of_piece.size(); ++piece) {
    const std::uint32_t face = faces[flat.of_piece[piece]];
    Triangle t = flat.mesh.triangles[piece];
    for (std::size_t k = 0; k < 3; ++k) {
      std::uint32_t& n = number[t[k]];
      if (n == unknown) n = joined.number(face, flat.places[piece][k]);
      if (n == pieces.mesh.vertices.size()) pieces.mesh.vertices.push_back(flat.mesh.vertices[t[k]]);
      t[k] = n;
    }
    pieces.mesh.triangles.push_back(t);
    pieces.face.push_back(face);
  }
}

std::vector<std::uint32_t> all_of(std::size_t count) {
  std::vector<std::uint32_t> all(count);
  std::iota(all.begin(), all.end(), 0U);
  return all;
}

std::vector<std::uint32_t> without_copies(std::vector<std::uint32_t> values) {
  std::ranges::sort(values);
  values.erase(std::ranges::unique(values).begin(), values.end());
  return values;
}

// Bounds by pieces that are `part` of the distance from what they stand for.
DeviationBoundOptions options(const KeptDeviation& kept, double part) {
  return {.limit = (1 - part) * kept.distance, .tolerance = 3 * part};
}

void note(const OneSidedDeviation& of_pieces, const std::vector<std::uint32_t>& number, double error,
          OneSidedDeviation& bound) {
  for (std::size_t i = 0; i < number.size(); ++i) {
    const std::uint32_t n = number[i];
    if (of_pieces.upper[i] + error <= bound.upper[n]) continue;
    bound.upper[n] = of_pieces.upper[i] + error;
    bound.lower[n] = std::max(0.0, of_pieces.lower[i] - error);
    bound.farthest[n] = of_pieces.farthest[i];
  }
}

void forget(const std::vector<std::uint32_t>& numbers, OneSidedDeviation& bound) {
  for (const std::uint32_t n : numbers) bound.upper[n] = 0;
}

std::vector<std::uint32_t> beyond(const OneSidedDeviation& bound, double distance) {
  std::vector<std::uint32_t> found;
  for (std::uint32_t i = 0; i < bound.upper.size(); ++i)
    if (bound.upper[i] > distance) found.push_back(i);
  return found;
}

OneSidedDeviation unknown(std::size_t count) {
  return {.lower = std::vector<double>(count, 0),
          .upper = std::vector<double>(count, 0),
          .farthest = std::vector<Vec3>(count, Vec3::Zero())};
}

void note_largest(OneSidedDeviation& bound) {
  if (bound.upper.empty()) return;
  bound.largest_lower = *std::ranges::max_element(bound.lower);
  const auto worst = std::ranges::max_element(bound.upper);
  bound.largest_upper = *worst;
  bound.worst_face = static_cast<std::uint32_t>(worst - bound.upper.begin());
}

// Per face of the surface; 0 where it is not one of `faces`.
OneSidedDeviation bound_faces(const CurvedSurface& surface, const KeptDeviation& kept,
                              std::vector<std::uint32_t> faces) {
  OneSidedDeviation bound = unknown(surface.corners.triangles.size());
  for (const double part : {coarse, fine}) {
    if (faces.empty()) break;
    forget(faces, bound);
    Pieces pieces;
    add_pieces(surface, faces, part * kept.distance, pieces);
    note(bound_one_sided_deviation(pieces.mesh, kept.scan, options(kept, part)), pieces.face, part * kept.distance,
         bound);
    faces = beyond(bound, kept.distance);
  }
  note_largest(bound);
  return bound;
}

struct BoundOfScan {
  OneSidedDeviation bound;             // per triangle of the scan
  std::vector<std::uint32_t> nearest;  // faces nearest to those that are too far; sorted
};

BoundOfScan bound_scan(const CurvedSurface& surface, const KeptDeviation& kept) {
  const SurfaceMesh& scan = kept.scan.mesh();
  BoundOfScan result{.bound = unknown(scan.triangles.size()), .nearest = all_of(surface.corners.triangles.size())};
  std::vector<std::uint32_t> asked = all_of(scan.triangles.size());
  Pieces pieces;
  for (const double part : {coarse, fine}) {
    if (result.nearest.empty()) break;
    add_pieces(surface, result.nearest, part * kept.distance, pieces);
    forget(asked, result.bound);
    SurfaceMesh of_scan{scan.vertices, {}};
    for (const std::uint32_t f : asked) of_scan.triangles.push_back(scan.triangles[f]);
    note(bound_one_sided_deviation(of_scan, pieces.mesh, options(kept, part)), asked, part * kept.distance,
         result.bound);
    asked = beyond(result.bound, kept.distance);
    result.nearest.clear();
    if (asked.empty()) break;
    const TriangleTree tree(pieces.mesh);
    for (const std::uint32_t f : asked)
      result.nearest.push_back(pieces.face[tree.closest(result.bound.farthest[f]).triangle]);
    result.nearest = without_copies(std::move(result.nearest));
  }
  note_largest(result.bound);
  return result;
}

}  // namespace

DeviationBound bound_curved_deviation(const CurvedSurface& surface, const KeptDeviation& kept) {
  return {.to_reference = bound_faces(surface, kept, all_of(surface.corners.triangles.size())),
          .to_mesh = bound_scan(surface, kept).bound};
}

std::vector<std::uint32_t> faces_beyond(const CurvedSurface& surface, const KeptDeviation& kept,
                                        const std::vector<std::uint32_t>& faces) {
  std::vector<std::uint32_t> found = beyond(bound_faces(surface, kept, faces), kept.distance);
  if (faces.size() < surface.corners.triangles.size()) return found;
  std::vector<std::uint32_t> both;
  std::ranges::set_union(found, bound_scan(surface, kept).nearest, std::back_inserter(both));
  return both;
}

}  // namespace scan2fea
