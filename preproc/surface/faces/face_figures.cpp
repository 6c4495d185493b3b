#include "preproc/surface/faces/face_figures.hpp"

#include "preproc/mesh/named_sets.hpp"
#include "preproc/mesh/six_node_triangle.hpp"
#include "preproc/surface/primitives/fit_shape.hpp"
#include "preproc/surface/primitives/shape_set.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <numeric>
#include <span>

namespace scan2fea {
namespace {

using Index = std::uint32_t;

// By how much noise of the diagonal's size would change the areas of faces with tangent neighbours, about.
constexpr double area_noise = 40;

// In the widest gap, as a ratio, between those of the differences that are in [low, high]; all are above 0.
double tolerance_between(std::vector<double> differences, double low, double high) {
  std::erase_if(differences, [&](double d) { return !(d > low && d < high); });
  differences.push_back(low);
  differences.push_back(high);
  std::sort(differences.begin(), differences.end());
  std::size_t widest = 0;
  for (std::size_t i = 0; i + 1 < differences.size(); ++i)
    if (differences[i + 1] * differences[widest] > differences[widest + 1] * differences[i]) widest = i;
  return std::sqrt(differences[widest] * differences[widest + 1]);
}

// By what a drawing tells: radii are round numbers, and the same or well apart, where areas of fillets go with the
// noise.
double size_of(const SurfaceFace& face) {
  if (!face.shape || face.shape->kind == ShapeKind::plane || face.shape->kind == ShapeKind::cone) return face.area;
  return face.shape->radius;
}

// Sorts by the first of the keys, where those are equal by the next.
class NameOrder {
 public:
  struct Key {
    std::function<double(const SurfaceFace&)> value;
    double low, high;  // of the tolerance
  };

  explicit NameOrder(std::vector<Key> keys) : keys_(std::move(keys)) {}

  void sort(std::span<SurfaceFace> faces, std::size_t key = 0) const {
    if (key == keys_.size() || faces.size() < 2) return;
    const auto& value = keys_[key].value;
    std::stable_sort(faces.begin(), faces.end(),
                     [&](const SurfaceFace& a, const SurfaceFace& b) { return value(a) < value(b); });
    std::vector<double> steps;
    for (std::size_t i = 0; i + 1 < faces.size(); ++i) steps.push_back(value(faces[i + 1]) - value(faces[i]));
    const double tolerance = tolerance_between(steps, keys_[key].low, keys_[key].high);
    for (std::size_t begin = 0; begin < faces.size();) {
      std::size_t end = begin + 1;
      while (end < faces.size() && steps[end - 1] < tolerance) ++end;
      sort(faces.subspan(begin, end - begin), key + 1);
      begin = end;
    }
  }

