#include "preproc/surface/faces/idealise.hpp"

#include "preproc/surface/kernel/clear_moves.hpp"
#include "preproc/surface/primitives/meeting_point.hpp"

#include <algorithm>
#include <cmath>

namespace scan2fea {
namespace {

using Index = std::uint32_t;

// Of the noise: of a million vertices one is farther from its shape.
constexpr double farthest_of_noise = 5;
// Where shapes meet at an angle, a vertex at their edge is as far from the meeting as noise along both makes it.
constexpr double farthest_at_edges = 2 * farthest_of_noise;

// Onto the shapes in turn: where they are tangent, a few rounds end on both.
Vec3 onto_all(std::span<const Shape* const> shapes, Vec3 p) {
  constexpr int rounds = 8;
  for (int round = 0; round < rounds; ++round)
    for (const Shape* shape : shapes) p = shape->foot(p);
  return p;
}

Vec3 place_on(std::span<const Shape* const> shapes, const Vec3& p) {
  if (shapes.size() == 1) return shapes[0]->foot(p);
  if (shapes.size() <= 3)
    if (const auto met = meeting_point(shapes, p)) return *met;
  return onto_all(shapes, p);
}

}  // namespace

IdealiseResult idealise(SurfaceMesh& mesh, const SurfaceFaces& faces, Idealise what) {
  std::vector<std::vector<Index>> around(mesh.vertices.size());
  for (Index f = 0; f < mesh.triangles.size(); ++f)
    for (const Index v : mesh.triangles[f])
      if (std::ranges::find(around[v], faces.of_triangle[f]) == around[v].end())
        around[v].push_back(faces.of_triangle[f]);
  IdealiseResult result;
  std::vector<Vec3> places = mesh.vertices;
  for (std::size_t v = 0; v < places.size(); ++v) {
    std::ranges::sort(around[v]);
    std::vector<const Shape*> shapes;
    for (const Index face : around[v]) {
      const auto& shape = faces.list[face].shape;
      if (shape && (what == Idealise::all || shape->kind == ShapeKind::plane)) shapes.push_back(&*shape);
    }
    if (shapes.empty()) continue;
    const Vec3 place = place_on(shapes, places[v]);
    const double farthest = (shapes.size() == 1 ? farthest_of_noise : farthest_at_edges) * faces.noise;
    if ((place - places[v]).norm() <= farthest)
      places[v] = place;
    else
      ++result.left;
  }
  const std::vector<Vec3> before = mesh.vertices;
  move_clear(mesh, places);
  for (std::size_t v = 0; v < before.size(); ++v) {
    const double move = (mesh.vertices[v] - before[v]).norm();
    result.moved += move > 0;
    result.largest_move = std::max(result.largest_move, move);
    result.rms_move += move * move;
  }
  if (result.moved > 0) result.rms_move = std::sqrt(result.rms_move / static_cast<double>(result.moved));
  return result;
}

}  // namespace scan2fea
