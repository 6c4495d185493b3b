#include "preproc/surface/enrichment/importance.hpp"

#include "preproc/mesh/median.hpp"
#include "preproc/mesh/numbers.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>
#include <utility>

namespace scan2fea {
namespace {

constexpr double pi = std::numbers::pi;

}  // namespace

void FilledSectors::add(const Vec3& p) {
  const double angle = std::arg(frame_.coordinates(p - origin_));
  filled_[static_cast<std::size_t>((angle + pi) / (2 * pi) * 6) % 6] = true;
}

bool FilledSectors::surrounded() const {
  for (std::size_t i = 0; i < 6; ++i)
    if (!filled_[i] && !filled_[(i + 1) % 6]) return false;
  return true;
}

template <class Visit>
void Importance::search_from(Index v, double radius, Visit visit) {
  const std::array<Index, 1> seed{v};
  nearest_.search(
      seed, mesh_.points[v], radius,
      [&](Index w) { return normals_.mean(w).dot(normals_.mean(v)) > smallest_neighbour_cosine; },
      [&](Index w, double distance) { return w == v || visit(w, distance); });
}

std::vector<Vec3> Importance::empty_sectors(Index v, const ImportanceOptions& options) {
  const TangentFrame frame(normals_.mean(v));
  std::vector<double> angles;
  search_from(v, options.sampling_radius, [&](Index w, double) {
    angles.push_back(angle_to(v, frame, mesh_.points[w]));
    return angles.size() <= options.most_neighbours;
  });
  if (angles.size() > options.most_neighbours) return {};
  if (angles.empty()) angles.push_back(angle_to(v, frame, far_end_of_longest_edge(v)));
  if (mesh_.is_border_vertex(v)) fill_outside(v, frame, angles);
  std::sort(angles.begin(), angles.end());

  const double least = options.empty_sector_deg * pi / 180;
  std::vector<std::pair<double, double>> sectors;  // minus the width, bisector
  for (std::size_t i = 0; i < angles.size(); ++i) {
    const double next = i + 1 < angles.size() ? angles[i + 1] : angles[0] + 2 * pi;
    if (next - angles[i] >= least) sectors.emplace_back(angles[i] - next, 0.5 * (angles[i] + next));
  }
  std::sort(sectors.begin(), sectors.end());
  std::vector<Vec3> bisectors;
  for (const auto& [width, bisector] : sectors) bisectors.push_back(frame.vector(std::polar(1.0, bisector)));
  return bisectors;
}

double Importance::median_spacing(std::span<const Index> vertices) {
  std::vector<double> spacing;
  for (const Index v : vertices) {
    std::size_t met = 0;
    double sixth = infinity;
    search_from(v, infinity, [&](Index, double distance) {
      if (++met < 6) return true;
      sixth = std::sqrt(distance);
      return false;
    });
    if (std::isfinite(sixth)) spacing.push_back(sixth);
  }
  return median(std::move(spacing));
}

double Importance::angle_to(Index v, const TangentFrame& frame, const Vec3& p) const {
  return std::arg(frame.coordinates(p - mesh_.points[v]));
}

Vec3 Importance::far_end_of_longest_edge(Index v) const {
  Vec3 far = mesh_.points[v];
  double longest = 0;
  mesh_.for_each_neighbour(v, [&](Index w) {
    const double length = (mesh_.points[w] - mesh_.points[v]).norm();
    if (length > longest) {
      longest = length;
      far = mesh_.points[w];
    }
  });
  return far;
}

// Beyond a border nothing is missing: directions there count as taken.
void Importance::fill_outside(Index v, const TangentFrame& frame, std::vector<double>& angles) const {
  Index last = HalfedgeMesh::none;
  mesh_.for_each_neighbour(v, [&](Index w) { last = w; });
  const double from = angle_to(v, frame, mesh_.points[last]);
  double to = angle_to(v, frame, mesh_.points[mesh_.target(mesh_.outgoing(v))]);
  if (to < from) to += 2 * pi;
  for (double angle = from; angle < to; angle += 0.25 * pi) angles.push_back(std::remainder(angle, 2 * pi));
  angles.push_back(std::remainder(to, 2 * pi));
}

}  // namespace scan2fea
