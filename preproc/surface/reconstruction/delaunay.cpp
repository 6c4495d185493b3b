#include "preproc/surface/reconstruction/delaunay.hpp"

#include "preproc/mesh/sorted_corners.hpp"

#include <CGAL/Advancing_front_surface_reconstruction.h>
#include <CGAL/Delaunay_triangulation_3.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Triangulation_vertex_base_with_info_3.h>

#include <algorithm>
#include <cmath>
#include <unordered_map>

namespace scan2fea {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
// CGAL's own vertices are numbered, too, but forget their numbers when they are copied.
using VertexBase =
    CGAL::Triangulation_vertex_base_with_info_3<std::uint32_t, Kernel,
                                                CGAL::Advancing_front_surface_reconstruction_vertex_base_3<Kernel>>;
using CellBase = CGAL::Advancing_front_surface_reconstruction_cell_base_3<Kernel>;
using Triangulation =
    CGAL::Delaunay_triangulation_3<Kernel, CGAL::Triangulation_data_structure_3<VertexBase, CellBase>>;

// A triangle that is too long is never a candidate: its radius counts as infinite. Equal radii are told apart by the
// triangles' numbers, since CGAL orders equal candidates by where they lie in memory.
struct NotTooLong {
  template <class Front, class Cell>
  double operator()(const Front& front, const Cell& cell, int index) const {
    double longest = 0, widest = 0;
    std::uint32_t numbers = 0;
    for (int k = 1; k < 4; ++k) {
      const auto a = cell->vertex((index + k) & 3), b = cell->vertex((index + k % 3 + 1) & 3);
      if (a == front.triangulation_3().infinite_vertex()) return front.infinity();
      longest = std::max(longest, CGAL::squared_distance(a->point(), b->point()));
      widest = std::max(widest, (*spacing)[a->info()]);
      numbers += a->info() * 2654435769U ^ a->info() >> 7;
    }
    if (longest > factor * factor * widest * widest) return front.infinity();
    return front.smallest_radius_delaunay_sphere(cell, index) * (1 + 1e-9 * numbers / 4294967296.0);
  }

  const std::vector<double>* spacing;
  double factor;
};

}  // namespace

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
  std::vector<double> spacing;
};

Delaunay::Delaunay(const std::vector<Vec3>& points, std::vector<double> spacing) : data_(std::make_unique<Data>()) {
  std::vector<std::pair<Kernel::Point_3, std::uint32_t>> numbered;
  numbered.reserve(points.size());
  for (const Vec3& p : points)
    numbered.emplace_back(Kernel::Point_3(p.x(), p.y(), p.z()), static_cast<std::uint32_t>(numbered.size()));
  data_->triangulation.insert(numbered.begin(), numbered.end());
  data_->spacing = std::move(spacing);
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

std::vector<Triangle> Delaunay::advancing_front(const FrontSettings& settings) const {
  if (is_flat()) return {};
  Triangulation copy(data_->triangulation);  // in whose cells the front keeps its state
  CGAL::Advancing_front_surface_reconstruction<Triangulation, NotTooLong> front(
      copy, NotTooLong{&data_->spacing, settings.longest_edge});
  constexpr double no_bound = 5;  // CGAL 5.5 does not read it
  front.run(no_bound, settings.beta);
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
