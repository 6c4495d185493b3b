#include "quality/deviation_bound.hpp"

#include "preproc/mesh/error.hpp"
#include "preproc/mesh/numbers.hpp"
#include "quality/face_blocks.hpp"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string>

namespace scan2fea {
namespace {

constexpr std::size_t faces_of_block = 512;  // fixed, so that hints, and with them ties, do not depend on threads
// A piece needs two cuts to lie over one candidate where it crosses between two. Every third halves the longest edge,
// so that pieces shrink in all directions whatever lies below.
constexpr int cuts_in_turn = 3;
// Nearer to a corner than this a cut leaves a sliver for nothing: the corner is on the border between the candidates.
constexpr double nearest_cut = 0.02;
// Of the reference's diagonal: distances below it are not told from zero, so that surfaces that coincide cost little.
constexpr double smallest_limit = 1e-7;

// Over what is known of a triangle's distance, or the limit. Parts of the other surface that are higher over it say
// little about it, and cutting it finds them nearer.
constexpr double most_height = 6;

double squared_distance(const DeviationReference& target, const Vec3& p, std::uint32_t triangle) {
  const std::vector<Vec3>& points = target.mesh().vertices;
  const auto& [a, b, c] = target.mesh().triangles[triangle];
  return (p - closest_point_on_triangle(p, points[a], points[b], points[c])).squaredNorm();
}

struct Corner {
  Vec3 point;
  double squared_distance;  // to the target
  std::uint32_t nearest;    // triangle of it
};

struct Piece {
  std::array<Corner, 3> corners;
  int depth;
};

Corner corner_at(const Vec3& point, const DeviationReference& target, std::uint32_t hint) {
  const ClosestPoint closest = target.tree().closest(point, hint);
  return {point, closest.squared_distance, closest.triangle};
}

// Of the corners' squared distances to one triangle the largest; infinite where that is not below `useful`.
double squared_bound_by(std::uint32_t candidate, const Piece& piece, const DeviationReference& target, double useful) {
  double largest = 0;
  for (const Corner& c : piece.corners) {
    largest =
        std::max(largest, c.nearest == candidate ? c.squared_distance : squared_distance(target, c.point, candidate));
    if (largest >= useful) return std::numeric_limits<double>::infinity();
  }
  return largest;
}

double squared_upper_bound(const Piece& piece, const DeviationReference& target) {
  const auto& [a, b, c] = piece.corners;
  double least = squared_bound_by(a.nearest, piece, target, std::numeric_limits<double>::infinity());
  const auto try_candidate = [&](std::uint32_t t) {
    least = std::min(least, squared_bound_by(t, piece, target, least));
  };
  if (b.nearest != a.nearest) try_candidate(b.nearest);
  if (c.nearest != a.nearest && c.nearest != b.nearest) try_candidate(c.nearest);
  return least;
}

double squared_length(const Piece& piece, std::size_t edge) {
  return (piece.corners[(edge + 1) % 3].point - piece.corners[edge].point).squaredNorm();
}

// The longest edge; with `between_candidates`, of those whose ends have different nearest triangles.
std::size_t edge_to_cut(const Piece& piece, bool between_candidates) {
  std::size_t longest = 0;
  double length2 = -1;
  for (std::size_t e = 0; e < 3; ++e) {
    if (between_candidates && piece.corners[e].nearest == piece.corners[(e + 1) % 3].nearest) continue;
    const double here = squared_length(piece, e);
    if (here > length2) {
      length2 = here;
      longest = e;
    }
  }
  return longest;
}

// Where on the edge from one corner to another both corners' nearest triangles are equally far, as a fraction. The
// signed root of the difference of squared distances is linear where the two triangles lie in one plane.
double equally_far(const Corner& from, const Corner& to, const DeviationReference& target) {
  const auto difference = [](double squared_from, double squared_to) {
    const double d = squared_from - squared_to;
    return std::copysign(std::sqrt(std::abs(d)), d);
  };
  double low = 0, high = 1;
  double at_low = difference(from.squared_distance, squared_distance(target, from.point, to.nearest));
  double at_high = difference(squared_distance(target, to.point, from.nearest), to.squared_distance);
  if (!(at_low < 0) || !(at_high > 0)) return 0.5;
  double fraction = 0.5;
  for (int step = 0; step < 2; ++step) {
    fraction = low + (high - low) * at_low / (at_low - at_high);
    const Vec3 p = from.point + fraction * (to.point - from.point);
    const double here = difference(squared_distance(target, p, from.nearest), squared_distance(target, p, to.nearest));
    if (std::abs(here) < 0.05 * std::min(-at_low, at_high)) break;
    (here < 0 ? low : high) = fraction;
    (here < 0 ? at_low : at_high) = here;
  }
  return std::clamp(fraction, nearest_cut, 1 - nearest_cut);
}

struct FaceBound {
  double lower2 = 0, upper2 = 0;
  Vec3 farthest = Vec3::Zero();
};

// Bounds one triangle after the other; one for each thread.
class FaceBounder {
 public:
  FaceBounder(const DeviationReference& target, const DeviationBoundOptions& options)
      : target_(target), options_(options), cover_(target.tree(), target.edges(), target.box()) {}

