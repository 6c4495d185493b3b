// A priority queue of small integers whose members can be removed and re-keyed, smallest key first.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace scan2fea {

// Members are 0 .. capacity - 1. Equal keys come out in the order of the members, so that the order is total and the
// same everywhere. Four children a node: shallower than a binary heap, and the children share a cache line.
// push, remove, pop: O(log n).
class IndexedHeap {
 public:
  using Member = std::uint32_t;

  explicit IndexedHeap(std::size_t capacity) : place_(capacity, absent) {}

  bool empty() const { return nodes_.empty(); }
  std::size_t size() const { return nodes_.size(); }
  bool contains(Member m) const { return place_[m] != absent; }
  Member top() const { return nodes_.front().member; }
  double top_key() const { return nodes_.front().key; }

  void push(Member m, double key) {
    place_[m] = static_cast<std::uint32_t>(nodes_.size());
    nodes_.push_back({key, m});
    rise(nodes_.size() - 1);
  }

  void remove(Member m) {
    const std::size_t hole = place_[m];
    place_[m] = absent;
    const Node last = nodes_.back();
    nodes_.pop_back();
    if (hole == nodes_.size()) return;
    nodes_[hole] = last;
    place_[last.member] = static_cast<std::uint32_t>(hole);
    rise(hole);
    sink(place_[last.member]);
  }

  Member pop() {
    const Member m = top();
    remove(m);
    return m;
  }

 private:
  struct Node {
    double key;
    Member member;
    bool operator<(const Node& other) const { return key < other.key || (key == other.key && member < other.member); }
  };
  static constexpr std::uint32_t absent = ~0U;

  void put(std::size_t i, const Node& node) {
    nodes_[i] = node;
    place_[node.member] = static_cast<std::uint32_t>(i);
  }

  void rise(std::size_t i) {
    const Node node = nodes_[i];
    while (i > 0) {
      const std::size_t parent = (i - 1) / 4;
      if (!(node < nodes_[parent])) break;
      put(i, nodes_[parent]);
      i = parent;
    }
    put(i, node);
  }

  void sink(std::size_t i) {
    const Node node = nodes_[i];
    while (true) {
      const std::size_t first = 4 * i + 1, end = std::min(first + 4, nodes_.size());
      if (first >= end) break;
      std::size_t least = first;
      for (std::size_t child = first + 1; child < end; ++child)
        if (nodes_[child] < nodes_[least]) least = child;
      if (!(nodes_[least] < node)) break;
      put(i, nodes_[least]);
      i = least;
    }
    put(i, node);
  }

  std::vector<Node> nodes_;
  std::vector<std::uint32_t> place_;  // of each member in nodes_
};

}  // namespace scan2fea
