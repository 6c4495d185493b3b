#include "export/formats.hpp"

#include <algorithm>

namespace scan2fea {
namespace {

std::string range(std::uint64_t from, std::uint64_t to) {
  return std::to_string(from) + ".." + std::to_string(to);
}

std::string renumbered(const char* what, const std::vector<std::uint64_t>& numbers) {
  if (numbers.empty()) return "";
  return std::string(what) + " " + range(std::ranges::min(numbers), std::ranges::max(numbers)) + " are now " +
         range(1, numbers.size());
}

}  // namespace

std::uint64_t Numbering::largest_node(std::uint64_t count) const {
  return own.nodes.empty() ? first_node + count - 1 : std::ranges::max(own.nodes);
}

std::uint64_t Numbering::largest_element(std::uint64_t count) const {
  const std::size_t numbered = own.elements.size();
  return count > numbered ? element(count - 1) : numbered == 0 ? first_element - 1 : largest_of_own;
}

Notes keep_numbers(const MeshFile& read, const std::filesystem::path& file, FileOptions& options) {
  if (!read.has_own_numbers || read.numbers.empty() || options.numbers.are_asked_for()) return {};
  const FileFormat* format = find_format(file);
  const bool as_volume = read.is_volume() && writes_volume(file);
  if (format != nullptr && as_volume == read.is_volume()) {
    const std::optional<Holdings>& holds = as_volume ? format->volume : format->surface;
    if (holds && holds->own_numbers) {
      options.numbers.own = read.numbers;
      if (!read.numbers.elements.empty()) options.numbers.largest_of_own = std::ranges::max(read.numbers.elements);
      return {};
    }
  }
  std::string what = renumbered("nodes", read.numbers.nodes);
  const std::string elements = renumbered("elements", read.numbers.elements);
  what += (what.empty() || elements.empty() ? "" : ", ") + elements;
  return {file.string() + " does not keep the numbers that the input gives: " + what};
}

}  // namespace scan2fea
