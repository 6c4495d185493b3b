#include "export/formats.hpp"

#include "export/aster_mail.hpp"
#include "export/bdf.hpp"
#include "export/cdb.hpp"
#include "export/elmer.hpp"
#include "export/exodus.hpp"
#include "export/inp.hpp"
#include "export/med.hpp"
#include "export/msh.hpp"
#include "export/number_text.hpp"
#include "export/set_names.hpp"
#include "export/su2.hpp"
#include "export/surface_files.hpp"
#include "export/threemf.hpp"
#include "export/unv.hpp"
#include "export/vtk.hpp"
#include "export/xdmf.hpp"
#include "preproc/mesh/error.hpp"
#include "preproc/mesh/file_extension.hpp"
#include "preproc/mesh/read_surface.hpp"

#include <algorithm>
#include <array>

namespace scan2fea {
namespace {

// Of readers that keep numbers in 32 bits.
constexpr std::uint64_t largest_int = 2147483647;
constexpr Holdings all_to(std::uint64_t largest_number) {
  return {.node_sets = true,
          .face_sets = true,
          .element_sets = true,
          .unit = true,
          .second_order = true,
          .faces_between = true,
          .largest_number = largest_number,
          .own_numbers = true};
}
constexpr Holdings all = all_to(largest_int);
// Of those whose elements stand in groups, or that have names in place of numbers.
constexpr Holdings in_order = [] {
  Holdings holds = all;
  holds.own_numbers = false;
  return holds;
}();
constexpr Holdings of_nastran = all_to(99999999), of_ansys = all_to(999999999);  // eight digits, nine
constexpr Holdings of_viewers{.node_sets = true,
                              .face_sets = true,
                              .element_sets = true,
                              .unit = true,
                              .second_order = true,
                              .fields = true,
                              .faces_between = true};
// Of a surface.
constexpr Holdings of_viewers_surface{.node_sets = true, .face_sets = true, .unit = true, .fields = true};
constexpr Holdings numbered_to(std::uint64_t largest_number, bool own_numbers) {
  return {
      .node_sets = true, .face_sets = true, .unit = true, .largest_number = largest_number, .own_numbers = own_numbers};
}
constexpr Holdings numbered = numbered_to(largest_int, true), numbered_in_order = numbered_to(largest_int, false);
constexpr Holdings of_nastran_surface = numbered_to(of_nastran.largest_number, true);

constexpr Holdings only_unit{.unit = true};
constexpr Holdings of_elmer{
    .face_sets = true, .element_sets = true, .unit = true, .second_order = true, .faces_between = true};
constexpr Holdings of_su2{.face_sets = true, .unit = true};

std::vector<std::filesystem::path> other_files_of_xdmf(const std::filesystem::path& file, std::size_t) {
  return {facets_of_xdmf(file)};
}

std::vector<std::filesystem::path> other_files_of_elmer(const std::filesystem::path& header, std::size_t parts) {
  std::vector<std::filesystem::path> files;
  for (const char* name : {"mesh.nodes", "mesh.elements", "mesh.boundary", "mesh.names"})
    files.push_back(header.parent_path() / name);
  for (std::size_t part = 1; part <= parts; ++part)
    for (const std::filesystem::path& file : files_of_elmer_part(header, parts, part)) files.push_back(file);
  return files;
}

constexpr auto formats = std::to_array<FileFormat>({
    {".inp", "Abaqus, CalculiX", all, numbered, write_inp, write_inp, read_inp, as_written},
    {".msh", "Gmsh", in_order, numbered_in_order, write_msh, write_msh, read_msh},
    {".vtu", "VTK", of_viewers, of_viewers_surface, write_vtu, write_vtu, read_vtk_xml},
    {".pvtu",
     "VTK in parallel",
     of_viewers,
     {},
     write_pvtu,
     nullptr,
     read_pvtu,
     nullptr,
     Parts::always,
     pieces_of_pvtu},
    {".bdf", "Nastran", of_nastran, of_nastran_surface, write_bdf, write_bdf, read_bdf, as_written_for_nastran},
    {".nas", "Nastran", of_nastran, of_nastran_surface, write_bdf, write_bdf, read_bdf, as_written_for_nastran},
    {".unv", "I-DEAS, Salome", all, numbered, write_unv, write_unv, read_unv},
    {".med", "Salome, Code_Aster", in_order, numbered_in_order, write_med, write_med, read_med},
    {".xdmf", "DOLFINx", of_viewers, {}, write_xdmf, nullptr, read_xdmf, nullptr, Parts::too, other_files_of_xdmf},
    {".mail", "Code_Aster", in_order, {}, write_mail, nullptr, read_mail},
    {".cdb", "ANSYS", of_ansys, {}, write_cdb, nullptr, read_cdb},
    {".header", "Elmer", of_elmer, {}, write_elmer, nullptr, read_elmer, nullptr, Parts::too, other_files_of_elmer},
    {".exo", "Exodus II", all, numbered, write_exodus, write_exodus, read_exodus},
    {".e", "Exodus II", all, numbered, write_exodus, write_exodus, read_exodus},
    {".su2", "SU2", of_su2, {}, write_su2, nullptr, read_su2},
    {".vtp", "VTK", {}, of_viewers_surface, nullptr, write_vtp, read_vtk_xml},
    {".vtk", "VTK, legacy", Holdings{.second_order = true}, Holdings{}, nullptr, nullptr, read_vtk_legacy},
    {".3mf", "3MF", {}, Holdings{.face_sets = true, .unit = true}, nullptr, nullptr, read_3mf},
    {".stl", "STL", {}, only_unit, nullptr, write_plain_surface, read_plain_surface},
    {".obj", "Wavefront", {}, Holdings{.face_sets = true, .unit = true}, nullptr, write_obj_groups, read_plain_surface},
    {".ply", "Stanford", {}, only_unit, nullptr, write_plain_surface, read_plain_surface},
    {".off", "Geomview", {}, only_unit, nullptr, write_plain_surface, read_plain_surface},
});

std::string list_of(bool (*wanted)(const FileFormat&)) {
  std::string list;
  for (const FileFormat& format : formats)
    if (wanted(format))
      list += (list.empty() ? "" : ", ") + std::string(format.extension) + " (" + std::string(format.programs) + ")";
  return list;
}

[[noreturn]] void fail_unknown(const std::filesystem::path& file, std::string what, std::string advice) {
  throw WrongUsage({.what = std::move(what),
                    .where = file.string(),
                    .value = file.extension().string(),
                    .limit = {},
                    .advice = std::move(advice)});
}

std::string names_of(std::span<const NamedSet> sets) {
  std::string names;
  for (const NamedSet& set : sets) names += (names.empty() ? "" : ", ") + set.name;
  return names;
}

// What `mesh`, of either kind, has and the format does not hold.
template <class Mesh>
void add_losses(const Mesh& mesh, const Holdings& holds, const std::string& file, Notes& notes) {
  const auto tell = [&](bool holds_it, const std::string& kind, const std::string& what) {
    if (!holds_it && !what.empty()) notes.push_back(file + " holds no " + kind + ": left out " + what);
  };
  tell(holds.node_sets, "sets of nodes", names_of(mesh.node_sets));
  tell(holds.face_sets, "sets of faces", names_of(mesh.face_sets));
  tell(holds.unit, "unit", mesh.unit);
}

// The mesh without faces between bodies, and the names of the sets that nothing is left of.
std::string drop_faces_between(TetMesh& mesh) {
  const std::size_t outer = mesh.outer_faces();
  mesh.boundary.resize(outer);
  mesh.faces_between = 0;
  std::vector<NamedSet> kept, dropped;
  for (NamedSet& set : mesh.face_sets) {
    const bool was_empty = set.members.empty();
    std::erase_if(set.members, [&](std::uint32_t f) { return f >= outer; });
    (set.members.empty() && !was_empty ? dropped : kept).push_back(std::move(set));
  }
  mesh.face_sets = std::move(kept);
  return names_of(dropped);
}

// Whatever the format does not hold of what the options ask for is noted; numbers that do not fit are an error.
void check_numbers(const FileFormat& format, const Holdings& holds, std::size_t nodes, std::size_t elements,
                   const FileOptions& options, const std::string& file, Notes& notes) {
  if (!options.numbers.are_asked_for() && options.numbers.own.empty()) return;
  if (holds.largest_number == 0) {
    notes.push_back(file + " holds no numbers of nodes and elements: left out the first ones that were given");
    return;
  }
  const std::uint64_t last = std::max(options.numbers.largest_node(nodes), options.numbers.largest_element(elements));
  if (last > holds.largest_number)
    throw WrongUsage({.what = "a number is too large for " + std::string(format.programs),
                      .where = file,
                      .value = std::to_string(last),
                      .limit = std::to_string(holds.largest_number),
                      .advice = "smaller --first-node, --first-element"});
}

TetMesh without_mid_edge_nodes(const TetMesh& mesh) {
  std::vector<bool> is_corner(mesh.nodes.size(), false);
  for (const Tetrahedron& t : mesh.tetrahedra)
    for (const std::uint32_t n : t) is_corner[n] = true;
  TetMesh first = mesh;
  first.mid_edge_nodes.clear();
  first.nodes.clear();
  std::vector<std::uint32_t> renumbered(mesh.nodes.size(), 0), origin;
  for (std::uint32_t n = 0; n < mesh.nodes.size(); ++n) {
    if (!is_corner[n]) continue;
    renumbered[n] = static_cast<std::uint32_t>(origin.size());
    origin.push_back(n);
    first.nodes.push_back(mesh.nodes[n]);
  }
  for (Tetrahedron& t : first.tetrahedra)
    for (std::uint32_t& n : t) n = renumbered[n];
  first.node_sets = carried_sets(mesh.node_sets, origin);
  return first;
}

}  // namespace

std::span<const FileFormat> file_formats() {
  return formats;
}

const FileFormat* find_format(const std::filesystem::path& file) {
  const std::string extension = extension_of_content(file);
  const auto* const it =
      std::find_if(formats.begin(), formats.end(), [&](const FileFormat& f) { return f.extension == extension; });
  return it == formats.end() ? nullptr : it;
}

std::uint64_t first_element_of(const std::filesystem::path& file, const Numbering& numbers) {
  const FileFormat* format = find_format(file);
  const auto has_numbers = [](const std::optional<Holdings>& holds) { return holds && holds->largest_number > 0; };
  if (format != nullptr && format->extension == ".header") return 1;  // Elmer's numbers are a row from 1 on
  const bool numbered = format != nullptr && (has_numbers(format->volume) || has_numbers(format->surface));
  return numbered ? numbers.first_element : 0;
}

// Nothing is written compressed.
bool writes_volume(const std::filesystem::path& file) {
  const FileFormat* format = lower_case_extension(file) == ".gz" ? nullptr : find_format(file);
  return format != nullptr && format->write_volume != nullptr;
}

bool writes_surface(const std::filesystem::path& file) {
  const FileFormat* format = lower_case_extension(file) == ".gz" ? nullptr : find_format(file);
  return format != nullptr && format->write_surface != nullptr;
}

std::string known_volume_formats() {
  return list_of([](const FileFormat& f) { return f.write_volume != nullptr; });
}

std::string known_surface_formats_to_write() {
  return list_of([](const FileFormat& f) { return f.write_surface != nullptr; });
}

std::string known_formats_of_parts() {
  return list_of([](const FileFormat& f) { return f.parts != Parts::never; });
}

std::vector<std::filesystem::path> files_of_volume(const std::filesystem::path& file, std::size_t parts) {
  const FileFormat* format = find_format(file);
  std::vector<std::filesystem::path> files;
  if (format != nullptr && format->other_files != nullptr) files = format->other_files(file, parts);
  files.push_back(file);
  return files;
}

void require_parts_fit(const std::filesystem::path& file, std::size_t parts) {
  const FileFormat* format = find_format(file);
  if (format == nullptr) return;
  const std::string extension(format->extension);
  if (parts > 0 && format->parts == Parts::never)
    throw WrongUsage({.what = extension + " holds no mesh in parts",
                      .where = file.string(),
                      .value = "--parts " + std::to_string(parts),
                      .limit = {},
                      .advice = known_formats_of_parts()});
  if (parts == 0 && format->parts == Parts::always)
    throw WrongUsage({.what = extension + " is of a mesh in parts, one for each process",
                      .where = file.string(),
                      .value = {},
                      .limit = {},
                      .advice = "--parts 4, or .vtu for a single file"});
}

Notes write_volume(const TetMesh& mesh, const std::filesystem::path& file, const FileOptions& options) {
  if (!writes_volume(file)) fail_unknown(file, "not the extension of a volume mesh", known_volume_formats());
  const FileFormat& format = *find_format(file);
  Notes notes;
  add_losses(mesh, *format.volume, file.string(), notes);
  if (!format.volume->element_sets && !mesh.element_sets.empty())
    notes.push_back(file.string() + " holds no sets of elements: left out " + names_of(mesh.element_sets));
  const bool lowers_order = mesh.order() == 2 && !format.volume->second_order;
  if (lowers_order)
    notes.push_back(file.string() + " holds no elements of second order: left out the nodes in the middle of edges");
  check_numbers(format, *format.volume, mesh.nodes.size(), mesh.tetrahedra.size() + mesh.boundary.size(), options,
                file.string(), notes);
  std::optional<TetMesh> changed;
  if (lowers_order) changed = without_mid_edge_nodes(mesh);
  if (mesh.faces_between > 0 && !format.volume->faces_between) {
    if (!changed) changed = mesh;
    const std::string dropped = drop_faces_between(*changed);
    if (format.volume->face_sets)  // else told with the other sets
      notes.push_back(file.string() + " holds no faces between bodies: left out " + dropped);
  }
  if (!options.set_prefix.empty()) {
    if (!changed) changed = mesh;
    put_prefix(options.set_prefix, *changed);
  }
  for (std::string& note : format.write_volume(changed ? *changed : mesh, file, options))
    notes.push_back(std::move(note));
  return notes;
}

Notes write_surface(const NamedSurface& surface, const std::filesystem::path& file, const FileOptions& options) {
  if (!writes_surface(file)) fail_unknown(file, "not the extension of a surface", known_surface_formats_to_write());
  const FileFormat& format = *find_format(file);
  Notes notes;
  add_losses(surface, *format.surface, file.string(), notes);
  check_numbers(format, *format.surface, surface.mesh.vertices.size(), surface.mesh.triangles.size(), options,
                file.string(), notes);
  NamedSurface prefixed;
  if (!options.set_prefix.empty()) put_prefix(options.set_prefix, prefixed = surface);
  for (std::string& note : format.write_surface(options.set_prefix.empty() ? surface : prefixed, file, options))
    notes.push_back(std::move(note));
  return notes;
}

void round_to_file(std::vector<Vec3>& points, const std::filesystem::path& file) {
  const FileFormat* format = find_format(file);
  if (format == nullptr || format->rounded == nullptr) return;
  for (Vec3& p : points) p = p.unaryExpr(format->rounded);
}

NamedSurface named_boundary(const TetMesh& given, Notes& notes) {
  TetMesh mesh = given;
  if (mesh.faces_between > 0)
    notes.push_back("the boundary has no faces between bodies: left out " + drop_faces_between(mesh));
  NamedSurface surface{.mesh = {}, .node_sets = {}, .face_sets = mesh.face_sets, .unit = mesh.unit};
  std::vector<std::uint32_t> renumbered(mesh.nodes.size(), 0), origin;
  for (const BoundaryFace f : mesh.boundary) {
    surface.mesh.triangles.push_back(boundary_triangle(mesh, f));
    for (const std::uint32_t n : surface.mesh.triangles.back()) renumbered[n] = 1;
  }
  for (std::uint32_t n = 0; n < renumbered.size(); ++n) {
    if (renumbered[n] == 0) continue;
    renumbered[n] = static_cast<std::uint32_t>(origin.size());
    origin.push_back(n);
    surface.mesh.vertices.push_back(mesh.nodes[n]);
  }
  for (Triangle& t : surface.mesh.triangles)
    for (std::uint32_t& n : t) n = renumbered[n];
  surface.node_sets = carried_sets(mesh.node_sets, origin);
  for (std::size_t s = 0; s < mesh.node_sets.size(); ++s)
    if (surface.node_sets[s].members.size() < mesh.node_sets[s].members.size())
      notes.push_back("set " + mesh.node_sets[s].name + ": nodes that are no corners of the boundary are left out");
  if (!mesh.element_sets.empty())
    notes.push_back("a surface has no sets of tetrahedra: left out " + names_of(mesh.element_sets));
  return surface;
}

MeshFile read_mesh(const std::filesystem::path& file) {
  const FileFormat* format = find_format(file);
  return format == nullptr || format->read == nullptr ? read_plain_surface(file) : format->read(file);
}

TetMesh read_volume(const std::filesystem::path& file) {
  const FileFormat* format = find_format(file);
  if (format == nullptr || !format->volume)
    fail_unknown(file, "not the extension of a volume mesh", known_volume_formats());
  MeshFile read = format->read(file);
  if (!read.is_volume()) throw InvalidInput({"holds no tetrahedra", file.string(), {}, {}, {}});
  return std::get<TetMesh>(std::move(read.mesh));
}

}  // namespace scan2fea
