#include "preproc/surface/primitives/grow_shapes.hpp"

#include "preproc/surface/primitives/point_normals.hpp"

#include <Eigen/Cholesky>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <optional>
#include <queue>
#include <utility>

namespace scan2fea {
namespace {

// Squared sigmas; 4 sigmas are noise, more is another surface.
constexpr double unexplained = 16;
// Of a degree of freedom, in the same measure. A point that is described saves 10 at most, so that a plane needs 7
// points, a cylinder 11, one along a known direction 7.
constexpr double freedom_cost = 20;
// Residuals of a shape that is the surface's are noise, and know nothing of their neighbours'.
constexpr double most_autocorrelation = 0.5;
constexpr std::size_t patch_size = 20;
// The first planes must be none of the strips that a rounding has room for: ten points a degree of freedom.
constexpr std::size_t least_first_plane = 30;

using Index = std::uint32_t;

// Near a sharp edge normals are of neither side, so that the distance decides; beyond a right angle it is the other side
// of a wall.
double cost_of(const OrientedPoints& cloud, const ShapeNoise& noise, const Shape& shape, Index i) {
  constexpr double most_for_normal = 9;
  const double d = shape.signed_distance(cloud.points[i]) / noise.sigma;
  if (d * d >= unexplained) return d * d;
  const Vec3 normal = shape.normal(cloud.points[i]);
  if (normal.dot(cloud.normals[i]) < 0) return 2 * unexplained;
  const double turn = (normal - cloud.normals[i]).squaredNorm() / (noise.sigma_angle * noise.sigma_angle);
  return d * d + std::min(most_for_normal, turn);
}

// While shapes grow, costs that noise explains count alike: else each shape would lose the farther half of its noise to
// another one beside it.
double growing_cost(const OrientedPoints& cloud, const ShapeNoise& noise, const Shape& shape, Index i) {
  constexpr double noise_alone = 6;  // exceeded by 5 % of squared distances and turns together
  return std::clamp(cost_of(cloud, noise, shape, i), noise_alone, unexplained);
}

class Grower {
 public:
  Grower(const std::vector<Vec3>& points, const Neighbours& neighbours, const std::vector<Vec3>& outwards,
         const ShapeNoise& noise, std::vector<Vec3>& normals, const Interrupt& interrupt)
      : normals_(normals),
        cloud_{points, normals},
        neighbours_(neighbours),
        rest_(neighbours),
        outwards_(outwards),
        noise_(noise),
        interrupt_(interrupt),
        cost_(points.size(), unexplained),
        mark_(points.size(), 0) {
    grown_.labels.assign(points.size(), no_shape);
  }

  GrownShapes run() {
    // Planes tell the directions in which axes run.
    accept_best_first(candidates(true));
    for (int round = 0; round < 4; ++round) {
      compete_for_points(cloud_, neighbours_, noise_, 1, grown_);
      recount_costs();
      look_at_the_rest();
      if (!accept_best_first(candidates(false))) break;
    }
    return std::move(grown_);
  }

 private:
  // Neighbours and normals of the points without a shape, among themselves.
  void look_at_the_rest() {
    std::vector<bool> without(grown_.labels.size());
    for (Index i = 0; i < without.size(); ++i) without[i] = grown_.labels[i] == no_shape;
    rest_ = neighbours_within(neighbours_, cloud_.points, without, patch_size);
    const PointNormals among = own_side_normals(cloud_.points, rest_, outwards_);
    for (Index i = 0; i < without.size(); ++i)
      if (without[i] && !among.normals[i].isZero()) normals_[i] = among.normals[i];
  }

  // Flat places first: what grows there covers many other seeds.
  std::vector<Index> ordered_seeds() const {
    std::vector<double> bend(cloud_.points.size(), 0);
    std::vector<Index> seeds;
    for (Index i = 0; i < bend.size(); ++i) {
      if (grown_.labels[i] != no_shape || normals_[i].isZero() || rest_.of(i).size() < 4) continue;
      for (const Index j : rest_.of(i)) bend[i] += (normals_[j] - normals_[i]).squaredNorm();
      seeds.push_back(i);
    }
    std::stable_sort(seeds.begin(), seeds.end(), [&](Index a, Index b) { return bend[a] < bend[b]; });
    return seeds;
  }

  void recount_costs() {
    std::fill(cost_.begin(), cost_.end(), unexplained);
    for (const GrownShape& grown : grown_.shapes)
      for (const Index i : grown.points) cost_[i] = growing_cost(cloud_, noise_, grown.shape, i);
  }

