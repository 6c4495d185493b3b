#include "preproc/surface/thinning/cluster_seeds.hpp"

#include "preproc/mesh/median.hpp"

#include <Eigen/Eigenvalues>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <tuple>

namespace scan2fea {
namespace {

using Place = SparseGrid::Place;
constexpr std::uint32_t none = SparseGrid::none;

// The first cells along the axes are 2, so that there are some before them, which hold nothing.
constexpr std::uint32_t first = 2;
Place place_of(const Vec3& in_cells) {
  Place place;
  for (std::size_t k = 0; k < 3; ++k) place[k] = first + static_cast<std::uint32_t>(in_cells[static_cast<int>(k)]);
  return place;
}

Vec3 corner_of(const Place& place) {
  return Vec3(place[0], place[1], place[2]) - Vec3::Constant(first);
}

constexpr std::array<std::array<int, 2>, 6> products{{{0, 0}, {0, 1}, {0, 2}, {1, 1}, {1, 2}, {2, 2}}};

// 0: the cell before, 1: the cell itself, 2: the cell behind. By the axes along which they are others.
using Step = std::array<std::uint32_t, 3>;
constexpr std::array<Step, 27> nearest_first = [] {
  std::array<Step, 27> steps{};
  std::size_t size = 0;
  for (std::size_t others = 0; others <= 3; ++others)
    for (std::uint32_t x = 0; x < 3; ++x)
      for (std::uint32_t y = 0; y < 3; ++y)
        for (std::uint32_t z = 0; z < 3; ++z)
          if (static_cast<std::size_t>((x != 1) + (y != 1) + (z != 1)) == others) steps[size++] = {x, y, z};
  return steps;
}();

}  // namespace

ClusterSeeds::ClusterSeeds(const BoundingBox& box, double cell) : low_(box.low), cell_(cell) {}

void ClusterSeeds::add(const SurfaceMesh& block) {
  for (const Triangle& t : block.triangles)
    for (const std::uint32_t v : t) {
      const Vec3 p = in_cells(block.vertices[v]);
      const Place place = place_of(p);
      Cell& cell = cell_at(place);
      const Eigen::Vector3f in_cell = (p - corner_of(place)).cast<float>();
      cell.sum += in_cell;
      for (std::size_t i = 0; i < products.size(); ++i)
        cell.products[i] += in_cell[products[i][0]] * in_cell[products[i][1]];
      ++cell.vertices;
    }
}

ClusterSeeds::Cell& ClusterSeeds::cell_at(const Place& place) {
  std::uint32_t& number = numbers_.at(place);
  if (number == none) {
    number = static_cast<std::uint32_t>(cells_.size());
    cells_.push_back({.place = place});
  }
  return cells_[number];
}

Vec3 ClusterSeeds::mean(const Cell& cell) {
  return corner_of(cell.place) + cell.sum.cast<double>() / static_cast<double>(cell.vertices);
}

ClusterSeeds ClusterSeeds::widened(double times) const {
  ClusterSeeds wide({low_, low_}, times * cell_);
  for (const Cell& cell : cells_) {
    const Place place = place_of(mean(cell) / times);
    Cell& into = wide.cell_at(place);
    const auto n = static_cast<float>(cell.vertices), scale = static_cast<float>(1 / times);
    // From the wide cell's corner to this one's.
    const Eigen::Vector3f off = (corner_of(cell.place) / times - corner_of(place)).cast<float>();
    const Eigen::Vector3f sum = scale * cell.sum;
    for (std::size_t i = 0; i < products.size(); ++i) {
      const auto [r, c] = products[i];
      into.products[i] += scale * scale * cell.products[i] + off[r] * sum[c] + sum[r] * off[c] + n * off[r] * off[c];
    }
    into.sum += sum + n * off;
    into.vertices += cell.vertices;
  }
  return wide;
}

double ClusterSeeds::thickness() const {
  // Corners of triangles: a plane goes through three vertices, each of which is counted some six times.
  constexpr std::uint32_t enough = 60;
  std::vector<double> all;
  for (const Cell& cell : cells_) {
    if (cell.vertices < enough) continue;
    const auto n = static_cast<double>(cell.vertices);
    const Vec3 middle = cell.sum.cast<double>() / n;
    Eigen::Matrix3d spread;
    for (std::size_t i = 0; i < products.size(); ++i) {
      const auto [r, c] = products[i];
      spread(r, c) = spread(c, r) = static_cast<double>(cell.products[i]) / n - middle[r] * middle[c];
    }
    Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver;
    solver.computeDirect(spread, Eigen::EigenvaluesOnly);
    all.push_back(std::sqrt(std::max(0.0, solver.eigenvalues()[0])));
  }
  return all.empty() ? 0 : cell_ * median(all);
}

// Calls visit(seed, squared distance) for those in the place's cell and in the cells about it, but for cells no nearer
// than the squared distance that the last visit gave back.
template <class Visit>
void ClusterSeeds::for_each_about(const Vec3& in_cells, Visit&& visit) const {
  const Place own = place_of(in_cells);
  // From the place, along each axis, to the cells before it, its own, and those behind it, squared.
  std::array<std::array<double, 3>, 3> gap;
  for (std::size_t k = 0; k < 3; ++k) {
    const double from_low = in_cells[static_cast<int>(k)] - (own[k] - double{first}), to_high = 1 - from_low;
    gap[k] = {from_low * from_low, 0, to_high * to_high};
  }
  double reach = std::numeric_limits<double>::infinity();
  for (const auto& [x, y, z] : nearest_first) {
    if (gap[0][x] + gap[1][y] + gap[2][z] >= reach) continue;
    const std::uint32_t seed = numbers_.find({own[0] + x - 1, own[1] + y - 1, own[2] + z - 1});
    if (seed != none) reach = visit(seed, (seeds_[seed] - in_cells).squaredNorm());
  }
}

bool ClusterSeeds::is_crowded(const Vec3& mean) const {
  constexpr double nearest = 0.6;
  bool found = false;
  for_each_about(mean, [&](std::uint32_t, double squared) {
    found = found || squared < nearest * nearest;
    return found ? 0 : nearest * nearest;
  });
  return found;
}

void ClusterSeeds::choose() {
  std::vector<std::uint32_t> order(cells_.size());
  std::iota(order.begin(), order.end(), 0U);
  // Ties by place, so that the order of triangles does not count.
  std::ranges::sort(order, [&](std::uint32_t a, std::uint32_t b) {
    return std::tuple(cells_[b].vertices, cells_[a].place) < std::tuple(cells_[a].vertices, cells_[b].place);
  });
  numbers_ = {};
  std::vector<std::uint32_t> chosen;  // cells
  for (const std::uint32_t c : order) {
    const Vec3 p = mean(cells_[c]);
    if (is_crowded(p)) continue;
    numbers_.at(cells_[c].place) = static_cast<std::uint32_t>(seeds_.size());
    seeds_.push_back(p);
    chosen.push_back(c);
  }
  // Numbered as the cells are, whose neighbours in the file are neighbours.
  std::ranges::sort(chosen);
  for (std::uint32_t s = 0; s < chosen.size(); ++s) {
    numbers_.at(cells_[chosen[s]].place) = s;
    seeds_[s] = mean(cells_[chosen[s]]);
  }
  cells_ = {};
}

std::uint32_t ClusterSeeds::nearest(const Vec3& in_cells) const {
  std::uint32_t best = none;
  double least = std::numeric_limits<double>::infinity();
  const auto look = [&](std::uint32_t seed, double squared) {
    if (squared < least) {
      least = squared;
      best = seed;
    }
    return least;
  };
  for_each_about(in_cells, look);
  if (best != none) return best;
  // The mean of what was a cell before all were widened may lie in the next one, and its seed's, which crowded it out,
  // in the one behind.
  const Place own = place_of(in_cells);
  for (std::uint32_t x = own[0] - 2; x <= own[0] + 2; ++x)
    for (std::uint32_t y = own[1] - 2; y <= own[1] + 2; ++y)
      for (std::uint32_t z = own[2] - 2; z <= own[2] + 2; ++z)
        if (const std::uint32_t seed = numbers_.find({x, y, z}); seed != none)
          look(seed, (seeds_[seed] - in_cells).squaredNorm());
  return best;
}

}  // namespace scan2fea
