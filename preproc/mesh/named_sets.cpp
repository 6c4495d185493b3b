#include "preproc/mesh/named_sets.hpp"

#include <algorithm>
#include <cctype>
#include <limits>

namespace scan2fea {
namespace {

constexpr std::uint32_t none = std::numeric_limits<std::uint32_t>::max();

bool same_name(std::string_view a, std::string_view b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                    [](unsigned char x, unsigned char y) { return std::toupper(x) == std::toupper(y); });
}

void sort_once(std::vector<std::uint32_t>& members) {
  std::sort(members.begin(), members.end());
  members.erase(std::unique(members.begin(), members.end()), members.end());
}

}  // namespace

NamedSet named_set(std::string name, std::vector<std::uint32_t> members) {
  sort_once(members);
  return {std::move(name), std::move(members)};
}

std::size_t find_set(std::span<const NamedSet> sets, std::string_view name) {
  const auto found = std::find_if(sets.begin(), sets.end(), [&](const NamedSet& s) { return same_name(s.name, name); });
  return static_cast<std::size_t>(found - sets.begin());
}

std::size_t find_or_add_set(std::vector<NamedSet>& sets, std::string_view name) {
  const std::size_t i = find_set(sets, name);
  if (i == sets.size()) sets.push_back({std::string(name), {}});
  return i;
}

std::vector<NamedSet> carried_sets(std::span<const NamedSet> sets, std::span<const std::uint32_t> origin) {
  std::uint32_t most = 0;
  for (const std::uint32_t o : origin)
    if (o != none) most = std::max(most, o);
  std::vector<NamedSet> carried;
  std::vector<bool> is_member(origin.empty() ? 0 : std::size_t{most} + 1);
  for (const NamedSet& set : sets) {
    is_member.assign(is_member.size(), false);
    for (const std::uint32_t m : set.members)
      if (m < is_member.size()) is_member[m] = true;
    NamedSet& made = carried.emplace_back();
    made.name = set.name;
    for (std::uint32_t i = 0; i < origin.size(); ++i)
      if (origin[i] < is_member.size() && is_member[origin[i]]) made.members.push_back(i);
  }
  return carried;
}

std::vector<std::uint32_t> vertices_of_faces(const SurfaceMesh& mesh, std::span<const std::uint32_t> faces) {
  std::vector<std::uint32_t> vertices;
  vertices.reserve(3 * faces.size());
  for (const std::uint32_t f : faces)
    for (const std::uint32_t v : mesh.triangles[f]) vertices.push_back(v);
  sort_once(vertices);
  return vertices;
}

}  // namespace scan2fea
