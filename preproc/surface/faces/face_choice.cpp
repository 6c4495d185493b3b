#include "preproc/surface/faces/face_choice.hpp"

#include "preproc/mesh/error.hpp"
#include "preproc/mesh/error_text.hpp"
#include "quality/triangle_tree.hpp"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <numbers>

namespace scan2fea {
namespace {

using Chosen = std::vector<bool>;

// Of a face's area, what may lie beyond a limit of its coordinates: noise, and a rounded rim.
constexpr double share_beyond = 0.05;
constexpr std::size_t most_told = 5;

std::string kind_word(const SurfaceFace& face) {
  return face.shape ? std::string(name_of(face.shape->kind)) : "free";
}

double angle_deg(double cosine) {
  return std::acos(std::clamp(cosine, -1.0, 1.0)) * 180 / std::numbers::pi;
}

double off_direction_deg(const SurfaceFace& face, const Direction& direction) {
  if (!face.shape || face.shape->kind == ShapeKind::sphere) return 180;
  const double cosine = face.shape->axis.dot(direction.vector);
  return angle_deg(face.shape->kind == ShapeKind::plane ? cosine : std::abs(cosine));
}

// How far the face is from meeting the condition: 0 where it does; in parts of the limit or of the diagonal else.
double excess(const SurfaceMesh& mesh, const SurfaceFace& face, const Limit& limit, double diagonal) {
  const auto beyond = [&](double value) { return limit.above ? limit.value - value : value - limit.value; };
  if (limit.of == Limit::Of::area) return std::max(0.0, beyond(face.area) / face.area);
  if (limit.of == Limit::Of::radius || limit.of == Limit::Of::tube) {
    if (!face.shape || face.shape->kind == ShapeKind::plane) return 1e9;
    const double value = limit.of == Limit::Of::tube ? face.shape->tube_radius : face.shape->radius;
    return std::max(0.0, beyond(value) / std::max(std::abs(limit.value), 1e-300));
  }
  const int axis = limit.of == Limit::Of::x ? 0 : limit.of == Limit::Of::y ? 1 : 2;
  double area = 0, area_beyond = 0, farthest = 0;
  for (const std::uint32_t f : face.triangles) {
    const Triangle& t = mesh.triangles[f];
    const double own = area_vector(mesh, t).norm() / 2;
    const double out = beyond((mesh.vertices[t[0]] + mesh.vertices[t[1]] + mesh.vertices[t[2]])[axis] / 3);
    area += own;
    if (out > 0) area_beyond += own;
    farthest = std::max(farthest, out);
  }
  return area_beyond <= share_beyond * area ? 0 : farthest / diagonal;
}

double misfit(const SurfaceMesh& mesh, const SurfaceFace& face, const Selection& selection, double diagonal) {
  double sum = 0;
  if (selection.facing)
    sum += std::max(0.0, off_direction_deg(face, *selection.facing) - selection.facing->within_deg) / 90;
  if (selection.hollow && (!face.shape || face.shape->hollow != *selection.hollow)) sum += 1;
  for (const Limit& limit : selection.limits) sum += excess(mesh, face, limit, diagonal);
  return sum;
}

[[noreturn]] void fail(const Selection& selection, const std::string& near) {
  throw WrongUsage({.what = "the selection is of nothing",
                    .where = selection.text,
                    .value = {},
                    .limit = {},
                    .advice = near + ", or scan2fea faces for a list"});
}

std::string listed(const SurfaceFaces& faces, const std::vector<std::size_t>& which) {
  std::string text;
  for (std::size_t i = 0; i < std::min(which.size(), most_told); ++i)
    text += (i > 0 ? ", " : "") + describe(faces.list[which[i]]);
  return text;
}

Chosen by_shape(const SurfaceMesh& mesh, const SurfaceFaces& faces, const Selection& selection) {
  const double diagonal = bounding_box(mesh.vertices).diagonal();
  Chosen chosen(faces.list.size(), false);
  std::vector<std::pair<double, std::size_t>> near;
  for (std::size_t i = 0; i < chosen.size(); ++i) {
    const double off = misfit(mesh, faces.list[i], selection, diagonal);
    const bool is_kind = kind_word(faces.list[i]) == selection.text;
    chosen[i] = is_kind && off == 0;
    near.emplace_back(off + (is_kind ? 0 : 10), i);
  }
  if (std::find(chosen.begin(), chosen.end(), true) != chosen.end()) return chosen;
  std::stable_sort(near.begin(), near.end());
  std::vector<std::size_t> first;
  for (std::size_t i = 0; i < std::min<std::size_t>(near.size(), 3); ++i) first.push_back(near[i].second);
  fail(selection, "near it are " + listed(faces, first));
}

bool same_word(std::string_view a, std::string_view b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                    [](unsigned char x, unsigned char y) { return std::tolower(x) == std::tolower(y); });
}

Chosen by_name(const SurfaceFaces& faces, const Selection& selection) {
  Chosen chosen(faces.list.size(), false);
  for (std::size_t i = 0; i < chosen.size(); ++i) chosen[i] = same_word(faces.list[i].name, selection.text);
  if (std::find(chosen.begin(), chosen.end(), true) == chosen.end())
    fail(selection, chosen.size() == 1 ? "FACE_1, the only face" : "FACE_1 to FACE_" + std::to_string(chosen.size()));
  return chosen;
}

Chosen nearest(const SurfaceMesh& mesh, const SurfaceFaces& faces, const Selection& selection) {
  Chosen chosen(faces.list.size(), false);
  chosen[faces.of_triangle[TriangleTree(mesh).closest(selection.low).triangle]] = true;
  return chosen;
}

Chosen of_whole_faces(const SurfaceMesh& mesh, const SurfaceFaces& faces, const Selection& selection) {
  using Kind = Selection::Kind;
  const auto& operands = selection.operands;
  if (selection.kind != Kind::both && selection.kind != Kind::either && selection.kind != Kind::inverse)
    return chosen_faces(mesh, faces, selection);
  Chosen chosen = of_whole_faces(mesh, faces, operands[0]);
  if (selection.kind == Kind::inverse) chosen.flip();
  for (std::size_t k = 1; k < operands.size(); ++k) {
    const Chosen other = of_whole_faces(mesh, faces, operands[k]);
    for (std::size_t i = 0; i < chosen.size(); ++i)
      chosen[i] = selection.kind == Kind::both ? chosen[i] && other[i] : chosen[i] || other[i];
  }
  return chosen;
}

Chosen largest(const SurfaceMesh& mesh, const SurfaceFaces& faces, const Selection& selection) {
  Chosen chosen = of_whole_faces(mesh, faces, selection.operands[0]);
  std::size_t best = chosen.size();
  for (std::size_t i = 0; i < chosen.size(); ++i)
    if (chosen[i] && (best == chosen.size() || faces.list[i].area > faces.list[best].area)) best = i;
  if (best == chosen.size()) fail(selection, "no face is all of that");
  chosen.assign(chosen.size(), false);
  chosen[best] = true;
  return chosen;
}

}  // namespace

