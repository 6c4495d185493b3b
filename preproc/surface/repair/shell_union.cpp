#include "preproc/surface/repair/shell_union.hpp"

#include "preproc/surface/repair/face_marks.hpp"
#include "preproc/surface/repair/shells.hpp"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polygon_mesh_processing/corefinement.h>
#include <CGAL/Surface_mesh.h>

#include <algorithm>
#include <numeric>

namespace scan2fea {
namespace {

namespace PMP = CGAL::Polygon_mesh_processing;
using Surface = CGAL::Surface_mesh<CGAL::Exact_predicates_inexact_constructions_kernel::Point_3>;
using Vertex = Surface::Vertex_index;

Surface to_cgal(const SurfaceMesh& mesh, const Shell& shell) {
  const Vertex none;
  Surface surface;
  std::vector<Vertex> vertex(mesh.vertices.size(), none);
  for (const std::uint32_t f : shell.faces)
    for (const std::uint32_t v : mesh.triangles[f])
      if (vertex[v] == none) {
        const Vec3& p = mesh.vertices[v];
        vertex[v] = surface.add_vertex({p.x(), p.y(), p.z()});
      }
  for (const std::uint32_t f : shell.faces) {
    const Triangle& t = mesh.triangles[f];
    surface.add_face(vertex[t[0]], vertex[t[1]], vertex[t[2]]);
  }
  return surface;
}

void append(Surface& surface, SurfaceMesh& mesh) {
  surface.collect_garbage();
  const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
  for (const Vertex v : surface.vertices()) {
    const auto& p = surface.point(v);
    mesh.vertices.push_back({p.x(), p.y(), p.z()});
  }
  for (const auto f : surface.faces()) {
    Triangle& t = mesh.triangles.emplace_back();
    std::size_t i = 0;
    for (const Vertex v : surface.vertices_around_face(surface.halfedge(f))) t[i++] = first + v.idx();
  }
}

// Sets of solids that intersect one another and not themselves, each by ascending index.
std::vector<std::vector<std::size_t>> crossing_solids(const SurfaceMesh& mesh, const std::vector<Shell>& shells,
                                                      std::span<const FacePair> pairs) {
  std::vector<std::size_t> shell_of_face(mesh.triangles.size());
  for (std::size_t s = 0; s < shells.size(); ++s)
    for (const std::uint32_t f : shells[s].faces) shell_of_face[f] = s;
  std::vector<std::size_t> set(shells.size());  // the lowest shell of each one's set
  std::iota(set.begin(), set.end(), std::size_t{0});
  std::vector<char> usable(shells.size(), 1);
  for (const FacePair& pair : pairs) {
    const std::size_t a = set[shell_of_face[pair.face]], b = set[shell_of_face[pair.other]];
    if (shell_of_face[pair.face] == shell_of_face[pair.other])
      usable[a] = 0;
    else if (a != b)
      std::replace(set.begin(), set.end(), std::max(a, b), std::min(a, b));
  }
  std::vector<std::vector<std::size_t>> sets(shells.size());
  for (std::size_t s = 0; s < shells.size(); ++s) {
    sets[set[s]].push_back(s);
    if (!usable[s] || shells[s].volume <= 0) usable[set[s]] = 0;
  }
  for (std::size_t s = 0; s < sets.size(); ++s)
    if (!usable[s]) sets[s].clear();
  std::erase_if(sets, [](const auto& members) { return members.size() < 2; });
  return sets;
}

std::optional<Surface> unite(const SurfaceMesh& mesh, const std::vector<Shell>& shells,
                             const std::vector<std::size_t>& members) {
  Surface sum = to_cgal(mesh, shells[members[0]]);
  try {
    for (std::size_t i = 1; i < members.size(); ++i) {
      Surface next = to_cgal(mesh, shells[members[i]]);
      if (!PMP::corefine_and_compute_union(sum, next, sum, CGAL::parameters::throw_on_self_intersection(true)))
        return {};
    }
  } catch (const PMP::Corefinement::Self_intersection_exception&) {
    return {};
  }
  return sum;
}

}  // namespace

bool unite_shells(SurfaceMesh& mesh, std::span<const FacePair> pairs, RepairResult& result) {
  const std::vector<Shell> shells = find_shells(mesh);
  if (shells.size() < 2) return false;
  std::vector<char> replaced(mesh.triangles.size(), 0);
  std::vector<Surface> unions;
  for (const auto& members : crossing_solids(mesh, shells, pairs)) {
    std::optional<Surface> sum = unite(mesh, shells, members);
    if (!sum) continue;
    unions.push_back(std::move(*sum));
    for (const std::size_t s : members) {
      for (const std::uint32_t f : shells[s].faces) replaced[f] = 1;
      result.changes.push_back({RepairKind::UnitedShell, (shells[s].box.low + shells[s].box.high) / 2, shells[s].area});
    }
  }
  if (unions.empty()) return false;
  remove_faces(mesh, replaced, result);
  const std::size_t kept = mesh.triangles.size();
  for (Surface& sum : unions) append(sum, mesh);
  result.faces_added += mesh.triangles.size() - kept;
  return true;
}

}  // namespace scan2fea
