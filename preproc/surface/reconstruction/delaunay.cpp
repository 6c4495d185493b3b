#include "preproc/surface/reconstruction/delaunay.hpp"

#include "preproc/mesh/sorted_corners.hpp"

#include <CGAL/Advancing_front_surface_reconstruction.h>
#include <CGAL/Delaunay_triangulation_3.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Triangulation_vertex_base_with_info_3.h>

#include <algorithm>
#include <limits>
#include <unordered_map>

namespace scan2fea {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;

// Compared by when it was made; without, CGAL compares cells and vertices by where they lie in memory, another order in
// every run.
template <class Base>
class Stamped : public Base {
 public:
  template <class Structure>
  struct Rebind_TDS {
    using Other = Stamped<typename Base::template Rebind_TDS<Structure>::Other>;
  };
  using Base::Base;
  using Has_timestamp = CGAL::Tag_true;

  std::size_t time_stamp() const { return time_stamp_; }
  void set_time_stamp(std::size_t stamp) { time_stamp_ = stamp; }

 private:
  std::size_t time_stamp_ = std::numeric_limits<std::size_t>::max();  // none yet
};

// CGAL's own vertices are numbered, too, but forget their numbers when they are copied.
using VertexBase = Stamped<CGAL::Triangulation_vertex_base_with_info_3<
    std::uint32_t, Kernel, CGAL::Advancing_front_surface_reconstruction_vertex_base_3<Kernel>>>;
using CellBase = Stamped<CGAL::Advancing_front_surface_reconstruction_cell_base_3<Kernel>>;
using Triangulation =
    CGAL::Delaunay_triangulation_3<Kernel, CGAL::Triangulation_data_structure_3<VertexBase, CellBase>>;

// An edge of the front with how well its best triangle continues it.
using RatedEdge = Triangulation::Vertex::Radius_ptr_type;

// Best first. One triangle may be the best at two edges: those are told apart by their ends.
auto order_of(const RatedEdge& rated) {
  const auto& edge = rated.second->first.first;
  return std::pair(rated.first,
                   std::minmax({edge.first->vertex(edge.second)->info(), edge.first->vertex(edge.third)->info()}));
}

}  // namespace
}  // namespace scan2fea

// The order of the set in which CGAL keeps the edges of a front; its own is that of the pointers.
template <>
struct std::less<scan2fea::RatedEdge> {
  bool operator()(const scan2fea::RatedEdge& a, const scan2fea::RatedEdge& b) const {
    return scan2fea::order_of(a) < scan2fea::order_of(b);
  }
};

namespace scan2fea {

Triangle DelaunayCells::facet(std::uint32_t cell, std::size_t opposite) const {
  const auto& c = corners[cell];
  Triangle t{c[(opposite + 1) & 3], c[(opposite + 2) & 3], c[(opposite + 3) & 3]};
  if (opposite % 2 == 1) std::swap(t[0], t[1]);
  return t;
}

bool DelaunayCells::is_infinite(std::uint32_t cell) const {
  return std::ranges::find(corners[cell], infinite) != corners[cell].end();
}

std::vector<std::uint32_t> DelaunayCells::around(std::uint32_t cell, std::uint32_t a, std::uint32_t b) const {
  const auto others = [&](std::uint32_t c) {
    std::vector<std::size_t> found;
    for (std::size_t k = 0; k < 4; ++k)
      if (corners[c][k] != a && corners[c][k] != b) found.push_back(k);
    return found;
  };
  std::vector<std::uint32_t> ring;
  std::size_t leave = others(cell)[0];
  for (std::uint32_t c = cell; ring.empty() || c != cell;) {
    ring.push_back(c);
    const std::vector<std::size_t> both = others(c);
    const std::uint32_t stays = corners[c][both[0] == leave ? both[1] : both[0]];
    c = neighbours[c][leave];
    for (const std::size_t k : others(c))
      if (corners[c][k] == stays) leave = k;
  }
  return ring;
}

struct Delaunay::Data {
  Triangulation triangulation;
};

Delaunay::Delaunay(const std::vector<Vec3>& points) : data_(std::make_unique<Data>()) {
  std::vector<std::pair<Kernel::Point_3, std::uint32_t>> numbered;
  numbered.reserve(points.size());
  for (const Vec3& p : points)
    numbered.emplace_back(Kernel::Point_3(p.x(), p.y(), p.z()), static_cast<std::uint32_t>(numbered.size()));
  data_->triangulation.insert(numbered.begin(), numbered.end());
}

Delaunay::~Delaunay() = default;

bool Delaunay::is_flat() const {
  return data_->triangulation.dimension() < 3;
}

DelaunayCells Delaunay::cells() const {
  const Triangulation& triangulation = data_->triangulation;
  DelaunayCells cells;
  std::unordered_map<const void*, std::uint32_t> number;
  for (const auto c : triangulation.all_cell_handles()) number.emplace(&*c, static_cast<std::uint32_t>(number.size()));
  for (const auto c : triangulation.all_cell_handles()) {
    auto& corners = cells.corners.emplace_back();
    auto& neighbours = cells.neighbours.emplace_back();
    for (int k = 0; k < 4; ++k) {
      const auto i = static_cast<std::size_t>(k);
      corners[i] = triangulation.is_infinite(c->vertex(k)) ? DelaunayCells::infinite : c->vertex(k)->info();
      neighbours[i] = number.at(&*c->neighbor(k));
    }
  }
  return cells;
}

std::vector<Triangle> Delaunay::advancing_front(double beta) const {
  if (is_flat()) return {};
  Triangulation copy(data_->triangulation);  // in whose cells the front keeps its state
  CGAL::Advancing_front_surface_reconstruction<Triangulation> front(copy);
  constexpr double no_bound = 5;  // CGAL 5.5 does not read it
  front.run(no_bound, beta);
  std::vector<Triangle> triangles;
  const auto& surface = front.triangulation_data_structure_2();
  for (auto f = surface.faces_begin(); f != surface.faces_end(); ++f) {
    if (!f->is_on_surface()) continue;
    Triangle& t = triangles.emplace_back();
    for (int k = 0; k < 3; ++k) t[static_cast<std::size_t>(k)] = f->vertex(k)->vertex_3()->info();
  }
  // CGAL lists them by where they lie in memory.
  std::ranges::sort(triangles, {}, sorted);
  for (Triangle& t : triangles) std::ranges::rotate(t, std::ranges::min_element(t));
  return triangles;
}

}  // namespace scan2fea
