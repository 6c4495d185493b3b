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

}  // namespace

std::vector<std::string> body_names(std::vector<std::string> given) {
  std::vector<NamedSet> sets;
  for (std::string& name : given) sets.push_back({std::move(name), {}});
  std::vector<std::string> changes;
  return names_for(sets, rules, {}, changes);
}

std::vector<std::string> body_names(const std::vector<std::filesystem::path>& files) {
  std::vector<std::string> names;
  for (std::filesystem::path file : files) {
    if (lower_case_extension(file) == ".gz") file.replace_extension();
    names.push_back(file.stem().string());
  }
  return body_names(std::move(names));
}

std::vector<Body> bodies_of_groups(const SurfaceMesh& surface, const std::vector<NamedSet>& sets) {
  std::vector<Body> bodies;
  if (sets.size() < 2 || !parts_all(sets, surface.triangles.size())) return bodies;
  std::vector<std::string> names;
  for (const NamedSet& set : sets) names.push_back(set.name);
  names = body_names(std::move(names));
  for (std::size_t s = 0; s < sets.size(); ++s) {
    Body& body = bodies.emplace_back(Body{names[s], part_of(surface, sets[s])});
    if (!encloses_volume(body.surface) || enclosed_volume(body.surface) <= 0) return {};
  }
  return bodies;
}

}  // namespace scan2fea::command
