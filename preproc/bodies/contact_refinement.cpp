#include "preproc/bodies/contact_refinement.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>

namespace scan2fea {
namespace {

// Of the way to the middle, or along an edge: what is nearer to a corner or a side is as that is.
constexpr double nudge = 0.1;
constexpr int bisections = 30;
constexpr int most_rounds = 40;

class Refinement {
 public:
  Refinement(SplitSurface& surface, std::vector<bool>& listed, const FacingSurface& own, const FacingSurface& other,
             double tolerance)
      : surface_(surface), listed_(listed), own_(own), other_(other), tolerance_(tolerance) {}

  void halve_mixed(double longest) {
    std::vector<std::uint32_t> looked_at;
    for (std::uint32_t f = 0; f < listed_.size(); ++f)
      if (listed_[f]) looked_at.push_back(f);
    for (int round = 0; round < most_rounds && !looked_at.empty(); ++round) {
      std::vector<std::uint32_t> next;
      for (const std::uint32_t f : looked_at) {
        const std::size_t k = longest_side(f);
        const Triangle t = surface_.triangle(f);
        const std::uint32_t a = t[k], b = t[(k + 1) % 3];
        if ((surface_.point(a) - surface_.point(b)).norm() <= longest || !is_mixed(f)) continue;
        const std::uint32_t v = surface_.split_edge(a, b, (surface_.point(a) + surface_.point(b)) / 2);
        list_parts();
        for (const std::uint32_t part : surface_.around(v)) next.push_back(part);
      }
      std::sort(next.begin(), next.end());
      next.erase(std::unique(next.begin(), next.end()), next.end());
      std::erase_if(next, [&](std::uint32_t f) { return !listed_[f]; });
      looked_at = std::move(next);
    }
  }

  // After halving, so that a triangle's three sides tell where the contact ends in it.
  void split_where_it_ends(double longest) {
    std::map<std::pair<std::uint32_t, std::uint32_t>, Vec3> ends;
    for (std::uint32_t f = 0; f < listed_.size(); ++f) {
      const Triangle& t = surface_.triangle(f);
      for (std::size_t k = 0; listed_[f] && k < 3; ++k) {
        const std::uint32_t a = std::min(t[k], t[(k + 1) % 3]), b = std::max(t[k], t[(k + 1) % 3]);
        const Vec3 &from = surface_.point(a), &to = surface_.point(b);
        if ((to - from).norm() > 1.01 * longest || ends.contains({a, b})) continue;
        double inside = nudge, outside = 1 - nudge;
        const auto at = [&](double part) { return Vec3((1 - part) * from + part * to); };
        if (is_on(at(inside), f) == is_on(at(outside), f)) continue;
        if (!is_on(at(inside), f)) std::swap(inside, outside);
        for (int i = 0; i < bisections; ++i) {
          const double middle = (inside + outside) / 2;
          (is_on(at(middle), f) ? inside : outside) = middle;
        }
        ends[{a, b}] = at(inside);
      }
    }
    for (const auto& [edge, place] : ends) surface_.split_edge(edge.first, edge.second, place);
    list_parts();
  }

 private:
  bool is_on(const Vec3& place, std::uint32_t f) const {
    return other_.under(place, own_.normal(surface_.origin(f)), tolerance_).has_value();
  }

  std::size_t longest_side(std::uint32_t f) const {
    const Triangle& t = surface_.triangle(f);
    std::array<double, 3> length;
    for (std::size_t k = 0; k < 3; ++k) length[k] = (surface_.point(t[k]) - surface_.point(t[(k + 1) % 3])).norm();
    return static_cast<std::size_t>(std::max_element(length.begin(), length.end()) - length.begin());
  }

  bool is_mixed(std::uint32_t f) const {
    const Triangle& t = surface_.triangle(f);
    const Vec3 middle = (surface_.point(t[0]) + surface_.point(t[1]) + surface_.point(t[2])) / 3;
    const bool middle_is = is_on(middle, f);
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3 &a = surface_.point(t[k]), &b = surface_.point(t[(k + 1) % 3]);
      for (const Vec3& p : {a, Vec3((a + b) / 2)})
        if (is_on((1 - nudge) * p + nudge * middle, f) != middle_is) return true;
    }
    return false;
  }

  void list_parts() {
    for (auto f = static_cast<std::uint32_t>(listed_.size()); f < surface_.mesh().triangles.size(); ++f)
      listed_.push_back(listed_[surface_.split_from(f)]);
  }

  SplitSurface& surface_;
  std::vector<bool>& listed_;
  const FacingSurface &own_, &other_;
  double tolerance_;
};

}  // namespace

void refine_contact_border(SplitSurface& surface, std::vector<bool>& listed, const FacingSurface& own,
                           const FacingSurface& other, double tolerance, double resolution) {
  Refinement refinement(surface, listed, own, other, tolerance);
  refinement.halve_mixed(resolution);
  refinement.split_where_it_ends(resolution);
}

}  // namespace scan2fea
