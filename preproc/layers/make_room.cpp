#include "preproc/layers/make_room.hpp"

#include "preproc/mesh/numbers.hpp"

#include <algorithm>
#include <functional>
#include <optional>
#include <queue>
#include <utility>

namespace scan2fea {
namespace {

constexpr double reach_of_push = 4;  // a quarter of their length is the most that edges lose

class RoomMaker {
 public:
  RoomMaker(const SurfaceMesh& surface, const VertexStars& stars, const std::vector<bool>& is_layered,
            const std::vector<Vec3>& pushed, const std::vector<FeatureEdge>& lines, const BoundaryWays& ways)
      : surface_(surface), stars_(stars), is_layered_(is_layered), moves_(pushed), lines_(lines), ways_(ways) {}

  std::vector<Vec3> make() {
    for (const Vec3& move : moves_) largest_ = std::max(largest_, move.norm());
    find_followers();
    settle();
    std::vector<Vec3> places = surface_.vertices;
    for (const Follower& f : followers_)
      if (const auto point = ways_(f.vertex, places[f.vertex] + moves_[f.vertex])) places[f.vertex] = point->place;
    return places;
  }

 private:
  struct Follower {
    std::uint32_t vertex;
    std::vector<std::uint32_t> follows;
  };

  // Vertices that are near enough along edges, in the order of their numbers.
  void find_followers() {
    std::vector<double> distance(surface_.vertices.size(), infinity);
    using Entry = std::pair<double, std::uint32_t>;
    std::priority_queue<Entry, std::vector<Entry>, std::greater<>> queue;
    for (std::uint32_t v = 0; v < moves_.size(); ++v)
      if (!moves_[v].isZero()) queue.push({distance[v] = 0, v});
    while (!queue.empty()) {
      const auto [far, v] = queue.top();
      queue.pop();
      if (far > distance[v]) continue;
      for (const std::uint32_t w : neighbours_of(v)) {
        const double way = far + (surface_.vertices[w] - surface_.vertices[v]).norm();
        if (is_layered_[w] || way >= distance[w] || way > reach_of_push * largest_) continue;
        distance[w] = way;
        queue.push({way, w});
      }
    }
    for (std::uint32_t v = 0; v < distance.size(); ++v) {
      if (is_layered_[v] || distance[v] == infinity) continue;
      const std::optional<WayPoint> way = ways_(v, surface_.vertices[v]);
      if (!way) continue;
      Follower follower{v, neighbours_of(v)};
      if (way->is_on_line)
        std::erase_if(follower.follows,
                      [&](std::uint32_t w) { return !std::ranges::binary_search(lines_, feature_edge(v, w)); });
      if (!follower.follows.empty()) followers_.push_back(std::move(follower));
    }
  }

  std::vector<std::uint32_t> neighbours_of(std::uint32_t v) const {
    std::vector<std::uint32_t> all;
    for (const std::uint32_t corner : stars_.corners(v))
      for (const std::uint32_t w : surface_.triangles[corner / 3])
        if (w != v) all.push_back(w);
    std::ranges::sort(all);
    all.erase(std::ranges::unique(all).begin(), all.end());
    return all;
  }

  void settle() {
    constexpr int most_rounds = 300;
    constexpr double is_settled = 1e-3;  // of the largest push
    double change = infinity;
    for (int round = 0; round < most_rounds && change > is_settled * largest_; ++round) {
      change = 0;
      for (const Follower& f : followers_) {
        Vec3 sum = Vec3::Zero();
        for (const std::uint32_t w : f.follows) sum += moves_[w];
        const Vec3 mean = sum / static_cast<double>(f.follows.size());
        change = std::max(change, (mean - moves_[f.vertex]).norm());
        moves_[f.vertex] = mean;
      }
    }
  }

  const SurfaceMesh& surface_;
  const VertexStars& stars_;
  const std::vector<bool>& is_layered_;
  std::vector<Vec3> moves_;
  const std::vector<FeatureEdge>& lines_;
  const BoundaryWays& ways_;
  double largest_ = 0;
  std::vector<Follower> followers_;
};

}  // namespace

std::vector<Vec3> make_room(const SurfaceMesh& surface, const VertexStars& stars, const std::vector<bool>& is_layered,
                            const std::vector<Vec3>& pushed, const std::vector<FeatureEdge>& lines,
                            const BoundaryWays& ways) {
  return RoomMaker(surface, stars, is_layered, pushed, lines, ways).make();
}

}  // namespace scan2fea
