#include "quality/report_page/packed_arrays.hpp"

#include "quality/picture/deflate.hpp"

#include <vector>

namespace scan2fea {
namespace {

template <class Number>
void append_planes(std::span<const Number> values, std::string& bytes) {
  for (std::size_t shift = 0; shift < 8 * sizeof(Number); shift += 8)
    for (const Number value : values) bytes += static_cast<char>(value >> shift & 255);
}

}  // namespace

void PackedArrays::note(const std::string& name, const char* kind, std::size_t count, std::size_t per_element) {
  directory_[name] = {{"kind", kind}, {"at", bytes_.size()}, {"count", count}, {"per_element", per_element}};
}

void PackedArrays::add(const std::string& name, std::span<const std::uint8_t> values) {
  note(name, "u8", values.size());
  append_planes(values, bytes_);
}

void PackedArrays::add(const std::string& name, std::span<const std::uint16_t> values) {
  note(name, "u16", values.size());
  append_planes(values, bytes_);
}

void PackedArrays::add_indices(const std::string& name, std::span<const std::uint32_t> values,
                               std::size_t per_element) {
  note(name, "indices", values.size(), per_element);
  std::vector<std::uint32_t> differences(values.size());
  for (std::size_t i = 0; i < values.size(); ++i) {
    const std::uint32_t difference = values[i] - (i >= per_element ? values[i - per_element] : 0);
    differences[i] = difference << 1 ^ (difference >> 31 ? ~0U : 0U);
  }
  append_planes(std::span<const std::uint32_t>(differences), bytes_);
}

std::string PackedArrays::text() const {
  return base64(deflated(bytes_));
}

}  // namespace scan2fea