 private:
  std::vector<Key> keys_;
};

}  // namespace

std::optional<Shape> fit_face(const SurfaceMesh& mesh, const std::vector<Index>& triangles, double sigma) {
  SurfaceMesh part{.vertices = {}, .triangles = {}};
  const std::vector<Index> used = vertices_of_faces(mesh, triangles);
  for (const Index v : used) part.vertices.push_back(mesh.vertices[v]);
  for (const Index f : triangles) {
    Triangle t = mesh.triangles[f];
    for (Index& v : t) v = static_cast<Index>(std::lower_bound(used.begin(), used.end(), v) - used.begin());
    part.triangles.push_back(t);
  }
  const std::vector<Vec3> normals = vertex_normals(part);
  const OrientedPoints cloud{part.vertices, normals};
  std::vector<Index> all(used.size());
  std::iota(all.begin(), all.end(), 0U);
  // Facets turn the normals of vertices at a border by half of their angle.
  const ShapeNoise noise{sigma, 0.3};
  std::optional<Shape> best;
  double least = HUGE_VAL;
  for (ShapeGuess guess : guess_shapes(cloud, all, {})) {
    const ShapeFreedom freedom = full_freedom(guess.shape);
    // A shape says something of a face only where it has fewer numbers than the face has points.
    if (part.vertices.size() < freedom.size() || (freedom.size() > 3 && part.vertices.size() < 2 * freedom.size()))
      continue;
    if (!fit_shape(guess.shape, freedom, part.vertices, all, sigma).found) continue;
    if (rms_distance(cloud, guess.shape, all) > 1.2 * sigma) continue;
    const double cost = total_cost(cloud, noise, guess.shape, freedom, all);
    if (cost >= least) continue;
    least = cost;
    best = guess.shape;
  }
  return best;
}

double area_on_shape(const SurfaceMesh& mesh, Index triangle, const SurfaceFace& face) {
  SixNodeTriangle p;
  for (std::size_t k = 0; k < 3; ++k) p[k] = mesh.vertices[mesh.triangles[triangle][k]];
  if (!face.shape) return area_vector(mesh, mesh.triangles[triangle]).norm() / 2;
  for (std::size_t k = 0; k < 3; ++k) p[k] = face.shape->foot(p[k]);
  if (face.shape->kind == ShapeKind::plane) return (p[1] - p[0]).cross(p[2] - p[0]).norm() / 2;
  for (std::size_t k = 0; k < 3; ++k) p[3 + k] = face.shape->foot((p[k] + p[(k + 1) % 3]) / 2);
  return curved_area(p);
}

void measure_face(const SurfaceMesh& mesh, const std::vector<bool>& is_border_vertex, SurfaceFace& face) {
  face.area = 0;
  face.place = Vec3::Zero();
  for (const Index f : face.triangles) {
    const auto& [a, b, c] = mesh.triangles[f];
    const double area = area_on_shape(mesh, f, face);
    face.area += area;
    face.place += area / 3 * (mesh.vertices[a] + mesh.vertices[b] + mesh.vertices[c]);
  }
  if (face.area > 0) face.place /= face.area;
  if (!face.shape) return;
  std::vector<Index> vertices = vertices_of_faces(mesh, face.triangles);
  std::vector<Index> inside = vertices;
  std::erase_if(inside, [&](Index v) { return is_border_vertex[v]; });
  if (!inside.empty()) vertices = std::move(inside);
  face.mean_misfit = face.largest_misfit = 0;
  for (const Index v : vertices) {
    const double distance = std::abs(face.shape->signed_distance(mesh.vertices[v]));
    face.mean_misfit += distance / static_cast<double>(vertices.size());
    face.largest_misfit = std::max(face.largest_misfit, distance);
  }
}

void name_faces(const SurfaceMesh& mesh, double noise, std::vector<SurfaceFace>& faces) {
  const double diagonal = bounding_box(mesh.vertices).diagonal();
  const auto kind = [](const SurfaceFace& f) { return f.shape ? static_cast<double>(f.shape->kind) : HUGE_VAL; };
  std::vector<NameOrder::Key> keys{
      {[](const SurfaceFace& f) { return -std::log(size_of(f)); }, 0.005 + area_noise * noise / diagonal, 0.08}};
  for (const int axis : {0, 1, 2})
    keys.push_back({[axis](const SurfaceFace& f) { return f.place[axis]; }, 0.0005 * diagonal, 0.01 * diagonal});
  const NameOrder order(std::move(keys));
  std::stable_sort(faces.begin(), faces.end(),
                   [&](const SurfaceFace& a, const SurfaceFace& b) { return kind(a) < kind(b); });
  for (std::size_t begin = 0; begin < faces.size();) {
    std::size_t end = begin + 1;
    while (end < faces.size() && kind(faces[end]) == kind(faces[begin])) ++end;
    order.sort(std::span(faces).subspan(begin, end - begin));
    begin = end;
  }
  for (std::size_t i = 0; i < faces.size(); ++i) faces[i].name = "FACE_" + std::to_string(i + 1);
}

}  // namespace scan2fea
