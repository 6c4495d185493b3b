#include "preproc/surface/repair/shells.hpp"

#include "preproc/surface/kernel/components.hpp"
#include "preproc/surface/kernel/solid_angle.hpp"
#include "preproc/surface/repair/face_marks.hpp"
#include "preproc/surface/repair/soup_adjacency.hpp"

#include <algorithm>
#include <cmath>

namespace scan2fea {
namespace {

// How often the shell winds about the point: 1 inside and 0 outside of one that faces outwards.
double winding_number(const SurfaceMesh& mesh, const Shell& shell, const Vec3& p) {
  double sum = 0;
  for (const std::uint32_t f : shell.faces) sum += winding_of_triangle(mesh, mesh.triangles[f], p);
  return sum;
}

// Whether all of the shell's sampled vertices, and whether most of them, lie inside the other.
struct Enclosure {
  bool all = false;
  bool most = false;
};

Enclosure enclosure(const SurfaceMesh& mesh, const Shell& inner, const Shell& outer) {
  constexpr std::size_t samples = 16;
  const std::size_t step = std::max<std::size_t>(1, inner.faces.size() / samples);
  std::size_t inside = 0, count = 0;
  for (std::size_t i = 0; i < inner.faces.size(); i += step, ++count)
    inside += std::abs(winding_number(mesh, outer, mesh.vertices[mesh.triangles[inner.faces[i]][0]])) > 0.5;
  return {inside == count, 2 * inside > count};
}

void turn(SurfaceMesh& mesh, const Shell& shell, RepairResult& result) {
  for (const std::uint32_t f : shell.faces) std::swap(mesh.triangles[f][1], mesh.triangles[f][2]);
  result.changes.push_back({RepairKind::TurnedFaces, centre_of(mesh, shell.faces[0]), shell.area});
}

}  // namespace

bool contains(const BoundingBox& outer, const BoundingBox& inner) {
  return (outer.low.array() <= inner.low.array()).all() && (outer.high.array() >= inner.high.array()).all();
}

bool nearly_encloses(const SurfaceMesh& mesh, const Shell& shell) {
  constexpr double most_open_area = 0.25, least_volume_of_area = 1e-3;
  if (!shell.open) return true;
  Vec3 sum = Vec3::Zero();
  for (const std::uint32_t f : shell.faces) sum += area_vector(mesh, mesh.triangles[f]) / 2;
  return sum.norm() < most_open_area * shell.area &&
         std::abs(shell.volume) > least_volume_of_area * std::pow(shell.area, 1.5);
}

std::vector<Shell> find_shells(const SurfaceMesh& mesh, bool tell_open) {
  const Components components = find_components(mesh);
  const Twins twins = tell_open ? find_twins(mesh) : Twins();
  std::vector<Shell> shells;
  std::vector<std::uint32_t> shell_of(components.count, components.count);
  for (std::uint32_t f = 0; f < mesh.triangles.size(); ++f) {
    const Triangle& t = mesh.triangles[f];
    std::uint32_t& s = shell_of[components.of_vertex[t[0]]];
    if (s == components.count) {
      s = static_cast<std::uint32_t>(shells.size());
      shells.push_back({.faces = {}, .box = {mesh.vertices[t[0]], mesh.vertices[t[0]]}});
    }
    Shell& shell = shells[s];
    shell.faces.push_back(f);
    if (tell_open)
      for (std::uint32_t h = 3 * f; h < 3 * f + 3; ++h) shell.open |= twins[h] == no_twin;
    for (const std::uint32_t v : t) {
      shell.box.low = shell.box.low.cwiseMin(mesh.vertices[v]);
      shell.box.high = shell.box.high.cwiseMax(mesh.vertices[v]);
    }
  }
  for (Shell& shell : shells) {
    const Vec3 centre = (shell.box.low + shell.box.high) / 2;
    for (const std::uint32_t f : shell.faces) {
      const Vec3 normal = area_vector(mesh, mesh.triangles[f]);
      shell.area += normal.norm() / 2;
      shell.volume += normal.dot(mesh.vertices[mesh.triangles[f][0]] - centre) / 6;
    }
  }
  return shells;
}

std::vector<std::uint32_t> shell_of_faces(const std::vector<Shell>& shells, std::size_t face_count) {
  std::vector<std::uint32_t> shell_of_face(face_count);
  for (std::uint32_t s = 0; s < shells.size(); ++s)
    for (const std::uint32_t f : shells[s].faces) shell_of_face[f] = s;
  return shell_of_face;
}

void drop_shells(SurfaceMesh& mesh, const std::vector<Shell>& shells,
                 const std::vector<std::optional<RepairKind>>& reasons, RepairResult& result) {
  std::vector<char> of_face(mesh.triangles.size(), 0);
  for (std::size_t s = 0; s < shells.size(); ++s) {
    if (!reasons[s]) continue;
    for (const std::uint32_t f : shells[s].faces) of_face[f] = 1;
    const Shell& shell = shells[s];
    result.changes.push_back({*reasons[s], (shell.box.low + shell.box.high) / 2, shell.area, shell.area,
                              shell.open ? 0 : std::abs(shell.volume)});
  }
  remove_faces(mesh, of_face, result);
}

double winding_of_others(const SurfaceMesh& mesh, const std::vector<Shell>& shells, std::size_t shell) {
  const auto& faces = shells[shell].faces;
  const auto at = std::find_if(faces.begin(), faces.end(), [&](std::uint32_t f) { return area_of(mesh, f) > 0; });
  const Vec3 p = centre_of(mesh, at == faces.end() ? faces[0] : *at);
  double winding = 0;
  for (std::size_t s = 0; s < shells.size(); ++s)
    if (s != shell && !shells[s].open && contains(shells[s].box, shells[shell].box))
      winding += winding_number(mesh, shells[s], p);
  return winding;
}

void orient_shells(SurfaceMesh& mesh, bool may_be_open, RepairResult& result) {
  const std::vector<Shell> shells = find_shells(mesh, may_be_open);
  for (const Shell& shell : shells) {
    if (!nearly_encloses(mesh, shell)) continue;
    std::size_t depth = 0;
    for (const Shell& other : shells) {
      if (&other == &shell || other.open || !contains(other.box, shell.box)) continue;
      if (std::abs(other.volume) <= std::abs(shell.volume)) continue;
      const Enclosure enclosed = enclosure(mesh, shell, other);
      depth += enclosed.all || (enclosed.most && shell.volume < 0);
    }
    const bool outwards = depth % 2 == 0;
    if ((shell.volume > 0) != outwards) turn(mesh, shell, result);
  }
}

void drop_shells_inside(SurfaceMesh& mesh, bool may_be_open, RepairResult& result) {
  const std::vector<Shell> shells = find_shells(mesh, may_be_open);
  std::vector<std::optional<RepairKind>> reasons(shells.size());
  for (std::size_t s = 0; s < shells.size(); ++s) {
    if (shells[s].open) continue;
    const bool in_solid = winding_of_others(mesh, shells, s) > 0.5;
    if (in_solid == (shells[s].volume > 0)) reasons[s] = RepairKind::DroppedInside;
  }
  drop_shells(mesh, shells, reasons, result);
}

}  // namespace scan2fea
