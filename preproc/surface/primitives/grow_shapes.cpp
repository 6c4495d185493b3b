#include "preproc/surface/primitives/grow_shapes.hpp"

#include "preproc/surface/primitives/blend.hpp"
#include "preproc/surface/primitives/point_normals.hpp"
#include "preproc/surface/primitives/shape_growth.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <optional>
#include <queue>
#include <set>
#include <span>
#include <utility>

namespace scan2fea {
namespace {

// The first planes must be none of the strips that a rounding has room for: ten points a degree of freedom.
constexpr std::size_t least_first_plane = 30;
constexpr std::size_t most_first_seeds = 8000, seeds_of_a_probe = 1000;

using Index = std::uint32_t;

ShapeFreedom freedom_of(const ShapeGuess& guess) {
  if (guess.on_known_axis) return freedom_on_axis(guess.shape);
  return guess.on_known_direction ? freedom_on_direction(guess.shape) : full_freedom(guess.shape);
}

enum class Sought {
  large_planes,
  known_planes,  // across a known direction
  usual,         // planes, cylinders, roundings
  all,
};

bool is_usual(ShapeKind kind) {
  return kind == ShapeKind::plane || kind == ShapeKind::cylinder;
}

bool is_sought(const ShapeGuess& guess, Sought sought) {
  const bool plane = guess.shape.kind == ShapeKind::plane;
  switch (sought) {
    case Sought::large_planes:
      return plane;
    case Sought::known_planes:
      return plane && guess.on_known_direction;
    case Sought::usual:
      return is_usual(guess.shape.kind);
    case Sought::all:
      return true;
  }
  return true;
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
        cost_(points.size(), cost_without_shape),
        growth_(cloud_, neighbours, noise, grown_, cost_) {
    grown_.labels.assign(points.size(), no_shape);
  }

  ShapeSet run() {
    if (cloud_.points.size() > most_first_seeds && !may_be_part()) return std::move(grown_);
    // Planes tell the directions in which axes run.
    accept_best_first(candidates(Sought::large_planes), 0);
    // Strong shapes first; then planes across the directions that they tell, before anything bent takes their points;
    // then what pays on known axes.
    struct Pass {
      Sought sought;
      double least_gain;
    };
    constexpr std::array passes{Pass{Sought::all, strong}, Pass{Sought::known_planes, 0}, Pass{Sought::usual, 100},
                                Pass{Sought::all, 100},    Pass{Sought::usual, 0},        Pass{Sought::all, 0}};
    for (const Pass& pass : passes) {
      if (pass.least_gain < strong && !is_part()) break;
      compete_for_points(cloud_, neighbours_, noise_, 1, grown_);
      recount_costs();
      look_at_the_rest();
      accept_best_first(candidates(pass.sought), pass.least_gain);
    }
    // A bound for parts of many small shapes: what is tried first is largest.
    constexpr int most_doubts = 50;
    int doubts = 0;
    std::set<std::vector<bool>> in_vain;
    for (Index s = 0; s < grown_.shapes.size() && doubts < most_doubts && is_part(); ++s) {
      if (!is_doubtful(grown_.shapes[s])) continue;
      std::vector<bool> doubted = doubtful_around(s);
      if (in_vain.contains(doubted)) continue;
      ++doubts;
      if (try_without(doubted))
        in_vain.clear();
      else
        in_vain.insert(std::move(doubted));
    }
    return std::move(grown_);
  }

 private:
  // Some seeds tell an organic scan, on which all of them would be tried in vain. What they find is given up: the best
  // of few is not the best.
  bool may_be_part() {
    const std::vector<Vec3> normals = normals_;
    std::vector<Index> some;
    for (std::size_t k = 0; k < seeds_of_a_probe; ++k)
      some.push_back(static_cast<Index>(k * cloud_.points.size() / seeds_of_a_probe));
    accept_best_first(candidates(Sought::large_planes, some), 0);
    look_at_the_rest();
    accept_best_first(candidates(Sought::all, some), strong);
    const bool is = is_part();
    if (is) {
      grown_.shapes.clear();
      std::ranges::fill(grown_.labels, no_shape);
      recount_costs();
    }
    normals_ = normals;
    rest_ = neighbours_;
    return is;
  }

  // Where strong shapes describe less than a fifth, or need many numbers for it, weak ones do not make a part of it,
  // and would take long to be found.
  bool is_part() const {
    constexpr double least_points_per_freedom = 12;  // organic scans have up to 9, parts 25 to 60
    int freedom = 0;
    for (const FoundShape& found : grown_.shapes) freedom += degrees_of_freedom(found.shape.kind);
    const auto points = static_cast<double>(described());
    return 5 * points >= static_cast<double>(cloud_.points.size()) && points >= least_points_per_freedom * freedom;
  }

  // A few points on a piece of something bent are often a face and the rounding along its edge; a cone of hardly any
  // angle a cylinder and the fillet at its foot.
  static bool is_doubtful(const FoundShape& found) {
    constexpr std::size_t few = 60;
    if (found.shape.kind == ShapeKind::plane || found.relations.tangent_to) return false;
    return found.shape.kind != ShapeKind::cylinder || found.points.size() < few;
  }

  // Takes these away and looks for planes across known directions first, then for cylinders and roundings, then for
  // what else there is in their place. What makes the description shorter stays.
  bool try_without(const std::vector<bool>& doubted) {
    const ShapeSet before = grown_;
    const std::vector<Vec3> normals_before = normals_;
    const double cost_before = total();
    std::vector<bool> kept = doubted;
    kept.flip();
    std::vector<Index> freed;
    for (Index i = 0; i < before.labels.size(); ++i)
      if (before.labels[i] != no_shape && doubted[before.labels[i]]) freed.push_back(i);
    keep_shapes(grown_, kept);
    recount_costs();
    for (const Sought sought : {Sought::known_planes, Sought::usual, Sought::all}) {
      look_at_the_rest();
      accept_best_first(candidates(sought, freed), 0);
    }
    compete_for_points(cloud_, neighbours_, noise_, 1, grown_);
    recount_costs();
    if (total() < cost_before) return true;
    grown_ = before;
    normals_ = normals_before;
    recount_costs();
    return false;
  }

  // The shape and its doubtful neighbours.
  std::vector<bool> doubtful_around(Index shape) const {
    std::vector<bool> doubted(grown_.shapes.size(), false);
    doubted[shape] = true;
    for (const Index i : grown_.shapes[shape].points)
      for (const Index j : neighbours_.of(i))
        if (const Index label = grown_.labels[j]; label != no_shape && is_doubtful(grown_.shapes[label]))
          doubted[label] = true;
    return doubted;
  }

  // Of the whole description.
  double total() const {
    double sum = cost_without_shape * static_cast<double>(grown_.labels.size() - described());
    for (const FoundShape& found : grown_.shapes)
      sum += total_cost(cloud_, noise_, found.shape, found.freedom, found.points);
    return sum;
  }

  std::size_t described() const {
    return grown_.labels.size() -
           static_cast<std::size_t>(std::count(grown_.labels.begin(), grown_.labels.end(), no_shape));
  }

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
  std::vector<Index> ordered_seeds(std::span<const Index> among) const {
    std::vector<double> bend(cloud_.points.size(), 0);
    std::vector<Index> seeds;
    for (const Index i : among) {
      if (grown_.labels[i] != no_shape || normals_[i].isZero() || rest_.of(i).size() < 4) continue;
      for (const Index j : rest_.of(i)) bend[i] += (normals_[j] - normals_[i]).squaredNorm();
      seeds.push_back(i);
    }
    std::stable_sort(seeds.begin(), seeds.end(), [&](Index a, Index b) { return bend[a] < bend[b]; });
    return seeds;
  }

  void recount_costs() {
    std::fill(cost_.begin(), cost_.end(), cost_without_shape);
    for (const FoundShape& grown : grown_.shapes)
      for (const Index i : grown.points) cost_[i] = cost_of(cloud_, noise_, grown.shape, i);
  }

  // Directions of planes and axes, each once, those of most points first; then the axes themselves.
  std::vector<KnownAxis> known_axes() const {
    constexpr std::size_t most = 8;
    constexpr double same_cosine = 0.9976;  // 4 degrees
    std::vector<const FoundShape*> by_size;
    for (const FoundShape& grown : grown_.shapes)
      if (grown.shape.kind != ShapeKind::sphere) by_size.push_back(&grown);
    std::stable_sort(by_size.begin(), by_size.end(),
                     [](const auto* a, const auto* b) { return a->points.size() > b->points.size(); });
    std::vector<KnownAxis> axes;
    for (const FoundShape* grown : by_size) {
      const Vec3& axis = grown->shape.axis;
      const bool known = std::any_of(axes.begin(), axes.end(), [&](const KnownAxis& other) {
        return std::abs(other.direction.dot(axis)) > same_cosine;
      });
      if (!known && axes.size() < most) axes.push_back({axis, std::nullopt});
    }
    std::size_t lines = 0;
    for (const FoundShape* grown : by_size)
      if (grown->shape.kind != ShapeKind::plane && ++lines <= most)
        axes.push_back({grown->shape.axis, grown->shape.origin});
    return axes;
  }

  std::vector<Index> patch_of(Index seed) const {
    // Cosine of 72 degrees: a small hole's wall turns far within a patch.
    constexpr double same_side = 0.3;
    std::vector<Index> patch{seed};
    for (const Index j : rest_.of(seed))
      if (patch.size() < patch_size && cloud_.normals[j].dot(cloud_.normals[seed]) > same_side) patch.push_back(j);
    return patch;
  }

  std::vector<FoundShape> candidates(Sought sought) {
    std::vector<Index> all(cloud_.points.size());
    std::iota(all.begin(), all.end(), Index{0});
    return candidates(sought, all);
  }

  std::vector<FoundShape> candidates(Sought sought, std::span<const Index> among) {
    std::array<std::vector<bool>, 5> covered;
    covered.fill(std::vector<bool>(cloud_.points.size(), false));
    const std::vector<KnownAxis> axes = known_axes();
    std::vector<bool> blended(cloud_.points.size(), false);
    std::vector<FoundShape> found;
    std::size_t tried = 0;
    const std::vector<Index> seeds = ordered_seeds(among);
    // Where points are many, so are those of each shape that is strong enough to show that this is a part.
    const std::size_t stride = is_part() ? 1 : std::max<std::size_t>(1, seeds.size() / most_first_seeds);
    for (std::size_t k = 0; k < seeds.size(); k += stride) {
      const Index seed = seeds[k];
      if (++tried % 256 == 0 && interrupt_) interrupt_();
      if (blended[seed] && std::ranges::all_of(covered, [&](const auto& of_kind) { return of_kind[seed]; })) continue;
      const std::vector<Index> patch = patch_of(seed);
      if (sought >= Sought::usual && !blended[seed])
        if (auto blend = grown_blend(seed, patch)) {
          for (const Index i : blend->points) blended[i] = true;
          found.push_back(std::move(*blend));
        }
      for (const ShapeGuess& guess : best_guesses(patch, axes, sought)) {
        const auto kind = static_cast<std::size_t>(guess.shape.kind);
        if (covered[kind][seed]) continue;
        FoundShape grown{.shape = guess.shape,
                         .freedom = freedom_of(guess),
                         .points = held_by(guess.shape, patch),
                         .gain = 0,
                         .relations = {}};
        if (grown.points.size() < 5) grown.points = patch;
        if (!growth_.grow(grown)) {
          // From beside most of the patch is the same; and what has spread far in vain would do so again.
          const std::size_t beside = grown.points.size() > 3 * patch_size ? patch.size() : patch_size / 3;
          for (const Index i : std::span(patch).first(std::min(beside, patch.size()))) covered[kind][i] = true;
          continue;
        }
        if (sought == Sought::large_planes && grown.points.size() < least_first_plane) continue;
        for (const Index i : grown.points) covered[kind][i] = true;
        found.push_back(std::move(grown));
      }
    }
    return found;
  }

  std::vector<Index> held_by(const Shape& shape, const std::vector<Index>& patch) const {
    std::vector<Index> held;
    for (const Index i : patch)
      if (cost_of(cloud_, noise_, shape, i) < most_cost) held.push_back(i);
    return held;
  }

  // The shapes of many points that are met first around a seed.
  std::vector<Index> sides_near(Index seed) const {
    constexpr std::size_t most_sides = 3, least_points = 10;
    std::vector<Index> sides;
    const auto meet = [&](Index i) {
      const Index label = grown_.labels[i];
      if (label == no_shape || sides.size() == most_sides || grown_.shapes[label].points.size() < least_points) return;
      if (std::find(sides.begin(), sides.end(), label) == sides.end()) sides.push_back(label);
    };
    for (const Index i : neighbours_.of(seed)) meet(i);
    for (const Index i : neighbours_.of(seed))
      for (const Index j : neighbours_.of(i)) meet(j);
    return sides;
  }

  // The rounding between two of these that describes the patch best, grown.
  std::optional<FoundShape> grown_blend(Index seed, const std::vector<Index>& patch) {
    constexpr std::size_t least_points = 3;
    const std::vector<Index> sides = sides_near(seed);
    std::optional<FoundShape> best;
    for (std::size_t a = 0; a < sides.size(); ++a)
      for (std::size_t b = a + 1; b < sides.size(); ++b)
        for (const bool inner : {false, true}) {
          const auto blend =
              Blend::between(grown_.shapes[sides[a]].shape, grown_.shapes[sides[b]].shape, inner, cloud_.points[seed]);
          if (!blend) continue;
          const auto radius = blend->radius_through(cloud_.points[seed]);
          if (!radius) continue;
          const Shape shape = blend->with_radius(*radius);
          FoundShape grown{
              .shape = shape, .freedom = blend->freedom(), .points = held_by(shape, patch), .gain = 0, .relations = {}};
          if (grown.points.size() < least_points) continue;
          grown.relations.tangent_to = std::array{sides[a], sides[b]};
          if (growth_.grow(grown) && (!best || grown.gain > best->gain)) best = std::move(grown);
        }
    return best;
  }

  // One of each kind: that which describes the patch best.
  std::vector<ShapeGuess> best_guesses(const std::vector<Index>& patch, const std::vector<KnownAxis>& axes,
                                       Sought sought) const {
    std::array<std::optional<ShapeGuess>, 5> best;
    std::array<double, 5> least;
    least.fill(std::numeric_limits<double>::infinity());
    for (ShapeGuess& guess : guess_shapes(cloud_, patch, axes)) {
      if (!is_sought(guess, sought)) continue;
      double cost = description_cost(guess.shape.kind, freedom_of(guess));
      for (const Index i : patch) cost += std::min(10 * most_cost, cost_of(cloud_, noise_, guess.shape, i));
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

  // Where planes and cylinders can still come, a small ball or torus over both is premature.
  static double strictness(const FoundShape& grown) {
    return is_usual(grown.shape.kind) || grown.relations.tangent_to ? 1 : 4;
  }

  // The best candidate is grown again over what the better ones have left it, and taken if it still is the best.
  bool accept_best_first(std::vector<FoundShape> waiting, double least_gain) {
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
      FoundShape& grown = waiting[i];
      if (!growth_.grow(grown) || grown.gain <= least_gain * strictness(grown)) continue;
      if (grown.gain < 0.95 * gain && !queue.empty() && grown.gain < queue.top().first) {
        queue.emplace(grown.gain, i);
        continue;
      }
      accept(std::move(grown));
      any = true;
    }
    return any;
  }

  void accept(FoundShape grown) {
    const auto label = static_cast<Index>(grown_.shapes.size());
    for (const Index i : grown.points) {
      if (const Index old = grown_.labels[i]; old != no_shape) std::erase(grown_.shapes[old].points, i);
      grown_.labels[i] = label;
      cost_[i] = cost_of(cloud_, noise_, grown.shape, i);
    }
    grown_.shapes.push_back(std::move(grown));
  }

  static constexpr double strong = 250;  // gain

  std::vector<Vec3>& normals_;
  const OrientedPoints cloud_;
  const Neighbours& neighbours_;
  Neighbours rest_;  // of the points without a shape, among themselves
  const std::vector<Vec3>& outwards_;
  const ShapeNoise& noise_;
  const Interrupt& interrupt_;
  ShapeSet grown_;
  std::vector<double> cost_;  // of each point as it is described now
  ShapeGrowth growth_;
};

}  // namespace

ShapeSet grow_shapes(const std::vector<Vec3>& points, const Neighbours& neighbours, const std::vector<Vec3>& outwards,
                     const ShapeNoise& noise, std::vector<Vec3>& normals, const Interrupt& interrupt) {
  return Grower(points, neighbours, outwards, noise, normals, interrupt).run();
}

}  // namespace scan2fea
