// Arrays of numbers as the page carries them: one compressed text, and where each array is in it.
//
// Numbers of 16 and 32 bits are written byte by byte, all first bytes and then all second ones, which compresses
// better. Indices are written as differences to those of the element before, with the sign in the lowest bit.
#pragma once

#include <nlohmann/json.hpp>

#include <cstdint>
#include <span>
#include <string>
#include <string_view>

namespace scan2fea {

class PackedArrays {
 public:
  void add(const std::string& name, std::span<const std::uint8_t> values);
  void add(const std::string& name, std::span<const std::uint16_t> values);
  // So many to an element; `values` has all of them, one element after the other.
  void add_indices(const std::string& name, std::span<const std::uint32_t> values, std::size_t per_element);

  // {name: {kind: "u8" | "u16" | "indices", at: byte, count, per_element}}
  const nlohmann::json& directory() const { return directory_; }
  std::string text() const;  // deflated, in base64

 private:
  void note(const std::string& name, const char* kind, std::size_t count, std::size_t per_element = 1);

  std::string bytes_;
  nlohmann::json directory_ = nlohmann::json::object();
};

}  // namespace scan2fea
