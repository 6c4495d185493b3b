#include "preproc/surface/lattice/thin_scan.hpp"

#include "preproc/surface/kernel/delaunay_flips.hpp"
#include "preproc/surface/kernel/halfedge_mesh.hpp"

#include <limits>
#include <numeric>

namespace scan2fea {
namespace {

using Index = HalfedgeMesh::Index;

// The shortest edge from the vertex to one that was not part of a contraction yet.
Index shortest_free(const HalfedgeMesh& mesh, const std::vector<bool>& done, Index vertex) {
  Index shortest = HalfedgeMesh::none;
  double least = std::numeric_limits<double>::infinity();
  mesh.for_each_outgoing(vertex, [&](Index h) {
    const Index other = mesh.target(h);
    if (done[other]) return;
    const double squared = (mesh.points[other] - mesh.points[vertex]).squaredNorm();
    if (squared >= least) return;
    least = squared;
    shortest = h;
  });
  return shortest;
}

// Contracts at most `most` edges; how many it did.
std::size_t contract_once(HalfedgeMesh& mesh, std::size_t most, std::vector<std::uint32_t>& into) {
  std::vector<bool> done(mesh.vertex_slots(), false);
  std::size_t contracted = 0;
  for (Index v = 0; v < mesh.vertex_slots() && contracted < most; ++v) {
    if (done[v] || !mesh.is_alive(v)) continue;
    const Index h = shortest_free(mesh, done, v);
    if (h == HalfedgeMesh::none || !mesh.can_collapse(h)) continue;
    const Index removed = mesh.target(h);
    mesh.points[v] = (mesh.points[v] + mesh.points[removed]) / 2;
    mesh.collapse(h);
    restore_delaunay(mesh, v);
    into[removed] = v;
    done[v] = done[removed] = true;
    ++contracted;
  }
  return contracted;
}

}  // namespace

std::vector<std::uint32_t> thin_scan(SurfaceMesh& scan, std::size_t vertices) {
  std::vector<std::uint32_t> into(scan.vertices.size());
  std::iota(into.begin(), into.end(), 0U);
  if (into.size() <= vertices) return into;
  HalfedgeMesh mesh(scan);
  scan = {};
  for (std::size_t left = into.size(); left > vertices;) {
    const std::size_t contracted = contract_once(mesh, left - vertices, into);
    if (contracted == 0) break;
    left -= contracted;
  }
  scan = mesh.to_surface();
  std::vector<std::uint32_t> number(into.size(), 0);
  for (std::uint32_t v = 0, alive = 0; v < number.size(); ++v)
    if (mesh.is_alive(v)) number[v] = alive++;
  for (std::uint32_t v = 0; v < into.size(); ++v) {
    std::uint32_t end = v;
    while (into[end] != end) end = into[end];
    into[v] = end;
  }
  for (std::uint32_t& v : into) v = number[v];
  return into;
}

}  // namespace scan2fea
