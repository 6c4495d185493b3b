#include "preproc/bodies/contact_border.hpp"

#include "preproc/mesh/error.hpp"
#include "preproc/mesh/error_text.hpp"

#include <algorithm>
#include <limits>
#include <map>
#include <optional>
#include <set>

namespace scan2fea {
namespace {

// Over the tolerance: each border may be off its own curve by one of it, and both together.
constexpr double farthest_apart = 4;
// A way along the first border over the edge of the second that it stands for, and so many tolerances more.
constexpr double longest_way = 1.5, way_at_corners = 10;

[[noreturn]] void fail_unclear(const Vec3& place, double distance, double limit) {
  throw NotMeshable({.what = "the borders of the contact on the two bodies do not match",
                     .where = {},
                     .value = error_text(distance) + " apart",
                     .limit = error_text(limit),
                     .advice = "another --contact",
                     .at = place});
}

class Border {
 public:
  Border(SplitSurface& surface, const std::vector<FeatureEdge>& edges) : surface_(surface) {
    for (const auto& [a, b] : edges) link(a, b);
  }

  // The vertex of the border that is nearest to the point, a new one where none is within the tolerance.
  std::uint32_t vertex_at(const Vec3& point, double tolerance, double farthest) {
    double nearest = std::numeric_limits<double>::infinity();
    FeatureEdge edge{};
    Vec3 foot = Vec3::Zero();
    for (const auto& [a, others] : next_)
      for (const std::uint32_t b : others) {
        if (b < a) continue;
        const Vec3 way = surface_.point(b) - surface_.point(a);
        const double t = std::clamp(way.dot(point - surface_.point(a)) / way.squaredNorm(), 0.0, 1.0);
        const Vec3 at = surface_.point(a) + t * way;
        if ((at - point).norm() >= nearest) continue;
        nearest = (at - point).norm();
        edge = {a, b};
        foot = at;
      }
    if (!(nearest <= farthest)) fail_unclear(point, nearest, farthest);
    const auto [a, b] = edge;
    const double to_a = (surface_.point(a) - foot).norm(), to_b = (surface_.point(b) - foot).norm();
    if (std::min(to_a, to_b) <= tolerance) return to_a <= to_b ? a : b;
    const std::uint32_t v = surface_.split_edge(a, b, foot);
    next_[a].erase(b);
    next_[b].erase(a);
    link(a, v);
    link(v, b);
    return v;
  }

  // The vertices between two of the border, along the shortest way; nothing where it is too long.
  std::optional<std::vector<std::uint32_t>> between(std::uint32_t from, std::uint32_t to, double longest) const {
    std::map<std::uint32_t, std::pair<double, std::uint32_t>> reached{{from, {0, from}}};
    std::set<std::pair<double, std::uint32_t>> open{{0, from}};
    while (!open.empty()) {
      const auto [length, v] = *open.begin();
      open.erase(open.begin());
      if (v == to) break;
      for (const std::uint32_t w : next_.at(v)) {
        const double there = length + (surface_.point(w) - surface_.point(v)).norm();
        const auto known = reached.find(w);
        if (there > longest || (known != reached.end() && known->second.first <= there)) continue;
        reached[w] = {there, v};
        open.insert({there, w});
      }
    }
    if (!reached.contains(to)) return {};
    std::vector<std::uint32_t> way;
    for (std::uint32_t v = reached.at(to).second; v != from && to != from; v = reached.at(v).second) way.push_back(v);
    std::reverse(way.begin(), way.end());
    return way;
  }

 private:
  void link(std::uint32_t a, std::uint32_t b) {
    next_[a].insert(b);
    next_[b].insert(a);
  }

  SplitSurface& surface_;
  std::map<std::uint32_t, std::set<std::uint32_t>> next_;
};

}  // namespace

std::vector<FeatureEdge> border_of_marked(const SurfaceMesh& mesh, const std::vector<bool>& listed,
                                          const std::vector<bool>& marked) {
  std::map<FeatureEdge, std::array<int, 2>> counts;
  for (std::size_t f = 0; f < mesh.triangles.size(); ++f)
    for (std::size_t k = 0; listed[f] && k < 3; ++k)
      ++counts[feature_edge(mesh.triangles[f][k], mesh.triangles[f][(k + 1) % 3])][marked[f] ? 1 : 0];
  std::vector<FeatureEdge> border;
  for (const auto& [edge, count] : counts)
    if (count[1] % 2 == 1) border.push_back(edge);
  return border;
}

std::vector<std::uint32_t> match_borders(SplitSurface& first, std::vector<FeatureEdge> border_of_first,
                                         SplitSurface& second, const std::vector<FeatureEdge>& border_of_second,
                                         double tolerance, double resolution) {
  Border border(first, border_of_first);
  std::vector<std::uint32_t> image(second.mesh().vertices.size(), no_image);
  for (const FeatureEdge& edge : border_of_second)
    for (const std::uint32_t v : edge)
      if (image[v] == no_image)
        image[v] = border.vertex_at(second.point(v), tolerance, std::max(farthest_apart * tolerance, resolution));
  for (const auto& [a, b] : border_of_second) {
    const double length = (second.point(b) - second.point(a)).norm();
    const double longest = longest_way * length + std::max(way_at_corners * tolerance, 2 * resolution);
    const auto way = border.between(image[a], image[b], longest);
    if (!way) fail_unclear(second.point(a), length, longest);
    std::uint32_t from = a;
    for (const std::uint32_t v : *way) {
      from = second.split_edge(from, b, first.point(v));
      image.push_back(v);
    }
  }
  return image;
}

}  // namespace scan2fea
