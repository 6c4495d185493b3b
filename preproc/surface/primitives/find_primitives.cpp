#include "preproc/surface/primitives/find_primitives.hpp"

#include "preproc/mesh/names.hpp"
#include "preproc/surface/kernel/adjacency.hpp"
#include "preproc/surface/primitives/grow_shapes.hpp"
#include "preproc/surface/primitives/point_normals.hpp"
#include "preproc/surface/primitives/shape_relations.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>

namespace scan2fea {
namespace {

constexpr std::size_t neighbours_per_point = 20;

constexpr NameTable<PrimitiveUse, 5> use_names{{
    {PrimitiveUse::face, "face"},
    {PrimitiveUse::hole, "hole"},
    {PrimitiveUse::boss, "boss"},
    {PrimitiveUse::fillet, "fillet"},
    {PrimitiveUse::rounding, "rounding"},
}};

// Where nothing is noisy, facets and rounding are: a hundredth of the spacing is the height of a facet of half of it on
// a radius of three.
ShapeNoise noise_of(const PointNormals& normals) {
  constexpr double least_of_spacing = 0.01;
  // 8 degrees: what curvature and uneven neighbours leave on normals without noise.
  constexpr double least_angle = 0.14;
  if (!(normals.spacing > 0)) return {1, 1};
  return {.sigma = std::max(normals.noise, least_of_spacing * normals.spacing),
          .sigma_angle = least_angle + normals.noise / normals.spacing};
}

// The points around the axis: how far they reach along it, and how much of the circle they leave open.
struct Reach {
  double extent = 0, turn_deg = 0;
};

Reach reach_of(const Shape& shape, const std::vector<Vec3>& points, const std::vector<std::uint32_t>& which) {
  const Vec3 x = shape.axis.unitOrthogonal(), y = shape.axis.cross(x);
  std::vector<double> angles;
  double low = HUGE_VAL, high = -HUGE_VAL;
  Vec3 least = Vec3::Constant(HUGE_VAL), most = -least;
  for (const std::uint32_t i : which) {
    const Vec3 d = points[i] - shape.origin;
    low = std::min(low, d.dot(shape.axis));
    high = std::max(high, d.dot(shape.axis));
    angles.push_back(std::atan2(d.dot(y), d.dot(x)));
    least = least.cwiseMin(points[i]);
    most = most.cwiseMax(points[i]);
  }
  if (which.empty()) return {};
  if (shape.kind == ShapeKind::plane || shape.kind == ShapeKind::sphere) return {(most - least).norm(), 0};
  std::sort(angles.begin(), angles.end());
  double gap = angles.front() + 2 * std::numbers::pi - angles.back();
  for (std::size_t i = 0; i + 1 < angles.size(); ++i) gap = std::max(gap, angles[i + 1] - angles[i]);
  // Of points all around, one gap of the mean size is none.
  const double open = gap * (1 - 1 / static_cast<double>(which.size()));
  return {high - low, gap < std::numbers::pi / 3 ? 360 : 360 - open * 180 / std::numbers::pi};
}

PrimitiveUse use_of(const Shape& shape, double turn_deg, bool tangent) {
  switch (shape.kind) {
    case ShapeKind::cylinder:
      if (turn_deg > (tangent ? 180 : 120)) return shape.hollow ? PrimitiveUse::hole : PrimitiveUse::boss;
      return shape.hollow ? PrimitiveUse::fillet : PrimitiveUse::rounding;
    case ShapeKind::torus:
    case ShapeKind::sphere:
      return shape.hollow ? PrimitiveUse::fillet : PrimitiveUse::rounding;
    default:
      return PrimitiveUse::face;
  }
}

void describe(const OrientedPoints& cloud, ShapeSet&& grown, Primitives& found) {
  for (const FoundShape& shape : grown.shapes) {
    const Reach reach = reach_of(shape.shape, cloud.points, shape.points);
    Primitive primitive{.shape = shape.shape,
                        .use = use_of(shape.shape, reach.turn_deg, shape.relations.tangent_to.has_value()),
                        .points = shape.points.size(),
                        .fit = rms_distance(cloud, shape.shape, shape.points),
                        .extent = reach.extent,
                        .turn_deg = reach.turn_deg,
                        .degrees_of_freedom = static_cast<int>(shape.freedom.size()),
                        .relations = shape.relations};
    found.list.push_back(primitive);
  }
  found.labels = std::move(grown.labels);
}

}  // namespace

std::string_view name_of(PrimitiveUse use) {
  return name_in(use_names, use);
}

std::string describe(const Primitive& primitive) {
  const bool torus = primitive.shape.kind == ShapeKind::torus;
  char text[160];
  if (primitive.shape.kind == ShapeKind::plane || primitive.shape.kind == ShapeKind::cone)
    std::snprintf(text, sizeof text, "%s, %s, %zu points, fit %.3g", std::string(name_of(primitive.use)).c_str(),
                  std::string(name_of(primitive.shape.kind)).c_str(), primitive.points, primitive.fit);
  else
    std::snprintf(text, sizeof text, "%s, radius %.4g, %zu points, fit %.3g",
                  std::string(name_of(primitive.use)).c_str(),
                  torus ? primitive.shape.tube_radius : primitive.shape.radius, primitive.points, primitive.fit);
  return text;
}

Primitives find_primitives(const std::vector<Vec3>& points, const Neighbours& neighbours,
                           const std::vector<Vec3>& outwards, const PrimitiveOptions& options,
                           const Progress& progress) {
  PointNormals normals = own_side_normals(points, neighbours, outwards);
  const ShapeNoise noise = noise_of(normals);
  Primitives found;
  found.noise = normals.noise;
  found.sigma = noise.sigma;
  found.spacing = normals.spacing;
  ShapeSet grown =
      grow_shapes(points, neighbours, outwards, noise, normals.normals, [&] { progress("primitives", 0.5); });
  const OrientedPoints cloud{points, normals.normals};
  // Relations let fewer points decide a shape, and shapes that are surer win points back; then both once more.
  for (int round = 0; round < 2; ++round) {
    compete_for_points(cloud, neighbours, noise, 2, grown);
    impose_relations(cloud, neighbours, noise, grown);
  }
  relabel_points(cloud, neighbours, noise, grown);
  std::size_t described = 0;
  int freedom = 0;
  for (const FoundShape& shape : grown.shapes) {
    described += shape.points.size();
    freedom += degrees_of_freedom(shape.shape.kind);
  }
  found.points_per_freedom = freedom > 0 ? static_cast<double>(described) / freedom : 0;
  if (2 * described >= points.size() && found.points_per_freedom >= options.points_per_freedom) {
    found.kind = ScanKind::part;
    describe(cloud, std::move(grown), found);
  } else {
    found.labels.assign(points.size(), no_primitive);
  }
  found.normals = std::move(normals.normals);
  return found;
}

Primitives find_primitives(const SurfaceMesh& mesh, const PrimitiveOptions& options, const Progress& progress) {
  return find_primitives(mesh.vertices, nearest_on_surface(mesh, neighbours_per_point), vertex_normals(mesh), options,
                         progress);
}

}  // namespace scan2fea