  FaceBound bound(const std::array<Corner, 3>& corners) {
    bound_ = {};
    for (const Corner& c : corners) meet(c);
    const Piece face{corners, 0};
    const double upper2 = squared_upper_bound(face, target_);
    if (!settle(upper2) && !settle_by_cover(corners, corners[0].nearest) && !settle_by_middle(face, upper2))
      cut(face, 0);
    // What lies straight over a point may be its nearest, in two roundings.
    bound_.upper2 = std::max(bound_.upper2, bound_.lower2);
    return bound_;
  }

 private:
  void meet(const Corner& corner) {
    if (corner.squared_distance < bound_.lower2) return;
    bound_.lower2 = corner.squared_distance;
    bound_.farthest = corner.point;
  }
  Corner met_at(const Vec3& point, std::uint32_t hint) {
    Corner corner = corner_at(point, target_, hint);
    meet(corner);
    return corner;
  }

  // Pieces up to this need no cut.
  double enough2() const {
    const double lower = std::sqrt(bound_.lower2);
    const double enough = std::max(options_.limit, lower + options_.tolerance * std::max(lower, options_.limit));
    return std::max(enough * enough, bound_.upper2);
  }

  // Takes the upper bound of a piece where it is low enough.
  bool settle(double upper2) {
    if (upper2 > enough2()) return false;
    bound_.upper2 = std::max(bound_.upper2, upper2);
    return true;
  }

  // A corner on an edge or vertex of the target has several nearest triangles and names one, and that may lie beside
  // the face: the middle tells which.
  bool settle_by_middle(const Piece& face, double upper2) {
    const auto& [a, b, c] = face.corners;
    const Corner middle = met_at((a.point + b.point + c.point) / 3, a.nearest);
    if (settle(std::min(upper2, squared_bound_by(middle.nearest, face, target_, upper2)))) return true;
    return middle.nearest != a.nearest && settle_by_cover(face.corners, middle.nearest);
  }

