#include "quality/extreme_elements.hpp"

#include "quality/tetrahedron_measures.hpp"
#include "quality/triangle_measures.hpp"

#include <array>
#include <functional>

namespace scan2fea {
namespace {

// Larger is worse; nothing of an element that does not enter the figure.
using Badness = std::optional<double> (*)(const TetMesh&, std::size_t);
using TriangleBadness = double (*)(const TriangleShape&);

FaceAngles face_angles(const TetMesh& mesh, std::size_t t) {
  const Tetrahedron& c = mesh.tetrahedra[t];
  return measure_face_angles(mesh.nodes[c[0]], mesh.nodes[c[1]], mesh.nodes[c[2]], mesh.nodes[c[3]]);
}

constexpr std::array<std::pair<std::string_view, Badness>, 8> of_tetrahedra{{
    {"volume_mesh.scaled_jacobian.min",
     [](const TetMesh& mesh, std::size_t t) { return std::optional(-measure_tetrahedron(mesh, t).scaled_jacobian); }},
    {"volume_mesh.inverted",
     [](const TetMesh& mesh, std::size_t t) {
       const double jacobian = measure_tetrahedron(mesh, t).scaled_jacobian;
       return jacobian > 0 ? std::nullopt : std::optional(-jacobian);
     }},
    {"volume_mesh.min_dihedral_deg",
     [](const TetMesh& mesh, std::size_t t) { return std::optional(-measure_tetrahedron(mesh, t).min_dihedral_deg); }},
    {"volume_mesh.max_dihedral_deg",
     [](const TetMesh& mesh, std::size_t t) { return std::optional(measure_tetrahedron(mesh, t).max_dihedral_deg); }},
    {"volume_mesh.min_face_angle_deg",
     [](const TetMesh& mesh, std::size_t t) { return std::optional(-face_angles(mesh, t).min_deg); }},
    {"volume_mesh.max_face_angle_deg",
     [](const TetMesh& mesh, std::size_t t) { return std::optional(face_angles(mesh, t).max_deg); }},
    {"volume_mesh.edge_ratio",
     [](const TetMesh& mesh, std::size_t t) { return measure_tetrahedron(mesh, t).edge_ratio; }},
    {"volume_mesh.radius_edge_ratio",
     [](const TetMesh& mesh, std::size_t t) { return measure_tetrahedron(mesh, t).radius_edge_ratio; }},
}};

constexpr std::array<std::pair<std::string_view, TriangleBadness>, 4> of_triangles{{
    {"surface.edge_ratio.max", [](const TriangleShape& shape) { return shape.edge_ratio; }},
    {"surface.min_angle_deg.min", [](const TriangleShape& shape) { return -shape.min_angle_deg; }},
    {"surface.max_angle_deg", [](const TriangleShape& shape) { return shape.max_angle_deg; }},
    {"surface.radius_ratio.min", [](const TriangleShape& shape) { return -shape.radius_ratio; }},
}};

template <class Table>
auto measure_for(const Table& table, std::string_view figure) {
  for (const auto& [name, measure] : table)
    if (name == figure) return measure;
  return decltype(table[0].second){nullptr};
}

template <class Measure>
std::optional<std::uint32_t> worst_of(std::size_t count, Measure badness_of) {
  std::optional<std::uint32_t> worst;
  double most = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const std::optional<double> badness = badness_of(i);
    if (!badness || (worst && *badness <= most)) continue;
    worst = static_cast<std::uint32_t>(i);
    most = *badness;
  }
  return worst;
}

template <class Corners>
Vec3 middle(const std::vector<Vec3>& points, const Corners& corners) {
  Vec3 sum = Vec3::Zero();
  for (const std::uint32_t v : corners) sum += points[v];
  return sum / static_cast<double>(corners.size());
}

}  // namespace

std::optional<ExtremeElement> extreme_tetrahedron(const TetMesh& mesh, std::string_view figure) {
  const Badness measure = measure_for(of_tetrahedra, figure);
  if (measure == nullptr) return std::nullopt;
  const auto worst = worst_of(mesh.tetrahedra.size(), [&](std::size_t t) { return measure(mesh, t); });
  if (!worst) return std::nullopt;
  return ExtremeElement{*worst, middle(mesh.nodes, mesh.tetrahedra[*worst])};
}

std::optional<ExtremeElement> extreme_triangle(const SurfaceMesh& mesh, std::string_view figure) {
  const TriangleBadness measure = measure_for(of_triangles, figure);
  if (measure == nullptr) return std::nullopt;
  const auto worst = worst_of(mesh.triangles.size(), [&](std::size_t f) -> std::optional<double> {
    const Triangle& t = mesh.triangles[f];
    const auto shape = measure_triangle(mesh.vertices[t[0]], mesh.vertices[t[1]], mesh.vertices[t[2]]);
    return shape ? std::optional(measure(*shape)) : std::nullopt;
  });
  if (!worst) return std::nullopt;
  return ExtremeElement{*worst, middle(mesh.vertices, mesh.triangles[*worst])};
}

}  // namespace scan2fea
