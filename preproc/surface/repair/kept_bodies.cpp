#include "preproc/surface/repair/kept_bodies.hpp"

#include "preproc/surface/repair/shells.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>

namespace scan2fea {
namespace {

constexpr double small_size = 0.1;
constexpr double small_content = 1e-3;
constexpr double small_cavity = 0.01;

class Choice {
 public:
  explicit Choice(std::vector<Shell> shells) : shells_(std::move(shells)) {
    for (std::size_t s = 0; s < shells_.size(); ++s) (is_cavity(shells_[s]) ? cavities_ : bodies_).push_back(s);
    std::stable_sort(bodies_.begin(), bodies_.end(),
                     [&](std::size_t a, std::size_t b) { return shells_[a].area > shells_[b].area; });
    if (bodies_.empty()) bodies_.swap(cavities_);  // a scan that is inside out
  }

  // A reason to go for each shell.
  std::vector<std::optional<RepairKind>> reasons(const KeptBodies& kept) const {
    std::vector<std::optional<RepairKind>> reasons(shells_.size());
    for (std::size_t i = 0; i < bodies_.size(); ++i)
      if (!std::visit([&](const auto& rule) { return stays(i, rule); }, kept))
        reasons[bodies_[i]] = RepairKind::DroppedSpeck;
    for (const std::size_t c : cavities_) {
      const bool has_body =
          std::any_of(bodies_.begin(), bodies_.end(), [&](std::size_t b) { return !reasons[b] && is_within(c, b); });
      const bool is_filled = std::holds_alternative<BodiesOfNote>(kept) &&
                             shells_[c].box.diagonal() < small_cavity * largest().box.diagonal();
      if (is_filled || !has_body) reasons[c] = is_filled ? RepairKind::FilledCavity : RepairKind::DroppedSpeck;
    }
    return reasons;
  }

 private:
  bool is_cavity(const Shell& shell) const {
    return !shell.open && shell.volume < 0 && std::any_of(shells_.begin(), shells_.end(), [&](const Shell& other) {
      return &other != &shell && contains(other.box, shell.box) && other.area > shell.area;
    });
  }

  bool is_within(std::size_t inner, std::size_t outer) const {
    return contains(shells_[outer].box, shells_[inner].box);
  }

  const Shell& largest() const { return shells_[bodies_[0]]; }

  // Of the i-th largest body.
  bool stays(std::size_t, AllBodies) const { return true; }
  bool stays(std::size_t i, LargestBodies rule) const { return i < rule.count; }
  bool stays(std::size_t i, BodiesAbove rule) const { return shells_[bodies_[i]].box.diagonal() >= rule.diagonal; }
  bool stays(std::size_t i, BodiesOfNote) const {
    const Shell &body = shells_[bodies_[i]], &whole = largest();
    const bool holds_volume = !body.open && !whole.open;
    const double content = holds_volume ? std::abs(body.volume) : std::pow(body.area, 1.5);
    const double of_whole = holds_volume ? std::abs(whole.volume) : std::pow(whole.area, 1.5);
    return body.box.diagonal() >= small_size * whole.box.diagonal() || content >= small_content * of_whole;
  }

  std::vector<Shell> shells_;
  std::vector<std::size_t> bodies_, cavities_;  // bodies by falling area
};

}  // namespace

void drop_debris(SurfaceMesh& mesh, const KeptBodies& kept, RepairResult& result) {
  std::vector<Shell> shells = find_shells(mesh, true);
  if (shells.size() < 2 || std::holds_alternative<AllBodies>(kept)) return;
  const auto reasons = Choice(shells).reasons(kept);
  drop_shells(mesh, shells, reasons, result);
}

}  // namespace scan2fea
