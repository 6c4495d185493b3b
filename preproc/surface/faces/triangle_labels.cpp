#include "preproc/surface/faces/triangle_labels.hpp"

#include "preproc/surface/primitives/shape_rating.hpp"

#include <algorithm>

namespace scan2fea {
namespace {

using Index = std::uint32_t;
using Labels = std::vector<Index>;

void add(Labels& labels, Index label) {
  const auto at = std::lower_bound(labels.begin(), labels.end(), label);
  if (at == labels.end() || *at != label) labels.insert(at, label);
}

// More than of a point that its shape just holds, so that a face may have outliers.
constexpr double cost_of_outlier = 20;

}  // namespace

TriangleLabels::TriangleLabels(const SurfaceMesh& mesh, const Primitives& found)
    : mesh_(mesh), found_(found), stars_(mesh) {}

double TriangleLabels::vertex_cost(Index vertex, Index label) const {
  if (label == no_primitive) return most_cost;
  // As find_primitives has it: 8 degrees are what curvature and uneven neighbours leave on normals without noise.
  const ShapeNoise noise{found_.sigma, 0.14 + (found_.spacing > 0 ? found_.noise / found_.spacing : 0)};
  return std::min(cost_of_outlier, cost_of({mesh_.vertices, found_.normals}, noise, found_.list[label].shape, vertex));
}

double TriangleLabels::cost(Index triangle, Index label) const {
  double sum = 0;
  for (const Index v : mesh_.triangles[triangle]) sum += vertex_cost(v, label);
  return sum / 3;
}

double TriangleLabels::cost_around(Index triangle, Index label) const {
  double sum = 0;
  for (const Index v : mesh_.triangles[triangle])
    for (const Index c : stars_.corners(v))
      for (const Index w : mesh_.triangles[c / 3]) sum += vertex_cost(w, label);
  return sum;
}

std::vector<Index> TriangleLabels::label() {
  std::vector<Labels> near(mesh_.vertices.size());
  const auto spread = [&](const auto& labels_of) {
    std::vector<Labels> around(mesh_.vertices.size());
    for (const Triangle& t : mesh_.triangles)
      for (const Index v : t)
        for (const Index w : t)
          for (const Index label : labels_of(w)) add(around[v], label);
    near = std::move(around);
  };
  for (Index v = 0; v < near.size(); ++v) near[v] = {found_.labels[v]};
  for (int ring = 0; ring < 2; ++ring) spread([&](Index w) -> const Labels& { return near[w]; });

  std::vector<Index> labels(mesh_.triangles.size());
  for (Index f = 0; f < labels.size(); ++f) {
    Labels asked;
    for (const Index v : mesh_.triangles[f])
      for (const Index label : near[v]) add(asked, label);
    labels[f] = asked.front();
    if (asked.size() == 1) continue;
    double least = HUGE_VAL;
    for (const Index label : asked)
      if (const double cost = cost_around(f, label); cost < least) {
        least = cost;
        labels[f] = label;
      }
  }
  return labels;
}

}  // namespace scan2fea
