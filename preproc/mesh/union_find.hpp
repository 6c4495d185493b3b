// Disjoint sets over [0, n).
#pragma once

#include <cstdint>
#include <numeric>
#include <utility>
#include <vector>

namespace scan2fea {

// The root of a set is always its smallest member, so that results do not depend on the order of the unions. Path
// halving keeps trees shallow: nearly linear in practice, O(log n) amortised per call.
class UnionFind {
 public:
  explicit UnionFind(std::size_t n) : parent_(n) { std::iota(parent_.begin(), parent_.end(), 0U); }

  std::uint32_t find(std::uint32_t i) {
    while (parent_[i] != i) {
      parent_[i] = parent_[parent_[i]];
      i = parent_[i];
    }
    return i;
  }

  // Returns the root of the joint set.
  std::uint32_t unite(std::uint32_t i, std::uint32_t j) {
    i = find(i);
    j = find(j);
    if (j < i) std::swap(i, j);
    parent_[j] = i;
    return i;
  }

 private:
  std::vector<std::uint32_t> parent_;
};

}  // namespace scan2fea
