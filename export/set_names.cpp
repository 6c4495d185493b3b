#include "export/set_names.hpp"

#include <algorithm>
#include <cctype>
#include <map>
#include <numeric>
#include <set>

namespace scan2fea {
namespace {

std::string upper(std::string_view text) {
  std::string result(text);
  std::transform(result.begin(), result.end(), result.begin(),
                 [](unsigned char c) { return static_cast<char>(std::toupper(c)); });
  return result;
}

std::string allowed_form(const std::string& name, const NameRules& rules) {
  std::string text = rules.upper_case ? upper(name) : name;
  for (char& c : text) {
    const auto byte = static_cast<unsigned char>(c);
    if (byte >= 0x80 || (std::isalnum(byte) == 0 && rules.allowed.find(c) == std::string_view::npos)) c = '_';
  }
  if (rules.starts_with_letter && (text.empty() || std::isalpha(static_cast<unsigned char>(text.front())) == 0))
    text = std::string("S_").append(text);
  return text.substr(0, rules.longest);
}

}  // namespace

bool is_reserved_set(std::string_view name) {
  const std::string text = upper(name);
  return text == "NALL" || text == "EALL" || text == "SALL" || text == "SALL_NODES" ||
         (text.size() == 7 && text.starts_with("SALL_S") && text[6] >= '1' && text[6] <= '4');
}

bool is_whole_set(std::string_view name, std::string_view prefix) {
  return upper(name.substr(0, prefix.size())) == upper(prefix) && is_reserved_set(name.substr(prefix.size()));
}

std::vector<std::string> names_for(std::span<const NamedSet> sets, const NameRules& rules,
                                   std::span<const std::string> taken, std::vector<std::string>& warnings) {
  std::set<std::string> used;
  for (const std::string& name : taken) used.insert(upper(name));
  std::vector<std::string> names;
  for (const NamedSet& set : sets) {
    const std::string allowed = allowed_form(set.name, rules);
    std::string name = allowed;
    for (int n = 2; (is_reserved_set(name) && !rules.keeps_reserved) || used.contains(upper(name)); ++n) {
      const std::string number = "_" + std::to_string(n);
      name = allowed.substr(0, rules.longest - number.size()) + number;
    }
    used.insert(upper(name));
    if (upper(name) != upper(set.name)) warnings.push_back("set " + set.name + " is named " + name + " in the file");
    names.push_back(std::move(name));
  }
  return names;
}

void put_prefix(const std::string& prefix, TetMesh& mesh) {
  for (auto* sets : {&mesh.node_sets, &mesh.face_sets, &mesh.element_sets})
    for (NamedSet& set : *sets) set.name.insert(0, prefix);
}

void put_prefix(const std::string& prefix, NamedSurface& surface) {
  for (auto* sets : {&surface.node_sets, &surface.face_sets})
    for (NamedSet& set : *sets) set.name.insert(0, prefix);
}

std::vector<std::string> taken_with_prefix(const std::string& prefix) {
  std::vector<std::string> names;
  if (!prefix.empty())
    for (const char* name : {"NALL", "EALL", "SALL", "SALL_NODES", "SALL_S1", "SALL_S2", "SALL_S3", "SALL_S4"})
      names.push_back(prefix + name);
  return names;
}

TetMesh with_whole_sets(const TetMesh& mesh, const std::string& prefix, std::vector<std::string>& notes) {
  TetMesh whole = mesh;
  const auto add = [&](std::vector<NamedSet>& sets, const char* unprefixed, std::size_t members) {
    const std::string name = prefix + unprefixed;
    for (NamedSet& set : sets) {
      if (!is_reserved_set(set.name) && upper(set.name) != upper(name)) continue;
      notes.push_back("set " + set.name + " is named " + set.name + "_2 in the file");
      set.name += "_2";
    }
    NamedSet& all = sets.emplace_back();
    all.name = name;
    all.members.resize(members);
    std::iota(all.members.begin(), all.members.end(), 0U);
  };
  add(whole.node_sets, "NALL", mesh.nodes.size());
  add(whole.face_sets, "SALL", mesh.outer_faces());
  add(whole.element_sets, "EALL", mesh.tetrahedra.size());
  return whole;
}

SetParts set_parts(std::span<const NamedSet> sets, std::size_t members) {
  std::vector<std::vector<std::uint32_t>> of_member(members);
  for (std::uint32_t s = 0; s < sets.size(); ++s)
    for (const std::uint32_t m : sets[s].members) of_member[m].push_back(s);
  std::map<std::vector<std::uint32_t>, std::uint32_t> numbers{{{}, 0}};
  for (const auto& of : of_member) numbers.emplace(of, 0);
  SetParts parts;
  for (auto& [of, number] : numbers) {
    number = static_cast<std::uint32_t>(parts.of.size());
    parts.of.push_back(of);
  }
  parts.part.reserve(members);
  for (const auto& of : of_member) parts.part.push_back(numbers.at(of));
  return parts;
}

DisjointSets disjoint_sets(std::span<const NamedSet> sets, std::size_t members) {
  DisjointSets found;
  std::vector<bool> taken(members, false);
  for (std::size_t s = 0; s < sets.size(); ++s) {
    const std::vector<std::uint32_t>& own = sets[s].members;
    if (own.empty()) continue;
    const bool overlaps = std::any_of(own.begin(), own.end(), [&](std::uint32_t m) { return taken[m]; });
    (overlaps ? found.overlapping : found.disjoint).push_back(s);
    if (overlaps) continue;
    for (const std::uint32_t m : own) taken[m] = true;
  }
  for (std::uint32_t m = 0; m < members; ++m)
    if (!taken[m]) found.rest.push_back(m);
  return found;
}

std::string part_name(const SetParts& parts, std::size_t part, std::span<const std::string> names) {
  std::string name;
  for (const std::uint32_t s : parts.of[part]) name += (name.empty() ? "" : std::string(1, part_name_joint)) + names[s];
  return name;
}

std::vector<std::string> split_part_name(std::string_view name) {
  std::vector<std::string> names;
  for (;;) {
    const std::size_t joint = name.find(part_name_joint);
    names.emplace_back(name.substr(0, joint));
    if (joint == std::string_view::npos) return names;
    name.remove_prefix(joint + 1);
  }
}

}  // namespace scan2fea