  // Of planes and axes, each once, those of most points first.
  std::vector<Vec3> known_directions() const {
    constexpr std::size_t most = 8;
    constexpr double same_cosine = 0.9976;  // 4 degrees
    std::vector<const GrownShape*> by_size;
    for (const GrownShape& grown : grown_.shapes)
      if (grown.shape.kind != ShapeKind::sphere) by_size.push_back(&grown);
    std::stable_sort(by_size.begin(), by_size.end(),
                     [](const auto* a, const auto* b) { return a->points.size() > b->points.size(); });
    std::vector<Vec3> directions;
    for (const GrownShape* grown : by_size) {
      const Vec3& axis = grown->shape.axis;
      const bool known = std::any_of(directions.begin(), directions.end(),
                                     [&](const Vec3& d) { return std::abs(d.dot(axis)) > same_cosine; });
      if (!known && directions.size() < most) directions.push_back(axis);
    }
    return directions;
  }

  std::vector<Index> patch_of(Index seed) const {
    // Cosine of 72 degrees: a small hole's wall turns far within a patch.
    constexpr double same_side = 0.3;
    std::vector<Index> patch{seed};
    for (const Index j : rest_.of(seed))
      if (patch.size() < patch_size && cloud_.normals[j].dot(cloud_.normals[seed]) > same_side) patch.push_back(j);
    return patch;
  }

  std::vector<GrownShape> candidates(bool planes_only) {
    std::array<std::vector<bool>, 5> covered;
    covered.fill(std::vector<bool>(cloud_.points.size(), false));
    const std::vector<Vec3> directions = known_directions();
    std::vector<GrownShape> found;
    std::size_t tried = 0;
    for (const Index seed : ordered_seeds()) {
      if (++tried % 256 == 0 && interrupt_) interrupt_();
      const std::vector<Index> patch = patch_of(seed);
      for (const ShapeGuess& guess : best_guesses(patch, directions, planes_only)) {
        const auto kind = static_cast<std::size_t>(guess.shape.kind);
        if (covered[kind][seed]) continue;
        GrownShape grown{guess.shape, guess.known_direction ? freedom_on_direction(guess.shape) : full_freedom(guess.shape), patch};
        if (!grow(grown) || !(grown.gain > 0)) continue;
        if (planes_only && grown.points.size() < least_first_plane) continue;
        for (const Index i : grown.points) covered[kind][i] = true;
        found.push_back(std::move(grown));
      }
    }
    return found;
  }

  // One of each kind: that which describes the patch best.
  std::vector<ShapeGuess> best_guesses(const std::vector<Index>& patch, const std::vector<Vec3>& directions, bool planes_only) const {
    std::array<std::optional<ShapeGuess>, 5> best;
    std::array<double, 5> least;
    least.fill(std::numeric_limits<double>::infinity());
    for (ShapeGuess& guess : guess_shapes(cloud_, patch, directions)) {
      if (planes_only && guess.shape.kind != ShapeKind::plane) continue;
      double cost = guess.known_direction ? 0 : 2 * freedom_cost;
      for (const Index i : patch) cost += std::min(10 * unexplained, cost_of(cloud_, noise_, guess.shape, i));
      const auto kind = static_cast<std::size_t>(guess.shape.kind);
      if (!(cost < least[kind])) continue;
      least[kind] = cost;
      best[kind] = std::move(guess);
    }
    std::vector<ShapeGuess> guesses;
    for (std::optional<ShapeGuess>& guess : best)
      if (guess) guesses.push_back(std::move(*guess));
    return guesses;
  }

  // Fits the shape to its points and spreads from them over others that it describes better than what they have, until
  // both stay. At most threefold at a time: a shape fitted to few points is not to be trusted far off.
  bool grow(GrownShape& grown) {
    constexpr int most_rounds = 12;
    std::vector<Index> members = grown.points;
    for (int round = 0; round < most_rounds; ++round) {
      const ShapeFit fit = fit_shape(grown.shape, grown.freedom, cloud_.points, members, noise_.sigma);
      if (!fit.found) return false;
      // The axis has turned.
      if (!grown.freedom.tilt.empty()) grown.freedom = full_freedom(grown.shape);
      grown.rms = fit.rms;
      std::vector<Index> next = flooded(grown.shape, members, 3 * members.size());
      if (next.size() < 4) return false;
      const bool same = next == members;
      members = std::move(next);
      if (same) break;
    }
    grown.points = std::move(members);
    return rate(grown);
  }

