#include "quality/worst_elements.hpp"

#include "preproc/mesh/numbers.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <numeric>
#include <optional>

namespace scan2fea {
namespace {

std::string degrees_text(double angle) {
  char text[32];
  std::snprintf(text, sizeof text, "%.1f degrees", angle);
  return text;
}

std::string rounded(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.3g", value);
  return text;
}

std::vector<std::uint32_t> indices_of_smallest(const std::vector<double>& values, std::size_t count) {
  std::vector<std::uint32_t> order;
  for (std::uint32_t i = 0; i < values.size(); ++i)
    if (!std::isnan(values[i])) order.push_back(i);
  count = std::min(count, order.size());
  const auto worse = [&](std::uint32_t a, std::uint32_t b) {
    return values[a] != values[b] ? values[a] < values[b] : a < b;
  };
  std::partial_sort(order.begin(), order.begin() + static_cast<std::ptrdiff_t>(count), order.end(), worse);
  order.resize(count);
  return order;
}

// Of the body, where two of its outer faces meet.
double angle_between_faces(const SurfaceMesh& mesh, const Triangle& a, const Triangle& b) {
  return 180 - degrees * angle_between(area_vector(mesh, a), area_vector(mesh, b));
}

double straight_scaled_jacobian(const TetMesh& mesh, std::uint32_t t) {
  const auto& [a, b, c, d] = mesh.tetrahedra[t];
  return measure_tetrahedron(mesh.nodes[a], mesh.nodes[b], mesh.nodes[c], mesh.nodes[d]).scaled_jacobian;
}

std::optional<std::string> cause_on_surface(const ElementMeasures& measures, const std::vector<std::uint32_t>& outer) {
  if (outer.size() >= 2)
    return std::to_string(outer.size()) + " of its faces lie on the surface, which is bent there to " +
           degrees_text(angle_between_faces(measures.faces, measures.faces.triangles[outer[0]],
                                            measures.faces.triangles[outer[1]])) +
           ": an edge of the part sets its shape";
  constexpr double small_angle_deg = 25;  // an equilateral triangle's is 60; below this it bounds the element's shape
  if (outer.size() == 1 && measures.face_min_angle_deg[outer[0]] < small_angle_deg)
    return "its face on the surface has an angle of " + degrees_text(measures.face_min_angle_deg[outer[0]]);
  return {};
}

std::string cause_of(const TetMesh& mesh, const ElementMeasures& measures, std::uint32_t t, const TetShape& shape,
                     const std::vector<bool>& on_surface) {
  const double straight = mesh.order() == 2 ? straight_scaled_jacobian(mesh, t) : shape.scaled_jacobian;
  if (shape.scaled_jacobian <= 0)
    return straight > 0 ? "its curved sides turn it inside out" : "it is inside out, or its corners lie in one plane";
  constexpr double much = 0.1;
  if (straight - shape.scaled_jacobian > much)
    return "its curved sides: with straight ones its scaled Jacobian is " + rounded(straight);
  if (const auto cause = cause_on_surface(measures, outer_faces_of(mesh, t))) return *cause;
  const auto& corners = mesh.tetrahedra[t];
  const auto outside = std::count_if(corners.begin(), corners.end(), [&](auto n) { return on_surface[n]; });
  if (outside == 4) return "all four corners lie on the surface: a thin wall, or one element across";
  constexpr double flat_deg = 150;  // two faces of a sliver lie nearly in one plane
  if (shape.max_dihedral_deg > flat_deg) return "a sliver: its corners lie nearly in one plane";
  if (outside > 0)
    return "beside the surface, on which " + std::to_string(outside) + (outside == 1 ? " corner lies" : " corners lie");
  return "inside, where the nodes around it lie unevenly";
}

// Of those that share an edge with a face: the sharpest angle, or that there is none at one of its edges.
struct FaceSurroundings {
  double sharpest_deg = 180;
  int neighbours = 0;
};

bool share_edge(const Triangle& a, const Triangle& b) {
  const auto in_b = [&](std::uint32_t v) { return std::find(b.begin(), b.end(), v) != b.end(); };
  return std::count_if(a.begin(), a.end(), in_b) == 2;
}

std::vector<FaceSurroundings> surroundings_of(const SurfaceMesh& mesh, const std::vector<std::uint32_t>& faces) {
  std::vector<FaceSurroundings> around(faces.size());
  std::vector<bool> is_near(mesh.vertices.size(), false);
  for (const std::uint32_t f : faces)
    for (const std::uint32_t v : mesh.triangles[f]) is_near[v] = true;
  for (const Triangle& other : mesh.triangles) {
    if (std::count_if(other.begin(), other.end(), [&](auto v) { return is_near[v]; }) < 2) continue;
    for (std::size_t i = 0; i < faces.size(); ++i) {
      if (!share_edge(mesh.triangles[faces[i]], other)) continue;
      ++around[i].neighbours;
      around[i].sharpest_deg =
          std::min(around[i].sharpest_deg, angle_between_faces(mesh, mesh.triangles[faces[i]], other));
    }
  }
  return around;
}

std::string cause_of(const TriangleShape& shape, const FaceSurroundings& around) {
  constexpr double obtuse_deg = 110, crease_deg = 140;  // 140: bent by 40, as the edges that are kept by default
  // Edges are as the sines of the angles across from them: one of a needle is far shorter than both others.
  const double middle_deg = 180 - shape.min_angle_deg - shape.max_angle_deg;
  const bool is_needle = std::sin(middle_deg / degrees) > 2 * std::sin(shape.min_angle_deg / degrees);
  const std::string kind = is_needle ? "a needle, with one short edge"
                           : shape.max_angle_deg > obtuse_deg
                               ? "a cap, with a corner of " + degrees_text(shape.max_angle_deg)
                               : "beside others of the wanted shape";
  if (around.neighbours < 3) return kind + "; at an open border";
  if (around.sharpest_deg < crease_deg)
    return kind + "; along an edge where the surface is bent to " + degrees_text(around.sharpest_deg);
  return kind + "; where the surface is smooth";
}

}  // namespace

std::vector<std::uint32_t> outer_faces_of(const TetMesh& mesh, std::uint32_t tetrahedron) {
  std::vector<std::uint32_t> faces;
  for (std::uint32_t f = 0; f < mesh.outer_faces(); ++f)
    if (mesh.boundary[f].tetrahedron == tetrahedron) faces.push_back(f);
  return faces;
}

std::vector<WorstTetrahedron> worst_tetrahedra(const TetMesh& mesh, const ElementMeasures& measures,
                                               std::size_t count) {
  std::vector<bool> on_surface(mesh.nodes.size(), false);
  for (const Triangle& t : measures.faces.triangles)
    for (const std::uint32_t v : t) on_surface[v] = true;
  std::vector<WorstTetrahedron> worst;
  for (const std::uint32_t t : indices_of_smallest(measures.scaled_jacobian, count)) {
    const TetShape shape = measure_tetrahedron(mesh, t);
    Vec3 place = Vec3::Zero();
    for (const std::uint32_t n : mesh.tetrahedra[t]) place += mesh.nodes[n] / 4;
    worst.push_back({t, shape, place, cause_of(mesh, measures, t, shape, on_surface)});
  }
  return worst;
}

std::vector<WorstTriangle> worst_triangles(const ElementMeasures& measures, std::size_t count) {
  const SurfaceMesh& mesh = measures.faces;
  const std::vector<std::uint32_t> faces = indices_of_smallest(measures.face_min_angle_deg, count);
  const std::vector<FaceSurroundings> around = surroundings_of(mesh, faces);
  std::vector<WorstTriangle> worst;
  for (std::size_t i = 0; i < faces.size(); ++i) {
    const Triangle& t = mesh.triangles[faces[i]];
    const auto shape = measure_triangle(mesh.vertices[t[0]], mesh.vertices[t[1]], mesh.vertices[t[2]]);
    worst.push_back({faces[i], *shape, centroid(mesh, t), cause_of(*shape, around[i])});
  }
  return worst;
}

std::vector<std::string> sets_with(std::span<const NamedSet> sets, std::span<const std::uint32_t> members) {
  std::vector<std::string> names;
  for (const NamedSet& set : sets)
    if (std::ranges::any_of(members, [&](auto m) { return std::ranges::binary_search(set.members, m); }))
      names.push_back(set.name);
  return names;
}

}  // namespace scan2fea
