#include "preproc/bodies/contact_gap.hpp"

#include "preproc/surface/kernel/adjacency.hpp"

#include <cmath>
#include <optional>
#include <vector>

namespace scan2fea {
namespace {

void merge(const Gap& gap, std::optional<Gap>& into) {
  if (!into) {
    into = gap;
    return;
  }
  if (gap.narrowest < into->narrowest) {
    into->narrowest = gap.narrowest;
    into->middle = gap.middle;
  }
  if (gap.widest <= into->widest) return;
  into->widest = gap.widest;
  into->place = gap.place;
  into->triangle = gap.triangle;
}

// By triangle of one surface.
struct Faced {
  std::vector<std::optional<Gap>> gap;  // to the other one
  std::vector<bool> touches;

  explicit Faced(const SurfaceMesh& mesh) : gap(mesh.triangles.size()), touches(mesh.triangles.size(), false) {}
  bool any(std::uint32_t f) const { return gap[f] || touches[f]; }
};

// A triangle is touched in its middle, too, where a corner of the other surface stands on it.
void look_across(const GapSide& from, const GapSide& to, bool from_first, double tolerance, double reach, Faced& own,
                 Faced& other) {
  for (const std::uint32_t f : from.triangles) {
    const Triangle& t = from.mesh.triangles[f];
    for (const Vec3& p :
         {centroid(from.mesh, t), from.mesh.vertices[t[0]], from.mesh.vertices[t[1]], from.mesh.vertices[t[2]]}) {
      const auto foot = to.facing.under(p, from.facing.normal(f), reach);
      if (!foot || foot->height < -tolerance) continue;  // else it is the far side of a thin body
      if (foot->height <= tolerance) own.touches[f] = other.touches[foot->triangle] = true;
      merge({foot->height, foot->height, Vec3((p + foot->point) / 2), p, from_first ? f : foot->triangle}, own.gap[f]);
    }
  }
}

void add_pieces(const GapSide& side, const Faced& faced, double tolerance, std::vector<Gap>& gaps) {
  const MeshAdjacency adjacency(side.mesh);
  std::vector<bool> reached(side.mesh.triangles.size(), false);
  for (const std::uint32_t seed : side.triangles) {
    if (reached[seed] || !faced.any(seed)) continue;
    std::vector<std::uint32_t> piece{seed};
    reached[seed] = true;
    bool is_joined = false;
    std::optional<Gap> gap;
    for (std::size_t i = 0; i < piece.size(); ++i) {
      const std::uint32_t f = piece[i];
      is_joined = is_joined || faced.touches[f];
      if (faced.gap[f]) merge(*faced.gap[f], gap);
      for (const std::uint32_t n : adjacency.neighbours[f]) {
        if (n == no_face || reached[n] || !faced.any(n)) continue;
        if (side.facing.normal(n).dot(side.facing.normal(f)) < facing) continue;
        reached[n] = true;
        piece.push_back(n);
      }
    }
    if (!is_joined && gap->widest > tolerance) gaps.push_back(*gap);
  }
}

}  // namespace

std::vector<Gap> find_gaps_between(const GapSide& first, const GapSide& second, double tolerance, double reach) {
  Faced of_first(first.mesh), of_second(second.mesh);
  look_across(first, second, true, tolerance, reach, of_first, of_second);
  look_across(second, first, false, tolerance, reach, of_second, of_first);
  std::vector<Gap> gaps;
  add_pieces(second, of_second, tolerance, gaps);
  add_pieces(first, of_first, tolerance, gaps);
  return gaps;
}

}  // namespace scan2fea