std::string describe(const SurfaceFace& face) {
  // Without what rounding leaves of zeros.
  const auto direction = [](const Vec3& d) { return error_text(Vec3((1e4 * d).array().round() / 1e4 + 0.0)); };
  std::string text = face.name + " (" + std::string(kind_of(face));
  if (face.shape) {
    const Shape& shape = *face.shape;
    if (shape.kind == ShapeKind::plane) text += ", normal " + direction(shape.axis);
    if (shape.kind != ShapeKind::plane) text += ", radius " + error_text(shape.radius, 4);
    if (shape.kind == ShapeKind::torus) text += ", tube " + error_text(shape.tube_radius, 4);
    if (shape.kind != ShapeKind::plane && shape.kind != ShapeKind::sphere) text += ", axis " + direction(shape.axis);
  }
  return text + ", area " + error_text(face.area, 4) + ")";
}

Chosen chosen_faces(const SurfaceMesh& mesh, const SurfaceFaces& faces, const Selection& selection) {
  switch (selection.kind) {
    case Selection::Kind::shape:
      return by_shape(mesh, faces, selection);
    case Selection::Kind::largest:
      return largest(mesh, faces, selection);
    case Selection::Kind::nearest:
      return nearest(mesh, faces, selection);
    default:
      return by_name(faces, selection);
  }
}

}  // namespace scan2fea
