#include "preproc/command/body_inputs.hpp"

#include "export/set_names.hpp"
#include "preproc/mesh/file_extension.hpp"
#include "quality/validity.hpp"

#include <algorithm>
#include <cctype>
#include <cstdint>
#include <limits>

namespace scan2fea::command {
namespace {

// As it is allowed in every format that has names.
constexpr NameRules rules{.longest = 24, .upper_case = false, .allowed = "_", .starts_with_letter = true};

SurfaceMesh part_of(const SurfaceMesh& surface, const NamedSet& set) {
  constexpr auto unused = std::numeric_limits<std::uint32_t>::max();
  std::vector<std::uint32_t> number(surface.vertices.size(), unused);
  SurfaceMesh part;
  for (const std::uint32_t f : set.members) {
    Triangle t = surface.triangles[f];
    for (std::uint32_t& v : t) {
      if (number[v] == unused) {
        number[v] = static_cast<std::uint32_t>(part.vertices.size());
        part.vertices.push_back(surface.vertices[v]);
      }
      v = number[v];
    }
    part.triangles.push_back(t);
  }
  return part;
}

bool parts_all(const std::vector<NamedSet>& sets, std::size_t triangles) {
  std::vector<bool> is_taken(triangles, false);
  std::size_t taken = 0;
  for (const NamedSet& set : sets)
    for (const std::uint32_t f : set.members) {
      if (is_taken[f]) return false;
      is_taken[f] = true;
      ++taken;
    }
  return taken == triangles;
}

std::vector<std::string> names_of_bodies(const std::vector<NamedSet>& sets, Notes& changes) {
  Notes of_sets;
  std::vector<std::string> names = names_for(sets, rules, {}, of_sets);
  for (std::size_t s = 0; s < sets.size(); ++s)
    if (names[s] != sets[s].name) changes.push_back("body '" + sets[s].name + "' is named " + names[s]);
  return names;
}

}  // namespace

std::vector<std::string> body_names(const std::vector<std::filesystem::path>& files, Notes& changes) {
  std::vector<NamedSet> sets;
  for (std::filesystem::path file : files) {
    if (lower_case_extension(file) == ".gz") file.replace_extension();
    sets.push_back({file.stem().string(), {}});
  }
  return names_of_bodies(sets, changes);
}

std::vector<Body> bodies_of_groups(const SurfaceMesh& surface, const std::vector<NamedSet>& sets, Notes& changes) {
  std::vector<Body> bodies;
  if (sets.size() < 2 || !parts_all(sets, surface.triangles.size())) return bodies;
  Notes renamed;
  const std::vector<std::string> names = names_of_bodies(sets, renamed);
  for (std::size_t s = 0; s < sets.size(); ++s) {
    Body& body = bodies.emplace_back(Body{names[s], part_of(surface, sets[s])});
    if (!encloses_volume(body.surface) || enclosed_volume(body.surface) <= 0) return {};
  }
  changes.insert(changes.end(), renamed.begin(), renamed.end());
  return bodies;
}

}  // namespace scan2fea::command
