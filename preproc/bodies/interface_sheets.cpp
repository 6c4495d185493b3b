#include "preproc/bodies/interface_sheets.hpp"

#include "preproc/bodies/split_surface.hpp"
#include "preproc/surface/kernel/cut_surface.hpp"
#include "preproc/surface/kernel/halfedge_mesh.hpp"

#include <algorithm>
#include <map>

namespace scan2fea {
namespace {

// Of the diagonal: what the frames in which surfaces are made leave of a place.
constexpr double rounding = 1e-6;

using TrianglesOfEdge = std::map<FeatureEdge, std::vector<std::uint32_t>>;

TrianglesOfEdge triangles_of_edges(const SurfaceMesh& mesh) {
  TrianglesOfEdge of_edge;
  for (std::uint32_t f = 0; f < mesh.triangles.size(); ++f)
    for (std::size_t k = 0; k < 3; ++k)
      of_edge[feature_edge(mesh.triangles[f][k], mesh.triangles[f][(k + 1) % 3])].push_back(f);
  return of_edge;
}

// The part of an edge's way that is nearest to a point, 0 to 1.
double nearest_part(const Vec3& p, const Vec3& a, const Vec3& b) {
  const Vec3 way = b - a;
  return std::clamp(way.dot(p - a) / std::max(way.squaredNorm(), 1e-300), 0.0, 1.0);
}

// Edges shorter than this part of the mean distance of the border's points are merged.
constexpr double short_edge = 0.15;
// Cosine of the angle by which triangles may turn then.
constexpr double least_turn = 0.995;

// Merges vertices that are nobody's points into neighbours that are near, shortest edges first.
class Merging {
 public:
  Merging(const SurfaceMesh& mesh, std::vector<std::uint32_t>& point_of_vertex)
      : mesh_(mesh), point_of_vertex_(point_of_vertex) {}

  void run(double shorter_than) {
    for (bool again = true; again;) {
      again = false;
      std::vector<std::pair<double, HalfedgeMesh::Index>> edges;
      for (HalfedgeMesh::Index h = 0; h < 3 * mesh_.face_slots(); ++h)
        if (mesh_.is_face_alive(HalfedgeMesh::face(h)))
          if (const double l = length(h); l < shorter_than) edges.emplace_back(l, h);
      std::sort(edges.begin(), edges.end());
      for (const auto& [l, h] : edges)
        if (mesh_.is_face_alive(HalfedgeMesh::face(h)) && length(h) == l) again |= merge(h);
    }
  }

  // Vertices that are left keep their order, so that theirs of `point_of_vertex` do.
  SurfaceMesh result() {
    std::vector<std::uint32_t> points;
    for (std::uint32_t v = 0; v < mesh_.vertex_slots(); ++v)
      if (mesh_.is_alive(v)) points.push_back(point_of_vertex_[v]);
    point_of_vertex_ = std::move(points);
    return mesh_.to_surface();
  }

 private:
  double length(HalfedgeMesh::Index h) const {
    return (mesh_.points[mesh_.origin(h)] - mesh_.points[mesh_.target(h)]).norm();
  }

  bool merge(HalfedgeMesh::Index h) {
    // The target goes, so that a border's half-edge is tried from both of its ends.
    if (goes(mesh_.target(h), mesh_.origin(h), h)) {
      mesh_.collapse(h);
      return true;
    }
    const HalfedgeMesh::Index back = mesh_.opposite(h);
    if (back != HalfedgeMesh::none || !goes(mesh_.origin(h), mesh_.target(h), h)) return false;
    const Vec3 place = mesh_.points[mesh_.target(h)];
    point_of_vertex_[mesh_.origin(h)] = point_of_vertex_[mesh_.target(h)];
    mesh_.points[mesh_.origin(h)] = place;
    mesh_.collapse(h);
    return true;
  }

  bool goes(std::uint32_t v, std::uint32_t into, HalfedgeMesh::Index h) const {
    if (point_of_vertex_[v] != no_point || (mesh_.is_border_vertex(v) && !mesh_.is_border(h)) || !mesh_.can_collapse(h))
      return false;
    bool stays = true;
    mesh_.for_each_outgoing(v, [&](HalfedgeMesh::Index out) {
      const std::uint32_t b = mesh_.target(out), c = mesh_.target(HalfedgeMesh::next(out));
      if (b == into || c == into) return;
      const Vec3 before = mesh_.area_vector(HalfedgeMesh::face(out));
      const Vec3 after = (mesh_.points[b] - mesh_.points[into]).cross(mesh_.points[c] - mesh_.points[into]);
      stays = stays && after.dot(before) >= least_turn * after.norm() * before.norm() && after.norm() > 0;
    });
    return stays;
  }

