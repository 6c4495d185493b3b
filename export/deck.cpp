#include "export/deck.hpp"

#include "export/aster_mail.hpp"
#include "export/deck_parts.hpp"
#include "export/inp.hpp"
#include "export/med.hpp"
#include "preproc/mesh/error.hpp"
#include "preproc/mesh/error_text.hpp"
#include "preproc/mesh/file_extension.hpp"
#include "preproc/mesh/length_unit.hpp"
#include "preproc/mesh/union_find.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <iterator>

namespace scan2fea {
namespace {

constexpr std::array<std::string_view, 2> needed{"fixed", "loaded"};

DeckUnits units_of(const std::string& unit, const std::string& file) {
  constexpr double pound_force = 4.4482216152605;  // newtons, by definition
  const auto units = [&](std::string force, double newtons, std::string mass, std::string stress) {
    return DeckUnits{unit, std::move(force), std::move(mass), std::move(stress), newtons, metres(unit)};
  };
  if (unit == "um") return units("uN", 1e-6, "kg", "MPa");
  if (unit == "mm") return units("N", 1, "t", "MPa");
  if (unit == "cm") return units("dyn", 1e-5, "g", "dyn/cm2");
  if (unit == "m") return units("N", 1, "kg", "Pa");
  if (unit == "in") return units("lbf", pound_force, "lbf s2/in", "psi");
  if (unit == "ft") return units("lbf", pound_force, "slug", "psf");
  throw WrongUsage({.what = "a deck needs the unit of length, by which its material is given",
                    .where = file,
                    .value = unit.empty() ? "the file says none" : unit,
                    .limit = {},
                    .advice = "--unit mm, or another of " + std::string(known_length_units)});
}

[[noreturn]] void fail_set(const std::string& what, std::string_view name, const std::string& file,
                           const std::string& advice) {
  throw WrongUsage({.what = what, .where = file, .value = std::string(name), .limit = {}, .advice = advice});
}

DeckSet find_fixed(const TetMesh& mesh, const WrittenNames& names, const std::string& file) {
  const std::size_t f = find_set(mesh.face_sets, needed[0]), n = find_set(mesh.node_sets, needed[0]);
  if (f < mesh.face_sets.size() && !mesh.face_sets[f].members.empty()) return {names.faces[f], true};
  if (n < mesh.node_sets.size() && !mesh.node_sets[n].members.empty()) return {names.nodes[n], false};
  fail_set("a deck needs a set that is not there or empty", needed[0], file, "--set fixed=...");
}

void find_loaded(const TetMesh& mesh, const WrittenNames& names, const std::string& file, DeckParts& parts) {
  const std::size_t s = find_set(mesh.face_sets, needed[1]);
  if (s == mesh.face_sets.size() || mesh.face_sets[s].members.empty()) {
    if (find_set(mesh.node_sets, needed[1]) < mesh.node_sets.size())
      fail_set("a pressure needs a set of faces, and this one is of nodes", needed[1], file, "a set of faces");
    fail_set("a deck needs a set of faces that is not there or empty", needed[1], file, "--set loaded=...");
  }
  parts.loaded = names.faces[s];
  for (const std::uint32_t f : mesh.face_sets[s].members) {
    parts.loaded_area += face_area(mesh, mesh.boundary[f]);
    parts.loaded_normal += face_vector_area(mesh, mesh.boundary[f]);
  }
}

// Of the set of faces of this name, or of nodes where there is none.
std::vector<std::uint32_t> nodes_of_set(const TetMesh& mesh, std::string_view name) {
  const std::size_t f = find_set(mesh.face_sets, name);
  if (f < mesh.face_sets.size() && !mesh.face_sets[f].members.empty())
    return nodes_of_faces(mesh, mesh.face_sets[f].members);
  return mesh.node_sets[find_set(mesh.node_sets, name)].members;
}

void count_shared_nodes(const TetMesh& mesh, DeckParts& parts) {
  std::vector<std::uint32_t> shared;
  std::ranges::set_intersection(nodes_of_set(mesh, needed[0]), nodes_of_set(mesh, needed[1]),
                                std::back_inserter(shared));
  parts.shared_nodes = shared.size();
}

// A part that nothing holds and that shares no node with one that is held: solvers give displacements of any size.
void require_held(const TetMesh& mesh, const std::string& file) {
  UnionFind joined(mesh.nodes.size());
  for (const Tetrahedron& t : mesh.tetrahedra)
    for (const std::uint32_t v : t) joined.unite(t[0], v);
  std::vector<bool> is_held(mesh.nodes.size(), false);
  for (const std::uint32_t v : nodes_of_set(mesh, needed[0])) is_held[joined.find(v)] = true;
  for (const Tetrahedron& t : mesh.tetrahedra)
    if (!is_held[joined.find(t[0])]) {
      ErrorParts parts{.what = "a part of the mesh is not held by the set",
                       .where = file,
                       .value = std::string(needed[0]),
                       .limit = {},
                       .advice = "a set fixed that has faces of each part, or --deck modal"};
      parts.at = mesh.nodes[t[0]];
      throw WrongUsage(std::move(parts));
    }
}

void find_bodies(const TetMesh& mesh, const WrittenNames& names, DeckParts& parts) {
  DisjointSets bodies = disjoint_sets(mesh.element_sets, mesh.tetrahedra.size());
  for (const std::size_t s : bodies.disjoint) parts.bodies.push_back(names.elements[s]);
  for (const std::size_t s : bodies.overlapping) parts.no_bodies.push_back(names.elements[s]);
  if (!parts.bodies.empty()) parts.other = std::move(bodies.rest);
}

WrittenNames names_in(const TetMesh& mesh, const std::string& extension, const std::string& prefix) {
  TetMesh prefixed;  // of which the sets alone are needed
  prefixed.node_sets = mesh.node_sets;
  prefixed.face_sets = mesh.face_sets;
  prefixed.element_sets = mesh.element_sets;
  put_prefix(prefix, prefixed);
  Notes notes;  // the mesh's writer tells them
  if (extension == ".inp") return names_in_inp(prefixed, prefix, notes);
  return extension == ".med" ? names_in_med(prefixed, prefix, notes) : names_in_mail(prefixed, prefix, notes);
}

std::string text_of(const Vec3& v) {
  return "(" + deck_number(v.x()) + ", " + deck_number(v.y()) + ", " + deck_number(v.z()) + ")";
}

// Like none of those that the file has.
std::string free_name(const std::string& wish, const std::vector<std::string>& taken) {
  Notes notes;
  return names_for(std::array{NamedSet{wish, {}}}, {}, taken, notes)[0];
}

}  // namespace

std::string deck_number(double value) {
  std::string text = error_text(value);
  if (text.find_first_of(".e") == std::string::npos) text += ".0";
  return text;
}

std::vector<std::string> load_remarks(const DeckParts& parts) {
  const double pressure = parts.units.of_stress(deck_pressure), whole = pressure * parts.loaded_area;
  const Vec3 force = -pressure * parts.loaded_normal;
  std::vector<std::string> remarks{
      "Its area is " + deck_number(parts.loaded_area) + " " + parts.units.length +
          "2; the resultant of the pressure is",
      text_of(force) + " " + parts.units.force + ", and the reactions sum to its opposite."};
  constexpr double balanced = 0.01;  // of a bore that is closed around its axis
  if (force.norm() < balanced * whole)
    remarks.emplace_back(
        "It is almost nothing, since the set faces all ways: this pressure widens, and does not push.");
  if (parts.shared_nodes > 0)
    remarks.push_back("It is in part on " + std::to_string(parts.shared_nodes) +
                      " nodes that are fixed, where a solver may leave it out of the sum.");
  return remarks;
}

std::filesystem::path deck_file(const std::filesystem::path& mesh_file, DeckKind kind) {
  const std::string extension = lower_case_extension(mesh_file);
  const bool of_calculix = extension == ".inp";
  if (!of_calculix && extension != ".med" && extension != ".mail")
    throw WrongUsage({.what = "there is no deck for this format",
                      .where = mesh_file.string(),
                      .value = extension,
                      .limit = {},
                      .advice = ".inp (CalculiX, Abaqus), .med or .mail (Code_Aster)"});
  const std::string name = mesh_file.filename().string();
  const bool is_includable = std::none_of(name.begin(), name.end(), [](unsigned char c) {
    return std::isspace(c) != 0 || c == ',';  // which CalculiX removes, or ends the name at
  });
  if (of_calculix && !is_includable)
    throw WrongUsage({.what = "CalculiX includes no file whose name has a blank or comma",
                      .where = mesh_file.string(),
                      .value = {},
                      .limit = {},
                      .advice = "another name"});
  std::filesystem::path file = mesh_file;
  file.replace_filename(mesh_file.stem().string() + (kind == DeckKind::modal ? "_modal" : "_static") +
                        (of_calculix ? ".inp" : ".comm"));
  return file;
}

std::span<const std::string_view> sets_of_deck(DeckKind kind) {
  return std::span(needed).first(kind == DeckKind::modal ? 1 : 2);
}

std::string deck_text(const TetMesh& mesh, const std::filesystem::path& mesh_file, DeckKind kind,
                      const FileOptions& options) {
  const std::string file = mesh_file.string(), extension = lower_case_extension(mesh_file);
  const WrittenNames names = names_in(mesh, extension, options.set_prefix);
  DeckParts parts{.mesh_file = mesh_file.filename().string(),
                  .kind = kind,
                  .prefix = options.set_prefix,
                  .numbers = options.numbers,
                  .units = units_of(mesh.unit, file),
                  .fixed = find_fixed(mesh, names, file),
                  .fixed_nodes = free_name(options.set_prefix + "FIXED_N", names.nodes),
                  .loaded = {},
                  .bodies = {},
                  .no_bodies = {},
                  .other = {},
                  .other_name = free_name(options.set_prefix + "OTHER", names.elements)};
  if (kind == DeckKind::static_analysis) {
    require_held(mesh, file);
    find_loaded(mesh, names, file, parts);
    count_shared_nodes(mesh, parts);
  }
  find_bodies(mesh, names, parts);
  return extension == ".inp" ? calculix_deck(parts) : aster_deck(parts);
}

}  // namespace scan2fea
