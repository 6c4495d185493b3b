#include "preproc/command/quality_fields.hpp"

#include "preproc/made_up.hpp"
#include "quality/element_measures.hpp"
#include "quality/jacobian_bound.hpp"
#include "quality/signed_deviation.hpp"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <string_view>
#include <utility>

namespace scan2fea::command {
namespace {

std::vector<double> jacobian_shares(const TetMesh& mesh) {
  std::vector<double> shares(mesh.tetrahedra.size());
  tbb::parallel_for(std::size_t{0}, shares.size(), [&](std::size_t t) {
    const auto& [a, b, c, d] = mesh.tetrahedra[t];
    const std::vector<Vec3>& x = mesh.nodes;
    const double straight = (x[b] - x[a]).cross(x[c] - x[a]).dot(x[d] - x[a]);
    const double least = min_jacobian_bound(curved_tetrahedron(mesh, t)).lower;
    shares[t] = straight > 0 ? least / straight : 0;
  });
  return shares;
}

// Verdict's of triangles: the sine of the smallest angle, which the two longest sides enclose, over that of an
// equilateral one.
std::vector<double> scaled_jacobians(const std::vector<double>& min_angles_deg) {
  constexpr double degree = std::numbers::pi / 180;
  std::vector<double> values;
  values.reserve(min_angles_deg.size());
  for (const double angle : min_angles_deg) values.push_back(std::sin(degree * angle) * 2 / std::numbers::sqrt3);
  return values;
}

// `element_of(f)`: the place in the list of the element that has face f, or nothing.
template <class ElementOf>
void add_face_fields(std::span<const NamedSet> sets, std::size_t elements, const ElementOf& element_of,
                     FileOptions& options) {
  Field face{.name = "face", .values = std::vector<double>(elements, 0)};
  Field made_up{.name = "made_up", .values = std::vector<double>(elements, 0), .names = {filled_set, enriched_set}};
  bool any_made_up = false;
  for (const NamedSet& set : sets) {
    const auto made = std::find(made_up.names.begin(), made_up.names.end(), set.name);
    const bool is_made_up = made != made_up.names.end();
    any_made_up |= is_made_up;
    if (!is_made_up) face.names.push_back(options.set_prefix + set.name);
    const auto number = static_cast<double>(is_made_up ? made - made_up.names.begin() + 1 : std::ssize(face.names));
    std::vector<double>& values = (is_made_up ? made_up : face).values;
    for (const std::uint32_t f : set.members)
      if (const std::uint32_t e = element_of(f); values[e] == 0) values[e] = number;
  }
  if (!face.names.empty()) options.element_fields.push_back(std::move(face));
  if (any_made_up) options.element_fields.push_back(std::move(made_up));
}

template <class Mesh>
void add_deviation(const Mesh& mesh, const SurfaceMesh* reference, FileOptions& options) {
  if (reference == nullptr || reference->triangles.empty()) return;
  options.node_fields.push_back(
      {.name = "deviation", .values = signed_deviations_of_nodes(mesh, TriangleTree(*reference))});
}

}  // namespace

bool is_quality_field(std::string_view name) {
  constexpr std::array<std::string_view, 9> names{"scaled_jacobian",  "edge_ratio",       "min_angle",      "max_angle",
                                                  "min_dihedral_deg", "max_dihedral_deg", "jacobian_share", "face",
                                                  "made_up"};
  return std::ranges::find(names, name) != names.end();
}

void add_quality_fields(const TetMesh& mesh, const SurfaceMesh* reference, FileOptions& options) {
  ElementMeasures measures = measure_elements(mesh, nullptr);
  std::vector<Field>& fields = options.element_fields;
  fields.push_back({.name = "scaled_jacobian", .values = std::move(measures.scaled_jacobian)});
  fields.push_back({.name = "edge_ratio", .values = std::move(measures.edge_ratio)});
  fields.push_back({.name = "min_dihedral_deg", .values = std::move(measures.min_dihedral_deg)});
  fields.push_back({.name = "max_dihedral_deg", .values = std::move(measures.max_dihedral_deg)});
  if (mesh.order() == 2) fields.push_back({.name = "jacobian_share", .values = jacobian_shares(mesh)});
  add_face_fields(
      mesh.face_sets, mesh.tetrahedra.size(), [&](std::uint32_t f) { return mesh.boundary[f].tetrahedron; }, options);
  add_deviation(mesh, reference, options);
}

void add_quality_fields(const NamedSurface& surface, const SurfaceMesh* reference, FileOptions& options) {
  ElementMeasures measures = measure_elements(surface.mesh, nullptr);
  std::vector<Field>& fields = options.element_fields;
  fields.push_back({.name = "scaled_jacobian", .values = scaled_jacobians(measures.face_min_angle_deg)});
  fields.push_back({.name = "edge_ratio", .values = std::move(measures.face_edge_ratio)});
  fields.push_back({.name = "min_angle", .values = std::move(measures.face_min_angle_deg)});
  fields.push_back({.name = "max_angle", .values = std::move(measures.face_max_angle_deg)});
  add_face_fields(
      surface.face_sets, surface.mesh.triangles.size(), [](std::uint32_t f) { return f; }, options);
  add_deviation(surface.mesh, reference, options);
}

}  // namespace scan2fea::command