  // By the parts of the target that lie over the face. Those that lie too high are asked for their real distance, the
  // highest one first; what is left is cut, piece by piece of what one triangle of the target covers.
  bool settle_by_cover(const std::array<Corner, 3>& corners, std::uint32_t seed) {
    const double known = std::max(options_.limit, std::sqrt(bound_.lower2));
    const auto& [a, b, c] = corners;
    if (!cover_.covers(a.point, b.point, c.point, target_.tree().leaf_of(seed), most_height * known)) return false;
    if (settle(cover_.largest_height() * cover_.largest_height())) return true;
    met_at(cover_.foot_of_highest(), seed);
    high_.clear();
    for (const PrismCover::Part& part : cover_.parts())
      if (part.height > 0 && !settle(part.height * part.height)) high_.push_back(part);
    std::sort(high_.begin(), high_.end(), [](const auto& x, const auto& y) {
      return x.height != y.height ? x.height > y.height : x.leaf < y.leaf;
    });
    for (const PrismCover::Part& part : high_) {
      const PrismCover::Polygon foot = cover_.foot_of(part);
      if (settle(foot.height * foot.height)) continue;
      std::array<Corner, PrismCover::most_corners> around;
      const std::uint32_t hint = target_.tree().leaf_order()[part.leaf];
      for (std::size_t i = 0; i < foot.size; ++i) around[i] = met_at(foot.corners[i], hint);
      for (std::size_t i = 2; i < foot.size; ++i) cut({{around[0], around[i - 1], around[i]}, 0}, cover_.slack());
    }
    return true;
  }

  // Cuts until every piece's upper bound is below the limit or near what some point has reached. To all bounds `slack`
  // is added.
  void cut(const Piece& whole, double slack) {
    stack_.assign(1, whole);
    while (!stack_.empty()) {
      const Piece piece = stack_.back();
      stack_.pop_back();
      double upper2 = squared_upper_bound(piece, target_);
      if (slack > 0) upper2 = std::pow(std::sqrt(upper2) + slack, 2);
      if (settle(upper2)) continue;
      const bool halve = piece.depth % cuts_in_turn == cuts_in_turn - 1;
      const std::size_t e = edge_to_cut(piece, !halve);
      const Corner &from = piece.corners[e], &to = piece.corners[(e + 1) % 3];
      const double fraction = halve ? 0.5 : equally_far(from, to, target_);
      const Vec3 point = from.point + fraction * (to.point - from.point);
      if (squared_length(piece, e) <= 0 || point == from.point || point == to.point) {
        bound_.upper2 = std::max(bound_.upper2, upper2);  // at the end of the numbers
        continue;
      }
      const Corner at_cut = met_at(point, from.nearest);
      Piece part = piece;
      part.depth = piece.depth + 1;
      part.corners[e] = at_cut;
      stack_.push_back(part);
      part.corners[e] = from;
      part.corners[(e + 1) % 3] = at_cut;
      stack_.push_back(part);
    }
  }

