// The names of an enum's values, as the command line and reports have them: one table that is read both ways.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string_view>
#include <utility>

namespace scan2fea {

template <class Value, std::size_t size>
using NameTable = std::array<std::pair<Value, std::string_view>, size>;

// Empty for a value that is not in the table.
template <class Value, std::size_t size>
constexpr std::string_view name_in(const NameTable<Value, size>& table, Value value) {
  for (const auto& [known, name] : table)
    if (known == value) return name;
  return {};
}

template <class Value, std::size_t size>
constexpr std::optional<Value> value_in(const NameTable<Value, size>& table, std::string_view name) {
  for (const auto& [value, known] : table)
    if (known == name) return value;
  return std::nullopt;
}

}  // namespace scan2fea
