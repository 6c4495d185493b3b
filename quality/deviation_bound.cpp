#include "quality/deviation_bound.hpp"

#include "preproc/mesh/error.hpp"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string>

namespace scan2fea {
namespace {

constexpr std::size_t block_size = 512;  // fixed, so that hints, and with them ties, do not depend on threads
// A piece needs two cuts to lie over one candidate where it crosses between two. Every third halves the longest edge,
// so that pieces shrink in all directions whatever lies below.
constexpr int cuts_in_turn = 3;
// Nearer to a corner than this a cut leaves a sliver for nothing: the corner is on the border between the candidates.
constexpr double nearest_cut = 0.02;
// Of the reference's diagonal: distances below it are not told from zero, so that surfaces that coincide cost little.
constexpr double smallest_limit = 1e-7;

struct Target {
  const SurfaceMesh& mesh;
  const TriangleTree& tree;

  double squared_distance(const Vec3& p, std::uint32_t triangle) const {
    const auto& [a, b, c] = mesh.triangles[triangle];
    return (p - closest_point_on_triangle(p, mesh.vertices[a], mesh.vertices[b], mesh.vertices[c])).squaredNorm();
  }
};

struct Corner {
  Vec3 point;
  double squared_distance;  // to the target
  std::uint32_t nearest;    // triangle of it
};

struct Piece {
  std::array<Corner, 3> corners;
  int depth;
};

Corner corner_at(const Vec3& point, const Target& target, std::uint32_t hint) {
  const ClosestPoint closest = target.tree.closest(point, hint);
  return {point, closest.squared_distance, closest.triangle};
}

// Of the corners' squared distances to one triangle the largest; infinite where that is not below `useful`.
double squared_bound_by(std::uint32_t candidate, const Piece& piece, const Target& target, double useful) {
  double largest = 0;
  for (const Corner& c : piece.corners) {
    largest =
        std::max(largest, c.nearest == candidate ? c.squared_distance : target.squared_distance(c.point, candidate));
    if (largest >= useful) return std::numeric_limits<double>::infinity();
  }
  return largest;
}

double squared_upper_bound(const Piece& piece, const Target& target) {
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
double equally_far(const Corner& from, const Corner& to, const Target& target) {
  const auto difference = [](double squared_from, double squared_to) {
    const double d = squared_from - squared_to;
    return std::copysign(std::sqrt(std::abs(d)), d);
  };
  double low = 0, high = 1;
  double at_low = difference(from.squared_distance, target.squared_distance(from.point, to.nearest));
  double at_high = difference(target.squared_distance(to.point, from.nearest), to.squared_distance);
  if (!(at_low < 0) || !(at_high > 0)) return 0.5;
  double fraction = 0.5;
  for (int step = 0; step < 2; ++step) {
    fraction = low + (high - low) * at_low / (at_low - at_high);
    const Vec3 p = from.point + fraction * (to.point - from.point);
    const double here = difference(target.squared_distance(p, from.nearest), target.squared_distance(p, to.nearest));
    if (std::abs(here) < 0.05 * std::min(-at_low, at_high)) break;
    (here < 0 ? low : high) = fraction;
    (here < 0 ? at_low : at_high) = here;
  }
  return std::clamp(fraction, nearest_cut, 1 - nearest_cut);
}

struct FaceBound {
  double lower2 = 0, upper2 = 0;
  Vec3 farthest = Vec3::Zero();

  void meet(const Corner& corner) {
    if (corner.squared_distance < lower2) return;
    lower2 = corner.squared_distance;
    farthest = corner.point;
  }
};

// Cuts until every piece's upper bound is below the limit or near what some point has reached.
FaceBound bound_face(const Piece& face, const Target& target, const DeviationBoundOptions& options,
                     std::vector<Piece>& stack) {
  FaceBound bound;
  for (const Corner& c : face.corners) bound.meet(c);
  // Pieces up to this need no cut.
  const auto enough2 = [&] {
    const double lower = std::sqrt(bound.lower2);
    const double enough = std::max(options.limit, lower + options.tolerance * std::max(lower, options.limit));
    return std::max(enough * enough, bound.upper2);
  };
  stack.assign(1, face);
  while (!stack.empty()) {
    const Piece piece = stack.back();
    stack.pop_back();
    double upper2 = squared_upper_bound(piece, target);
    if (piece.depth == 0 && upper2 > enough2()) {
      // A corner on an edge or vertex of the target has several nearest triangles and names one: the middle tells
      // which.
      const Corner middle = corner_at((piece.corners[0].point + piece.corners[1].point + piece.corners[2].point) / 3,
                                      target, piece.corners[0].nearest);
      bound.meet(middle);
      upper2 = std::min(upper2, squared_bound_by(middle.nearest, piece, target, upper2));
    }
    if (upper2 <= enough2()) {
      bound.upper2 = std::max(bound.upper2, upper2);
      continue;
    }
    const bool halve = piece.depth % cuts_in_turn == cuts_in_turn - 1;
    const std::size_t e = edge_to_cut(piece, !halve);
    const Corner &from = piece.corners[e], &to = piece.corners[(e + 1) % 3];
    const double fraction = halve ? 0.5 : equally_far(from, to, target);
    const Vec3 point = from.point + fraction * (to.point - from.point);
    if (squared_length(piece, e) <= 0 || point == from.point || point == to.point) {
      bound.upper2 = std::max(bound.upper2, upper2);  // at the end of the numbers
      continue;
    }
    const Corner cut = corner_at(point, target, from.nearest);
    bound.meet(cut);
    Piece part = piece;
    part.depth = piece.depth + 1;
    part.corners[e] = cut;
    stack.push_back(part);
    part.corners[e] = from;
    part.corners[(e + 1) % 3] = cut;
    stack.push_back(part);
  }
  return bound;
}

OneSidedDeviation bound_side(const SurfaceMesh& from, const TriangleTree& from_tree, const Target& target,
                             const DeviationBoundOptions& options) {
  const auto for_each_block = [](std::size_t count, const auto& body) {
    tbb::parallel_for(std::size_t{0}, (count + block_size - 1) / block_size,
                      [&](std::size_t block) { body(block * block_size, std::min(count, (block + 1) * block_size)); });
  };

  // The corners that faces share are searched once, in the order in which the leaves meet them: each is then near the
  // one before, whose nearest triangle is a good first guess.
  constexpr std::uint32_t unmet = ~0U;
  std::vector<std::uint32_t> place(from.vertices.size(), unmet);
  std::vector<std::uint32_t> order;
  order.reserve(from.vertices.size());
  for (const std::uint32_t t : from_tree.leaf_order()) {
    for (const std::uint32_t v : from.triangles[t]) {
      if (place[v] != unmet) continue;
      place[v] = static_cast<std::uint32_t>(order.size());
      order.push_back(v);
    }
  }
  std::vector<Corner> corners(order.size());
  for_each_block(order.size(), [&](std::size_t first, std::size_t last) {
    std::uint32_t hint = target.tree.leaf_order()[0];
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
    std::vector<Piece> stack;
    for (std::size_t leaf = first; leaf < last; ++leaf) {
      const std::uint32_t f = from_tree.leaf_order()[leaf];
      const auto& [a, b, c] = from.triangles[f];
      const Piece face{{corners[place[a]], corners[place[b]], corners[place[c]]}, 0};
      const FaceBound bound = bound_face(face, target, options, stack);
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

DeviationBound bound_deviation(const SurfaceMesh& mesh, const SurfaceMesh& reference,
                               const DeviationBoundOptions& options) {
  return bound_deviation(mesh, reference, TriangleTree(reference), options);
}

DeviationBound bound_deviation(const SurfaceMesh& mesh, const SurfaceMesh& reference,
                               const TriangleTree& reference_tree, const DeviationBoundOptions& options) {
  const DeviationBoundOptions used = checked(options, reference);
  const TriangleTree mesh_tree(mesh);
  DeviationBound bound;
  bound.to_reference = bound_side(mesh, mesh_tree, {reference, reference_tree}, used);
  bound.to_mesh = bound_side(reference, reference_tree, {mesh, mesh_tree}, used);
  return bound;
}

OneSidedDeviation bound_one_sided_deviation(const SurfaceMesh& from, const SurfaceMesh& onto,
                                            const DeviationBoundOptions& options) {
  const DeviationBoundOptions used = checked(options, onto);
  const TriangleTree from_tree(from), onto_tree(onto);
  return bound_side(from, from_tree, {onto, onto_tree}, used);
}

}  // namespace scan2fea
