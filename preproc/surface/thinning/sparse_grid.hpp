// Numbers for the few cells of a large grid that a surface goes through.
#pragma once

#include "preproc/mesh/splitmix64.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

namespace scan2fea {

// In blocks of 4 x 4 x 4 cells, so that cells beside one another are mostly beside one another in memory, too: a hash
// of single cells has a surface's neighbours wait for memory one by one. About 15 bytes a cell that holds a number.
class SparseGrid {
 public:
  static constexpr std::uint32_t none = std::numeric_limits<std::uint32_t>::max();
  using Place = std::array<std::uint32_t, 3>;  // of a cell: each below 2^23

  SparseGrid() : slots_(1U << 12, Slot{0, none}) {}

  // The place's number, which may be set; `none` at first.
  std::uint32_t& at(const Place& place) {
    std::size_t slot = slot_of(key_of(place));
    if (slots_[slot].block == none) {
      slots_[slot] = {key_of(place), static_cast<std::uint32_t>(blocks_.size())};
      blocks_.emplace_back().fill(none);
      if (2 * blocks_.size() > slots_.size()) {
        grow();
        slot = slot_of(key_of(place));
      }
    }
    return blocks_[slots_[slot].block][in_block(place)];
  }
  std::uint32_t find(const Place& place) const {
    const Slot& slot = slots_[slot_of(key_of(place))];
    return slot.block == none ? none : blocks_[slot.block][in_block(place)];
  }

 private:
  struct Slot {
    std::uint64_t key;
    std::uint32_t block;
  };

  static std::uint64_t key_of(const Place& place) {
    constexpr int bits = 21;
    return (((std::uint64_t{place[0] >> 2} << bits) | (place[1] >> 2)) << bits) | (place[2] >> 2);
  }
  static std::size_t in_block(const Place& place) {
    return ((place[0] & 3) << 4) | ((place[1] & 3) << 2) | (place[2] & 3);
  }
  // Of the key, or the free one where it is to go.
  std::size_t slot_of(std::uint64_t key) const {
    const std::size_t last = slots_.size() - 1;
    std::size_t slot = splitmix64(key) & last;
    while (slots_[slot].block != none && slots_[slot].key != key) slot = (slot + 1) & last;
    return slot;
  }
  void grow() {
    const std::vector<Slot> before = std::move(slots_);
    slots_.assign(2 * before.size(), Slot{0, none});
    for (const Slot& slot : before)
      if (slot.block != none) slots_[slot_of(slot.key)] = slot;
  }

  std::vector<Slot> slots_;  // open addressing, at most half full; a power of two of them
  std::vector<std::array<std::uint32_t, 64>> blocks_;
};

}  // namespace scan2fea