  std::vector<Index> flooded(const Shape& shape, const std::vector<Index>& from, std::size_t most) {
    ++round_;
    std::vector<Index> region;
    const auto visit = [&](Index i) {
      if (mark_[i] == round_) return;
      mark_[i] = round_;
      if (growing_cost(cloud_, noise_, shape, i) < cost_[i]) region.push_back(i);
    };
    for (const Index i : from) visit(i);
    for (std::size_t next = 0; next < region.size() && region.size() < most; ++next) {
      const auto near = neighbours_.of(region[next]);
      for (const Index j : near.first(std::min<std::size_t>(10, near.size()))) visit(j);
    }
    std::sort(region.begin(), region.end());
    return region;
  }

  bool rate(GrownShape& grown) const {
    double saved = 0, squares = 0;
    for (const Index i : grown.points) {
      saved += cost_[i] - growing_cost(cloud_, noise_, grown.shape, i);
      const double d = grown.shape.signed_distance(cloud_.points[i]);
      squares += d * d;
    }
    grown.rms = std::sqrt(squares / static_cast<double>(grown.points.size()));
    grown.gain = saved - freedom_cost * grown.freedom.count();
    // Far below the noise residuals are rounding.
    if (grown.rms < 0.5 * noise_.sigma) return true;
    return autocorrelation(grown) < most_autocorrelation && !is_bent(grown);
  }

  // Whether a quadric over the plane explains so much of the distances from it that it is a strip of a rounding: by the
  // F-test, and a fifth of the squares, since among a thousand points a few of an adjoining rounding are significant.
  bool is_bent(const GrownShape& grown) const {
    constexpr double significant = 5, share_of_squares = 0.2;
    const auto count = static_cast<double>(grown.points.size());
    if (grown.shape.kind != ShapeKind::plane || count < 9) return false;
    const Vec3 x = grown.shape.axis.unitOrthogonal(), y = grown.shape.axis.cross(x);
    using Row = Eigen::Matrix<double, 6, 1>;
    Eigen::Matrix<double, 6, 6> matrix = Eigen::Matrix<double, 6, 6>::Zero();
    Row right = Row::Zero();
    double squares = 0, size = 0;
    for (const Index i : grown.points) size = std::max(size, (cloud_.points[i] - grown.shape.origin).norm());
    for (const Index i : grown.points) {
      const Vec3 d = (cloud_.points[i] - grown.shape.origin) / size;
      const double u = d.dot(x), v = d.dot(y), r = grown.shape.signed_distance(cloud_.points[i]) / size;
      const Row row(1, u, v, u * u, u * v, v * v);
      matrix += row * row.transpose();
      right += r * row;
      squares += r * r;
    }
    const double explained = right.dot(matrix.ldlt().solve(right)) / squares;
    return explained > share_of_squares && explained / 3 > significant * (1 - explained) / (count - 6);
  }

  double autocorrelation(const GrownShape& grown) const {
    double mean = 0;
    for (const Index i : grown.points) mean += grown.shape.signed_distance(cloud_.points[i]);
    mean /= static_cast<double>(grown.points.size());
    double products = 0, squares = 0;
    std::size_t pairs = 0;
    for (const Index i : grown.points) {
      const double r = grown.shape.signed_distance(cloud_.points[i]) - mean;
      squares += r * r;
      const auto near = neighbours_.of(i);
      for (const Index j : near.first(std::min<std::size_t>(6, near.size()))) {
        if (!std::binary_search(grown.points.begin(), grown.points.end(), j)) continue;
        products += r * (grown.shape.signed_distance(cloud_.points[j]) - mean);
        ++pairs;
      }
    }
    if (pairs == 0 || !(squares > 0)) return 0;
    return products / static_cast<double>(pairs) / (squares / static_cast<double>(grown.points.size()));
  }

  // The best candidate is grown again over what the better ones have left it, and taken if it still is the best.
  bool accept_best_first(std::vector<GrownShape> waiting) {
    using Entry = std::pair<double, std::size_t>;
    const auto worse = [](const Entry& a, const Entry& b) {
      return a.first < b.first || (a.first == b.first && a.second > b.second);
    };
    std::priority_queue<Entry, std::vector<Entry>, decltype(worse)> queue(worse);
    for (std::size_t i = 0; i < waiting.size(); ++i) queue.emplace(waiting[i].gain, i);
    bool any = false;
    while (!queue.empty()) {
      const auto [gain, i] = queue.top();
      queue.pop();
      GrownShape& grown = waiting[i];
      if (!grow(grown) || !(grown.gain > 0)) continue;
      if (grown.gain < 0.95 * gain && !queue.empty() && grown.gain < queue.top().first) {
        queue.emplace(grown.gain, i);
        continue;
      }
      accept(std::move(grown));
      any = true;
    }
    return any;
  }

