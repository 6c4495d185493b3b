#include "preproc/mesh/vertex_welder.hpp"

#include "preproc/mesh/error.hpp"

#include <bit>
#include <limits>

namespace scan2fea {
namespace {

constexpr std::uint32_t no_vertex = std::numeric_limits<std::uint32_t>::max();

// -0 and 0 are equal and must hash alike.
Vec3 without_negative_zero(const Vec3& point) {
  return point + Vec3::Zero();
}

// Floats written as doubles differ in their upper bits only, and the slot is chosen by the lower ones: each product
// carries all bits upwards, each shift brings them down.
std::uint64_t hash(const Vec3& point) {
  std::uint64_t h = 0;
  for (const double coordinate : point) {
    h = (h ^ std::bit_cast<std::uint64_t>(coordinate)) * 0x9e3779b97f4a7c15u;
    h ^= h >> 32;
  }
  return h;
}

std::uint32_t tag_of(std::uint64_t h) {
  return static_cast<std::uint32_t>(h >> 32);
}

std::size_t slots_for(std::size_t vertices) {
  return std::bit_ceil(vertices + vertices / 3 + 16);
}

}  // namespace

VertexWelder::VertexWelder(std::size_t expected) : slots_(slots_for(expected), Slot{0, no_vertex}) {
  vertices_.reserve(expected);
}

std::uint32_t VertexWelder::add(const Vec3& point) {
  const Vec3 key = without_negative_zero(point);
  const std::uint64_t h = hash(key);
  const std::size_t mask = slots_.size() - 1;
  std::size_t at = h & mask;
  for (; slots_[at].vertex != no_vertex; at = (at + 1) & mask)
    if (slots_[at].tag == tag_of(h) && vertices_[slots_[at].vertex] == key) return slots_[at].vertex;

  if (vertices_.size() == no_vertex)
    throw InvalidInput({"too many vertices", {}, {}, std::to_string(no_vertex), "parts of the scan"});
  const auto added = static_cast<std::uint32_t>(vertices_.size());
  slots_[at] = {tag_of(h), added};
  vertices_.push_back(key);
  if (vertices_.size() > slots_.size() / 4 * 3) grow();
  return added;
}

void VertexWelder::prefetch(const Vec3& point) const {
  __builtin_prefetch(&slots_[hash(without_negative_zero(point)) & (slots_.size() - 1)]);
}

void VertexWelder::grow() {
  slots_.assign(2 * slots_.size(), Slot{0, no_vertex});
  const std::size_t mask = slots_.size() - 1;
  for (std::uint32_t vertex = 0; vertex < vertices_.size(); ++vertex) {
    const std::uint64_t h = hash(vertices_[vertex]);
    std::size_t at = h & mask;
    while (slots_[at].vertex != no_vertex) at = (at + 1) & mask;
    slots_[at] = {tag_of(h), vertex};
  }
}

}  // namespace scan2fea