  HalfedgeMesh mesh_;
  std::vector<std::uint32_t>& point_of_vertex_;
};

double border_length(const SurfaceMesh& mesh, const std::vector<FeatureEdge>& border) {
  double length = 0;
  for (const auto& [a, b] : border) length += (mesh.vertices[a] - mesh.vertices[b]).norm();
  return length;
}

}  // namespace

ComplexLines find_lines(const BodyComplex& complex) {
  ComplexLines lines;
  for (const auto& [edge, triangles] : triangles_of_edges(complex.mesh)) {
    const Sides& first = complex.sides[triangles.front()];
    bool is_outer = false, is_line = false;
    for (const std::uint32_t f : triangles) {
      is_outer |= complex.sides[f].front == no_body;
      is_line |= complex.sides[f] != first;
    }
    if (is_line) (is_outer ? lines.outer : lines.inner).push_back(edge);
  }
  return lines;
}

std::vector<Sheet> find_sheets(const BodyComplex& complex) {
  const TrianglesOfEdge of_edge = triangles_of_edges(complex.mesh);
  std::vector<bool> reached(complex.sides.size(), false);
  std::vector<Sheet> sheets;
  for (std::uint32_t seed = 0; seed < reached.size(); ++seed) {
    if (reached[seed] || complex.sides[seed].front == no_body) continue;
    Sheet sheet{.sides = complex.sides[seed], .triangles = {seed}, .is_closed = true};
    reached[seed] = true;
    for (std::size_t i = 0; i < sheet.triangles.size(); ++i) {
      const Triangle& t = complex.mesh.triangles[sheet.triangles[i]];
      for (std::size_t k = 0; k < 3; ++k) {
        std::size_t within = 0;
        for (const std::uint32_t f : of_edge.at(feature_edge(t[k], t[(k + 1) % 3]))) {
          if (complex.sides[f] != sheet.sides) continue;
          ++within;
          if (reached[f]) continue;
          reached[f] = true;
          sheet.triangles.push_back(f);
        }
        sheet.is_closed &= within == 2;
      }
    }
    std::sort(sheet.triangles.begin(), sheet.triangles.end());
    sheets.push_back(std::move(sheet));
  }
  return sheets;
}

SheetSurface extract_sheet(const BodyComplex& complex, const Sheet& sheet, const std::vector<Vec3>& points,
                           const std::vector<std::uint32_t>& candidates) {
  SurfaceMesh mesh;
  std::map<std::uint32_t, std::uint32_t> number;
  for (const std::uint32_t f : sheet.triangles) {
    Triangle t = complex.mesh.triangles[f];
    for (std::uint32_t& v : t) {
      const auto [at, is_new] = number.try_emplace(v, static_cast<std::uint32_t>(mesh.vertices.size()));
      if (is_new) mesh.vertices.push_back(complex.mesh.vertices[v]);
      v = at->second;
    }
    mesh.triangles.push_back(t);
  }
  const double near = rounding * bounding_box(complex.mesh.vertices).diagonal();
  std::vector<FeatureEdge> border = boundary_edges(mesh);
  SplitSurface split(std::move(mesh));
  SheetSurface result{.mesh = {}, .point_of_vertex = std::vector(split.mesh().vertices.size(), no_point)};
  for (const std::uint32_t candidate : candidates) {
    const Vec3& p = points[candidate];
    for (std::size_t e = 0; e < border.size(); ++e) {
      const auto [a, b] = border[e];
      const Vec3 &from = split.point(a), &to = split.point(b);
      const double part = nearest_part(p, from, to);
      if (((1 - part) * from + part * to - p).norm() > near) continue;
      if ((from - p).norm() <= near || (to - p).norm() <= near) {
        result.point_of_vertex[(from - p).norm() <= near ? a : b] = candidate;
      } else {
        const std::uint32_t v = split.split_edge(a, b, p);
        result.point_of_vertex.push_back(candidate);
        border[e] = feature_edge(a, v);
        border.push_back(feature_edge(v, b));
      }
      break;
    }
  }
  result.mesh = split.mesh();
  for (std::size_t v = 0; v < result.point_of_vertex.size(); ++v)
    if (result.point_of_vertex[v] != no_point) result.mesh.vertices[v] = points[result.point_of_vertex[v]];
  const auto on_border = std::ranges::count_if(result.point_of_vertex, [](std::uint32_t p) { return p != no_point; });
  if (on_border == 0) return result;
  Merging merging(result.mesh, result.point_of_vertex);
  merging.run(short_edge * border_length(result.mesh, border) / static_cast<double>(on_border));
  result.mesh = merging.result();
  return result;
}

}  // namespace scan2fea