  const DeviationReference& target_;
  const DeviationBoundOptions& options_;
  PrismCover cover_;
  FaceBound bound_;
  std::vector<Piece> stack_;
  std::vector<PrismCover::Part> high_;
};

// `order`: of the faces, such that neighbours in it are mostly neighbours in space.
OneSidedDeviation bound_side(const SurfaceMesh& from, const std::vector<std::uint32_t>& order_of_faces,
                             const DeviationReference& target, const DeviationBoundOptions& options) {
  const auto for_each_block = [](std::size_t count, const auto& body) {
    tbb::parallel_for(std::size_t{0}, (count + faces_of_block - 1) / faces_of_block, [&](std::size_t block) {
      body(block * faces_of_block, std::min(count, (block + 1) * faces_of_block));
    });
  };

  // The corners that faces share are searched once, in the order in which the leaves meet them: each is then near the
  // one before, whose nearest triangle is a good first guess.
  constexpr std::uint32_t unmet = ~0U;
  std::vector<std::uint32_t> place(from.vertices.size(), unmet);
  std::vector<std::uint32_t> order;
  order.reserve(from.vertices.size());
  for (const std::uint32_t t : order_of_faces) {
    for (const std::uint32_t v : from.triangles[t]) {
      if (place[v] != unmet) continue;
      place[v] = static_cast<std::uint32_t>(order.size());
      order.push_back(v);
    }
  }
  std::vector<Corner> corners(order.size());
  for_each_block(order.size(), [&](std::size_t first, std::size_t last) {
    std::uint32_t hint = target.tree().leaf_order()[0];
    for (std::size_t i = first; i < last; ++i) {
      corners[i] = corner_at(from.vertices[order[i]], target, hint);
      hint = corners[i].nearest;
    }
  });

  OneSidedDeviation result;
  result.lower.resize(from.triangles.size());
  result.upper.resize(from.triangles.size());
  result.farthest.resize(from.triangles.size());
  for_each_block(from.triangles.size(), [&](std::size_t first, std::size_t last) {
    FaceBounder bounder(target, options);
    for (std::size_t i = first; i < last; ++i) {
      const std::uint32_t f = order_of_faces[i];
      const auto& [a, b, c] = from.triangles[f];
      const FaceBound bound = bounder.bound({corners[place[a]], corners[place[b]], corners[place[c]]});
      result.lower[f] = std::sqrt(bound.lower2);
      result.upper[f] = std::sqrt(bound.upper2);
      result.farthest[f] = bound.farthest;
    }
  });
  for (std::uint32_t f = 0; f < result.upper.size(); ++f) {
    result.largest_lower = std::max(result.largest_lower, result.lower[f]);
    if (result.upper[f] > result.upper[result.worst_face]) result.worst_face = f;
  }
  result.largest_upper = result.upper[result.worst_face];
  return result;
}

DeviationBoundOptions checked(const DeviationBoundOptions& options, const SurfaceMesh& reference) {
  if (!(options.limit >= 0) || !(options.tolerance > 0 && options.tolerance <= 1))
    throw WrongUsage(
        {.what = "options of the deviation's bound out of range",
         .where = {},
         .value = "limit " + std::to_string(options.limit) + ", tolerance " + std::to_string(options.tolerance),
         .limit = "0 or more; above 0, at most 1",
         .advice = {}});
  DeviationBoundOptions used = options;
  used.limit = std::max(options.limit, smallest_limit * bounding_box(reference.vertices).diagonal());
  return used;
}

}  // namespace

double DeviationBound::lower() const {
  return std::max(to_reference.largest_lower, to_mesh.largest_lower);
}

double DeviationBound::upper() const {
  return std::max(to_reference.largest_upper, to_mesh.largest_upper);
}

const OneSidedDeviation& DeviationBound::worse_side() const {
  return to_mesh.largest_upper > to_reference.largest_upper ? to_mesh : to_reference;
}

DeviationReference::DeviationReference(const SurfaceMesh& mesh)
    : mesh_(mesh), tree_(mesh), edges_(mesh, tree_), box_(bounding_box(mesh.vertices)) {}

DeviationBound bound_deviation(const SurfaceMesh& mesh, const SurfaceMesh& reference,
                               const DeviationBoundOptions& options) {
  return bound_deviation(mesh, DeviationReference(reference), options);
}

DeviationBound bound_deviation(const SurfaceMesh& mesh, const DeviationReference& reference,
                               const DeviationBoundOptions& options) {
  const DeviationBoundOptions used = checked(options, reference.mesh());
  const DeviationReference made_ready(mesh);
  DeviationBound bound;
  bound.to_reference = bound_side(mesh, made_ready.tree().leaf_order(), reference, used);
  bound.to_mesh = bound_side(reference.mesh(), reference.tree().leaf_order(), made_ready, used);
  return bound;
}

OneSidedDeviation bound_one_sided_deviation(const SurfaceMesh& from, const SurfaceMesh& onto,
                                            const DeviationBoundOptions& options) {
  return bound_one_sided_deviation(from, DeviationReference(onto), options);
}

OneSidedDeviation bound_one_sided_deviation(const SurfaceMesh& from, const DeviationReference& onto,
                                            const DeviationBoundOptions& options) {
  const DeviationBoundOptions used = checked(options, onto.mesh());
  return bound_side(from, FaceBlocks(from).order(), onto, used);
}

}  // namespace scan2fea
