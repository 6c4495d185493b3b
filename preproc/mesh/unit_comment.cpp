#include "preproc/mesh/unit_comment.hpp"

#include <cctype>

namespace scan2fea {
namespace {

constexpr std::string_view mark = "unit of length: ";

}  // namespace

std::string unit_comment(std::string_view unit) {
  return std::string(mark) + std::string(unit);
}

std::optional<std::string> unit_in_comment(std::string_view line) {
  const std::size_t at = line.find(mark);
  if (at == std::string_view::npos) return {};
  std::string unit;
  for (const char c : line.substr(at + mark.size())) {
    if (std::isalpha(static_cast<unsigned char>(c)) == 0) break;
    unit += c;
  }
  if (unit.empty()) return {};
  return unit;
}

}  // namespace scan2fea
