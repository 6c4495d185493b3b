#include "preproc/surface/thinning/facet_chain.hpp"

#include <algorithm>
#include <array>
#include <cstdlib>
#include <span>

namespace scan2fea {
namespace {

// The facets about each corner.
class Stars {
 public:
  explicit Stars(const std::vector<Facet>& facets) {
    for (const Facet& facet : facets) begin_.resize(std::max<std::size_t>(begin_.size(), facet.corners[2] + 2), 0);
    for (const Facet& facet : facets)
      for (const std::uint32_t c : facet.corners) ++begin_[c + 1];
    for (std::size_t c = 1; c < begin_.size(); ++c) begin_[c] += begin_[c - 1];
    facets_.resize(3 * facets.size());
    std::vector<std::size_t> next = begin_;
    for (std::uint32_t f = 0; f < facets.size(); ++f)
      for (const std::uint32_t c : facets[f].corners) facets_[next[c]++] = f;
  }
  std::span<const std::uint32_t> of(std::uint32_t corner) const {
    return {facets_.data() + begin_[corner], facets_.data() + begin_[corner + 1]};
  }

 private:
  std::vector<std::size_t> begin_;
  std::vector<std::uint32_t> facets_;
};

bool has(const Facet& facet, std::uint32_t corner) {
  return std::ranges::find(facet.corners, corner) != facet.corners.end();
}

class Straightening {
 public:
  explicit Straightening(std::vector<Facet>& facets) : facets_(facets), stars_(facets) {}

  // Until nothing becomes less; each time there are fewer turns, so that it ends.
  void run() {
    bool changed = true;
    while (changed) {
      changed = false;
      for (std::uint32_t f = 0; f < facets_.size(); ++f)
        if (is_folded(facets_[f]) && straighten(facets_[f])) changed = true;
    }
  }

 private:
  // Passed through twice, or at an edge of more than two.
  bool is_folded(const Facet& facet) const {
    if (facet.turns == 0) return false;
    if (std::abs(facet.turns) > 1) return true;
    for (std::size_t k = 0; k < 3; ++k) {
      std::int32_t about = 0;
      for (const std::uint32_t f : stars_.of(facet.corners[k]))
        if (has(facets_[f], facet.corners[(k + 1) % 3])) about += std::abs(facets_[f].turns);
      if (about > 2) return true;
    }
    return false;
  }

  bool straighten(const Facet& facet) {
    const Triangle corners = facet.corners;
    bool changed = false;
    for (const std::uint32_t corner : corners)
      for (const std::uint32_t f : stars_.of(corner)) {
        if (shared_corners(facets_[f].corners, corners) != 2) continue;
        for (const std::uint32_t apex : facets_[f].corners)
          if (std::ranges::find(corners, apex) == corners.end() && add_border_of(corners, apex)) changed = true;
      }
    return changed;
  }

  static std::size_t shared_corners(const Triangle& a, const Triangle& b) {
    return static_cast<std::size_t>(
        std::ranges::count_if(a, [&](std::uint32_t c) { return std::ranges::find(b, c) != b.end(); }));
  }

  // Whether there is a multiple of it that leaves fewer turns.
  bool add_border_of(const Triangle& corners, std::uint32_t apex) {
    std::array<std::uint32_t, 4> tetrahedron{corners[0], corners[1], corners[2], apex};
    std::ranges::sort(tetrahedron);
    std::array<Facet*, 4> faces{};  // without the first corner, the second, ...: with signs that alternate
    for (std::size_t k = 0; k < 4; ++k) {
      Triangle face{};
      for (std::size_t i = 0, n = 0; i < 4; ++i)
        if (i != k) face[n++] = tetrahedron[i];
      faces[k] = find(face);
      if (faces[k] == nullptr) return false;
    }
    const auto turns_with = [&](std::int32_t times) {
      std::int32_t sum = 0;
      for (std::size_t k = 0; k < 4; ++k) sum += std::abs(faces[k]->turns + (k % 2 == 0 ? times : -times));
      return sum;
    };
    const std::int32_t before = turns_with(0);
    for (const std::int32_t times : {-1, 1}) {
      if (turns_with(times) >= before) continue;
      for (std::size_t k = 0; k < 4; ++k) faces[k]->turns += k % 2 == 0 ? times : -times;
      return true;
    }
    return false;
  }

  Facet* find(const Triangle& corners) {
    const auto found = std::ranges::lower_bound(facets_, corners, {}, &Facet::corners);
    return found != facets_.end() && found->corners == corners ? &*found : nullptr;
  }

  std::vector<Facet>& facets_;
  Stars stars_;
};

}  // namespace

void FacetChain::add(const Triangle& corners, std::uint32_t number) {
  Facet facet{corners, 1, number};
  const auto order = [&](std::size_t i, std::size_t j) {
    if (facet.corners[i] < facet.corners[j]) return;
    std::swap(facet.corners[i], facet.corners[j]);
    facet.turns = -facet.turns;
  };
  order(0, 1);
  order(1, 2);
  order(0, 1);
  facets_.push_back(facet);
  // Sorting what is there again and again costs little more than sorting it once if it has doubled each time.
  constexpr std::size_t smallest = 1U << 20;
  if (facets_.size() >= std::max(smallest, 2 * when_compact_)) compact();
}

void FacetChain::compact() {
  std::ranges::stable_sort(facets_, {}, &Facet::corners);
  std::size_t last = 0;
  for (std::size_t i = 1; i < facets_.size(); ++i) {
    if (facets_[i].corners == facets_[last].corners) {
      facets_[last].turns += facets_[i].turns;
      facets_[last].first = std::min(facets_[last].first, facets_[i].first);
    } else {
      facets_[++last] = facets_[i];
    }
  }
  if (!facets_.empty()) facets_.resize(last + 1);
  when_compact_ = facets_.size();
}

void FacetChain::straighten() {
  compact();
  Straightening(facets_).run();
}

}  // namespace scan2fea
