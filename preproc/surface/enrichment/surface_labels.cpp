#include "preproc/surface/enrichment/surface_labels.hpp"

#include "preproc/surface/primitives/meeting_point.hpp"

namespace scan2fea {

SurfaceLabels::SurfaceLabels(const HalfedgeMesh& mesh, const Primitives& found) : mesh_(mesh), found_(found) {
  sets_.reserve(mesh.vertex_slots());
  for (Index v = 0; v < mesh.vertex_slots(); ++v) sets_.emplace_back(found.labels[v]);
}

std::uint32_t SurfaceLabels::rounding_between(std::uint32_t one, std::uint32_t other) const {
  for (std::uint32_t i = 0; i < found_.list.size(); ++i)
    if (const auto& sides = found_.list[i].relations.tangent_to)
      if ((*sides)[0] + (*sides)[1] == one + other && ((*sides)[0] == one || (*sides)[1] == one)) return i;
  return no_primitive;
}

std::uint32_t SurfaceLabels::of_face(Index f) const {
  const Triangle t = mesh_.triangle(f);
  std::uint32_t best = no_primitive;
  double most = -2;
  for (const std::uint32_t label : sets_[t[0]]) {
    if (!sets_[t[1]].holds(label) || !sets_[t[2]].holds(label)) continue;
    const Vec3 middle = (mesh_.points[t[0]] + mesh_.points[t[1]] + mesh_.points[t[2]]) / 3;
    const double agreement = shape(label).normal(middle).dot(mesh_.area_vector(f).normalized());
    if (!(agreement > most) && best != no_primitive) continue;
    most = agreement;
    best = label;
  }
  return best;
}

bool SurfaceLabels::is_crease(Index h) const {
  constexpr double least_bend = 0.8660254;  // cosine of 30 degrees
  if (mesh_.is_border(h)) return false;
  const Index f = HalfedgeMesh::face(h), g = HalfedgeMesh::face(mesh_.opposite(h));
  const std::uint32_t one = of_face(f), other = of_face(g);
  if (one != no_primitive && other != no_primitive) return one != other;
  if (one == other) return false;
  for (const Index v : {mesh_.origin(h), mesh_.target(h)})
    if (sets_[v].size() < 2) return false;
  return mesh_.area_vector(f).normalized().dot(mesh_.area_vector(g).normalized()) < least_bend;
}

bool SurfaceLabels::may_flip(Index h) const {
  if (mesh_.is_border(h)) return false;
  return of_face(HalfedgeMesh::face(h)) == of_face(HalfedgeMesh::face(mesh_.opposite(h)));
}

std::optional<Vec3> SurfaceLabels::meeting(const LabelSet& labels, const Vec3& start) const {
  if (labels.size() == 0) return std::nullopt;
  std::array<const Shape*, 3> shapes{};
  std::size_t count = 0;
  for (const std::uint32_t label : labels) shapes[count++] = &shape(label);
  return meeting_point(std::span(shapes).first(count), start);
}

Vec3 SurfaceLabels::normal(Index v, const Vec3& direction, const Vec3& otherwise) const {
  Vec3 best = otherwise;
  double most = -2;
  for (const std::uint32_t label : sets_[v]) {
    const Vec3 own = shape(label).normal(mesh_.points[v]);
    if (!(own.dot(direction) > most)) continue;
    most = own.dot(direction);
    best = own;
  }
  return best;
}

}  // namespace scan2fea