  void accept(GrownShape grown) {
    const auto label = static_cast<Index>(grown_.shapes.size());
    for (const Index i : grown.points) {
      if (const Index old = grown_.labels[i]; old != no_shape) std::erase(grown_.shapes[old].points, i);
      grown_.labels[i] = label;
      cost_[i] = growing_cost(cloud_, noise_, grown.shape, i);
    }
    grown_.shapes.push_back(std::move(grown));
  }

  std::vector<Vec3>& normals_;
  const OrientedPoints cloud_;
  const Neighbours& neighbours_;
  Neighbours rest_;  // of the points without a shape, among themselves
  const std::vector<Vec3>& outwards_;
  const ShapeNoise& noise_;
  const Interrupt& interrupt_;
  std::vector<double> cost_;  // of each point as it is described now
  std::vector<std::uint32_t> mark_;
  std::uint32_t round_ = 0;
  GrownShapes grown_;
};

void relabel(const OrientedPoints& cloud, const Neighbours& neighbours, const ShapeNoise& noise, GrownShapes& grown) {
  std::vector<Index> labels(grown.labels.size(), no_shape);
  std::vector<Index> tried;
  for (Index i = 0; i < labels.size(); ++i) {
    tried.clear();
    double least = unexplained;
    const auto try_shape = [&](Index label) {
      if (label == no_shape || std::find(tried.begin(), tried.end(), label) != tried.end()) return;
      tried.push_back(label);
      const double cost = cost_of(cloud, noise, grown.shapes[label].shape, i);
      if (!(cost < least)) return;
      least = cost;
      labels[i] = label;
    };
    try_shape(grown.labels[i]);
    const auto near = neighbours.of(i);
    for (const Index j : near.first(std::min<std::size_t>(10, near.size()))) try_shape(grown.labels[j]);
  }
  grown.labels = std::move(labels);
  for (GrownShape& shape : grown.shapes) shape.points.clear();
  for (Index i = 0; i < grown.labels.size(); ++i)
    if (grown.labels[i] != no_shape) grown.shapes[grown.labels[i]].points.push_back(i);
}

// Shapes whose points save less than the shape costs.
void drop_unpaid(const OrientedPoints& cloud, const ShapeNoise& noise, GrownShapes& grown) {
  std::vector<Index> renamed(grown.shapes.size(), no_shape);
  std::vector<GrownShape> kept;
  for (std::size_t s = 0; s < grown.shapes.size(); ++s) {
    GrownShape& shape = grown.shapes[s];
    double saved = 0, squares = 0;
    for (const Index i : shape.points) {
      saved += unexplained - cost_of(cloud, noise, shape.shape, i);
      const double d = shape.shape.signed_distance(cloud.points[i]);
      squares += d * d;
    }
    shape.gain = saved - freedom_cost * shape.freedom.count();
    if (!(shape.gain > 0)) continue;
    shape.rms = std::sqrt(squares / static_cast<double>(shape.points.size()));
    renamed[s] = static_cast<Index>(kept.size());
    kept.push_back(std::move(shape));
  }
  for (Index& label : grown.labels)
    if (label != no_shape) label = renamed[label];
  grown.shapes = std::move(kept);
}

}  // namespace

GrownShapes grow_shapes(const std::vector<Vec3>& points, const Neighbours& neighbours,
                        const std::vector<Vec3>& outwards, const ShapeNoise& noise, std::vector<Vec3>& normals,
                        const Interrupt& interrupt) {
  return Grower(points, neighbours, outwards, noise, normals, interrupt).run();
}

void compete_for_points(const OrientedPoints& cloud, const Neighbours& neighbours, const ShapeNoise& noise, int rounds,
                        GrownShapes& grown) {
  for (int round = 0; round < rounds; ++round) {
    relabel(cloud, neighbours, noise, grown);
    drop_unpaid(cloud, noise, grown);
    for (GrownShape& shape : grown.shapes) {
      Shape fitted = shape.shape;
      if (!fit_shape(fitted, shape.freedom, cloud.points, shape.points, noise.sigma).found) continue;
      shape.shape = fitted;
      if (shape.freedom.tilt.size() == 2) shape.freedom = full_freedom(fitted);
    }
  }
}

}  // namespace scan2fea
