#include "export/med.hpp"

#include "export/hdf5_times.hpp"
#include "export/med_module.hpp"
#include "export/raw_mesh.hpp"
#include "export/set_names.hpp"
#include "preproc/mesh/companion_file.hpp"
#include "preproc/mesh/error.hpp"
#include "preproc/mesh/input_file.hpp"
#include "preproc/mesh/output_file.hpp"

#include <algorithm>
#include <array>
#include <dlfcn.h>
#include <mutex>
#include <span>

namespace scan2fea {
namespace {

// Of MED's nodes, ours: its tetrahedra are turned the other way round.
constexpr std::array<std::size_t, 4> med_corners{0, 2, 1, 3};
constexpr std::array<std::size_t, 6> med_mid_edges{2, 1, 0, 3, 5, 4};

// Loaded once and kept: HDF5 does not survive unloading.
void* load(const char* function_name) {
  static const std::filesystem::path module = companion_file(med_module_name);
  static void* const handle = ::dlopen(module.c_str(), RTLD_NOW | RTLD_LOCAL);
  void* function = handle != nullptr ? ::dlsym(handle, function_name) : nullptr;
  if (function != nullptr) return function;
  const char* reason = ::dlerror();
  throw IoError({.what = "MED files cannot be read or written: their module does not load",
                 .where = module.string(),
                 .value = reason != nullptr ? reason : "",
                 .limit = {},
                 .advice = "install scan2fea anew, with the module, and Debian's libmedc11"});
}

// The library keeps the one file in memory that it is at, and HDF5 more: several threads of a program may come here.
std::mutex one_at_a_time;

constexpr NameRules rules{
    .longest = 79, .upper_case = false, .allowed = " _-.+:/()", .starts_with_letter = true, .keeps_reserved = true};

MedFamilies families_of(std::span<const NamedSet> sets, std::size_t members, Notes& notes) {
  const std::vector<std::string> names = names_for(sets, rules, {}, notes);
  const SetParts parts = set_parts(sets, members);
  MedFamilies families{parts.part, {}};
  for (std::size_t part = 1; part < parts.of.size(); ++part) {
    auto& groups = families.groups.emplace_back();
    for (const std::uint32_t s : parts.of[part]) groups.push_back(names[s]);
  }
  return families;
}

std::vector<double> coordinates_of(const std::vector<Vec3>& points) {
  std::vector<double> coordinates;
  for (const Vec3& p : points) coordinates.insert(coordinates.end(), {p.x(), p.y(), p.z()});
  return coordinates;
}

int number(std::uint32_t node) {
  return static_cast<int>(node) + 1;
}

void write(const MedMesh& mesh, const std::filesystem::path& file, OutputFiles* together) {
  auto* const write_by_med = reinterpret_cast<WriteByMed*>(load(write_by_med_name));
  OutputFiles files(together);
  OutputFile& output = files.open(file);
  std::string bytes, failure;
  {
    const std::lock_guard lock(one_at_a_time);
    write_by_med(mesh, bytes, failure);
  }
  if (!failure.empty()) throw IoError({"the MED library cannot write the file", file.string(), failure, {}, {}});
  forget_times(bytes);
  output.stream().write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  files.commit();
}

void add_sets(const MedFamilies& families, const std::vector<std::uint64_t>& numbers, std::vector<RawSet>& sets) {
  for (std::size_t i = 0; i < numbers.size(); ++i)
    if (families.family[i] > 0)
      for (const std::string& group : families.groups[families.family[i] - 1])
        members_of(sets, group).push_back(numbers[i]);
}

void add_cells(const MedCells& cells, RawMesh& raw) {
  const bool tetrahedra = cells.type >= med_tetrahedron_4;
  const auto each = static_cast<std::size_t>(cells.type % 100);
  std::vector<std::uint64_t> numbers;
  for (std::size_t e = 0; e < cells.families.family.size(); ++e) {
    const auto node = [&](std::size_t k) {
      return static_cast<std::uint64_t>(std::max(cells.nodes[e * each + k], 0));  // 0 is no node
    };
    numbers.push_back(raw.tetrahedron_numbers.size() + raw.triangle_numbers.size() + 1);
    (tetrahedra ? raw.tetrahedron_numbers : raw.triangle_numbers).push_back(numbers.back());
    if (!tetrahedra) {
      raw.triangles.insert(raw.triangles.end(), {node(0), node(1), node(2)});
      continue;
    }
    for (const std::size_t k : med_corners) raw.corners.push_back(node(k));
    if (each == 10)
      for (const std::size_t k : med_mid_edges) raw.mid_edges.push_back(node(4 + k));
  }
  add_sets(cells.families, numbers, raw.element_sets);
}

}  // namespace

WrittenNames names_in_med(const TetMesh& mesh, const std::string& prefix, Notes& notes) {
  TetMesh sets;  // the mesh itself is not needed
  sets.node_sets = mesh.node_sets;
  sets.face_sets = mesh.face_sets;
  sets.element_sets = mesh.element_sets;
  const TetMesh whole = with_whole_sets(sets, prefix, notes);
  return {.nodes = names_for(whole.node_sets, rules, {}, notes),
          .faces = names_for(whole.face_sets, rules, {}, notes),
          .elements = names_for(whole.element_sets, rules, {}, notes)};
}

Notes write_med(const TetMesh& given, const std::filesystem::path& file, const FileOptions& options) {
  Notes notes;
  const TetMesh mesh = with_whole_sets(given, options.set_prefix, notes);
  const bool second = mesh.order() == 2;
  MedMesh med{.coordinates = coordinates_of(mesh.nodes),
              .nodes = families_of(mesh.node_sets, mesh.nodes.size(), notes),
              .cells = {},
              .unit = mesh.unit,
              .description = "written by scan2fea: " + options.provenance,
              .first_node = options.numbers.first_node,
              .first_element = options.numbers.first_element};
  MedCells& tetrahedra = med.cells.emplace_back();
  tetrahedra.type = second ? med_tetrahedron_10 : med_tetrahedron_4;
  tetrahedra.families = families_of(mesh.element_sets, mesh.tetrahedra.size(), notes);
  for (std::size_t t = 0; t < mesh.tetrahedra.size(); ++t) {
    for (const std::size_t k : med_corners) tetrahedra.nodes.push_back(number(mesh.tetrahedra[t][k]));
    if (second)
      for (const std::size_t k : med_mid_edges) tetrahedra.nodes.push_back(number(mesh.mid_edge_nodes[t][k]));
  }
  MedCells& triangles = med.cells.emplace_back();
  triangles.type = second ? med_triangle_6 : med_triangle_3;
  triangles.families = families_of(mesh.face_sets, mesh.boundary.size(), notes);
  for (const BoundaryFace f : mesh.boundary) {
    for (const std::uint32_t n : boundary_triangle(mesh, f)) triangles.nodes.push_back(number(n));
    if (second)
      for (const std::uint32_t n : boundary_mid_edge_nodes(mesh, f)) triangles.nodes.push_back(number(n));
  }
  write(med, file, options.together);
  return notes;
}

Notes write_med(const NamedSurface& surface, const std::filesystem::path& file, const FileOptions& options) {
  Notes notes;
  MedMesh med{.coordinates = coordinates_of(surface.mesh.vertices),
              .nodes = families_of(surface.node_sets, surface.mesh.vertices.size(), notes),
              .cells = {},
              .unit = surface.unit,
              .description = "written by scan2fea: " + options.provenance,
              .first_node = options.numbers.first_node,
              .first_element = options.numbers.first_element};
  MedCells& triangles = med.cells.emplace_back();
  triangles.type = med_triangle_3;
  triangles.families = families_of(surface.face_sets, surface.mesh.triangles.size(), notes);
  for (const Triangle& t : surface.mesh.triangles)
    for (const std::uint32_t n : t) triangles.nodes.push_back(number(n));
  write(med, file, options.together);
  return notes;
}

MeshFile read_med(const std::filesystem::path& file) {
  const InputFile exists(file);  // for the errors of files that cannot be read
  auto* const read_by_med = reinterpret_cast<ReadByMed*>(load(read_by_med_name));
  MedMesh med;
  std::string failure;
  {
    const std::lock_guard lock(one_at_a_time);
    read_by_med(file, med, failure);
  }
  if (!failure.empty()) exists.fail(failure);
  RawMesh raw;
  for (std::size_t i = 0; i + 2 < med.coordinates.size(); i += 3) {
    raw.node_numbers.push_back(i / 3 + 1);
    raw.nodes.emplace_back(med.coordinates[i], med.coordinates[i + 1], med.coordinates[i + 2]);
  }
  raw.unit = med.unit;
  for (const MedCells& cells : med.cells) add_cells(cells, raw);
  add_sets(med.nodes, raw.node_numbers, raw.node_sets);
  return assemble(raw, file);
}

}  // namespace scan2fea
