#include "preproc/python/mesh_arrays.hpp"

#include "export/raw_mesh.hpp"
#include "preproc/mesh/error.hpp"
#include "preproc/mesh/length_unit.hpp"

#include <array>
#include <pybind11/stl.h>
#include <utility>

namespace scan2fea::python {
namespace {

namespace py = pybind11;
using command::MemoryMesh;

static_assert(sizeof(Vec3) == 3 * sizeof(double), "rows of points lie side by side");

// Indices are below 2^30, so that they are the same as signed.
template <class Row, class Value>
py::array view(const std::vector<Row>& rows, py::ssize_t columns, const py::object& owner) {
  py::array_t<Value> array({static_cast<py::ssize_t>(rows.size()), columns},
                           reinterpret_cast<const Value*>(rows.data()), owner);
  py::detail::array_proxy(array.ptr())->flags &= ~py::detail::npy_api::NPY_ARRAY_WRITEABLE_;
  return array;
}

py::array view_of_set(const NamedSet& set, const py::object& owner) {
  py::array_t<std::int32_t> array(static_cast<py::ssize_t>(set.members.size()),
                                  reinterpret_cast<const std::int32_t*>(set.members.data()), owner);
  py::detail::array_proxy(array.ptr())->flags &= ~py::detail::npy_api::NPY_ARRAY_WRITEABLE_;
  return array;
}

py::array_t<std::int32_t> empty_rows(std::size_t rows, py::ssize_t columns) {
  return py::array_t<std::int32_t>({static_cast<py::ssize_t>(rows), columns});
}

const MemoryMesh& held_by(const py::object& self) {
  return *self.cast<const PythonMesh&>().mesh;
}

const NamedSurface* surface_held_by(const MemoryMesh& mesh) {
  const auto* file = std::get_if<MeshFile>(&mesh.held);
  return file == nullptr ? nullptr : std::get_if<NamedSurface>(&file->mesh);
}

const TetMesh* volume_held_by(const MemoryMesh& mesh) {
  const auto* file = std::get_if<MeshFile>(&mesh.held);
  return file == nullptr ? nullptr : std::get_if<TetMesh>(&file->mesh);
}

py::array second_order_cells(const TetMesh& mesh) {
  py::array_t<std::int32_t> cells = empty_rows(mesh.tetrahedra.size(), 10);
  auto rows = cells.mutable_unchecked<2>();
  for (std::size_t t = 0; t < mesh.tetrahedra.size(); ++t) {
    const auto row = static_cast<py::ssize_t>(t);
    for (std::size_t i = 0; i < 4; ++i)
      rows(row, static_cast<py::ssize_t>(i)) = static_cast<int>(mesh.tetrahedra[t][i]);
    for (std::size_t i = 0; i < 6; ++i)
      rows(row, static_cast<py::ssize_t>(4 + i)) = static_cast<int>(mesh.mid_edge_nodes[t][i]);
  }
  return cells;
}

py::dict dictionary(const std::vector<NamedSet>* sets, const py::object& owner) {
  py::dict result;
  if (sets != nullptr)
    for (const NamedSet& set : *sets) result[text_of(set.name)] = view_of_set(set, owner);
  return result;
}

[[noreturn]] void refuse(std::string what, const std::string& name, const std::string& array, std::size_t row,
                         std::string value, std::string limit) {
  throw InvalidInput({.what = std::move(what),
                      .where = name + ": " + array + "[" + std::to_string(row) + "]",
                      .value = std::move(value),
                      .limit = std::move(limit),
                      .advice = {}});
}

std::vector<Vec3> points_in(const py::array_t<double, py::array::c_style>& array, const std::string& name) {
  const auto rows = array.unchecked<2>();
  std::vector<Vec3> points(static_cast<std::size_t>(rows.shape(0)));
  for (std::size_t i = 0; i < points.size(); ++i) {
    const auto row = static_cast<py::ssize_t>(i);
    points[i] = {rows(row, 0), rows(row, 1), rows(row, 2)};
    if (!points[i].allFinite()) refuse("coordinate is not a finite number", name, "points", i, {}, {});
  }
  return points;
}

using Cells = py::array_t<std::int64_t, py::array::c_style>;

void require_within(const Cells& array, std::size_t points, const std::string& name) {
  const auto rows = array.unchecked<2>();
  for (py::ssize_t row = 0; row < rows.shape(0); ++row)
    for (py::ssize_t i = 0; i < rows.shape(1); ++i)
      if (rows(row, i) < 0 || static_cast<std::uint64_t>(rows(row, i)) >= points)
        refuse("index of a point is out of range", name, "cells", static_cast<std::size_t>(row),
               std::to_string(rows(row, i)), "0 to " + std::to_string(points) + " - 1");
}

std::vector<NamedSet> sets_in(const py::dict& sets, std::size_t members, const std::string& kind,
                              const std::string& name) {
  std::vector<NamedSet> result;
  for (const auto& [key, value] : sets) {
    std::vector<std::uint32_t> rows;
    for (const auto row : value.cast<std::vector<std::int64_t>>()) {
      if (row < 0 || static_cast<std::uint64_t>(row) >= members)
        refuse("a row of a set is out of range", name, kind + " " + key.cast<std::string>(), rows.size(),
               std::to_string(row), "0 to " + std::to_string(members) + " - 1");
      rows.push_back(static_cast<std::uint32_t>(row));
    }
    result.push_back(named_set(key.cast<std::string>(), std::move(rows)));
  }
  return result;
}

SurfaceMesh surface_of(std::vector<Vec3> points, const Cells& array) {
  SurfaceMesh mesh{std::move(points), {}};
  const auto rows = array.unchecked<2>();
  for (py::ssize_t row = 0; row < rows.shape(0); ++row)
    mesh.triangles.push_back({static_cast<std::uint32_t>(rows(row, 0)), static_cast<std::uint32_t>(rows(row, 1)),
                              static_cast<std::uint32_t>(rows(row, 2))});
  return mesh;
}

std::vector<RawSet> raw_sets(const std::vector<NamedSet>& sets) {
  std::vector<RawSet> raw;
  for (const NamedSet& set : sets) raw.push_back({set.name, {set.members.begin(), set.members.end()}});
  return raw;
}

// As the readers of files make one: with the nodes that elements use.
MeshFile volume_of(std::vector<Vec3> points, const Cells& array, const std::vector<NamedSet>& node_sets,
                   const std::vector<NamedSet>& element_sets, const std::string& name) {
  RawMesh raw;
  raw.nodes = std::move(points);
  for (std::size_t n = 0; n < raw.nodes.size(); ++n) raw.node_numbers.push_back(n);
  const auto rows = array.unchecked<2>();
  std::vector<std::uint64_t> nodes(static_cast<std::size_t>(rows.shape(1)));
  for (py::ssize_t row = 0; row < rows.shape(0); ++row) {
    for (std::size_t i = 0; i < nodes.size(); ++i)
      nodes[i] = static_cast<std::uint64_t>(rows(row, static_cast<py::ssize_t>(i)));
    raw.add_tetrahedron(static_cast<std::uint64_t>(row), nodes);
  }
  raw.node_sets = raw_sets(node_sets);
  raw.element_sets = raw_sets(element_sets);
  const auto place = [&](const char* what) {
    return [&name, what](std::size_t row) { return name + ": " + what + "[" + std::to_string(row) + "]"; };
  };
  MeshFile file = assemble(raw, name, place("points"), place("cells"));
  file.numbers = {};
  return file;
}

}  // namespace

const char* kind_of(const PythonMesh& mesh) {
  return volume_held_by(*mesh.mesh) != nullptr    ? "volume"
         : surface_held_by(*mesh.mesh) != nullptr ? "surface"
                                                  : "cloud";
}

int order_of(const PythonMesh& mesh) {
  const TetMesh* volume = volume_held_by(*mesh.mesh);
  return volume == nullptr ? 1 : volume->order();
}

std::string unit_of(const PythonMesh& mesh) {
  if (const TetMesh* volume = volume_held_by(*mesh.mesh)) return volume->unit;
  const NamedSurface* surface = surface_held_by(*mesh.mesh);
  return surface == nullptr ? std::string() : surface->unit;
}

py::array points_of(const py::object& self) {
  const MemoryMesh& mesh = held_by(self);
  if (const TetMesh* volume = volume_held_by(mesh)) return view<Vec3, double>(volume->nodes, 3, self);
  if (const NamedSurface* surface = surface_held_by(mesh)) return view<Vec3, double>(surface->mesh.vertices, 3, self);
  return view<Vec3, double>(std::get<PointCloud>(mesh.held).points, 3, self);
}

py::array cells_of(const py::object& self) {
  const TetMesh* volume = volume_held_by(held_by(self));
  if (volume == nullptr) return triangles_of(self);
  if (volume->order() == 2) return second_order_cells(*volume);
  return view<Tetrahedron, std::int32_t>(volume->tetrahedra, 4, self);
}

py::array triangles_of(const py::object& self) {
  const MemoryMesh& mesh = held_by(self);
  if (const NamedSurface* surface = surface_held_by(mesh))
    return view<Triangle, std::int32_t>(surface->mesh.triangles, 3, self);
  const TetMesh* volume = volume_held_by(mesh);
  if (volume == nullptr) return empty_rows(0, 0);
  py::array_t<std::int32_t> triangles = empty_rows(volume->boundary.size(), 3);
  auto rows = triangles.mutable_unchecked<2>();
  for (std::size_t f = 0; f < volume->boundary.size(); ++f) {
    const Triangle triangle = boundary_triangle(*volume, volume->boundary[f]);
    for (std::size_t i = 0; i < 3; ++i)
      rows(static_cast<py::ssize_t>(f), static_cast<py::ssize_t>(i)) = static_cast<int>(triangle[i]);
  }
  return triangles;
}

py::dict node_sets_of(const py::object& self) {
  const MemoryMesh& mesh = held_by(self);
  if (const TetMesh* volume = volume_held_by(mesh)) return dictionary(&volume->node_sets, self);
  const NamedSurface* surface = surface_held_by(mesh);
  return dictionary(surface == nullptr ? nullptr : &surface->node_sets, self);
}

py::dict face_sets_of(const py::object& self) {
  const MemoryMesh& mesh = held_by(self);
  if (const TetMesh* volume = volume_held_by(mesh)) return dictionary(&volume->face_sets, self);
  const NamedSurface* surface = surface_held_by(mesh);
  return dictionary(surface == nullptr ? nullptr : &surface->face_sets, self);
}

py::dict element_sets_of(const py::object& self) {
  const TetMesh* volume = volume_held_by(held_by(self));
  return dictionary(volume == nullptr ? nullptr : &volume->element_sets, self);
}

PythonMesh mesh_of_arrays(const py::array_t<double, py::array::c_style>& points, const Cells& cells,
                          const std::string& unit, const std::string& name, const py::dict& node_sets,
                          const py::dict& face_sets, const py::dict& element_sets) {
  const std::optional<std::string> known = unit.empty() ? std::string() : length_unit(unit);
  if (!known)
    throw WrongUsage({.what = "unknown unit of length",
                      .where = name,
                      .value = unit,
                      .limit = {},
                      .advice = std::string(known_length_units)});
  std::vector<Vec3> nodes = points_in(points, name);
  const std::size_t count = nodes.size();
  require_within(cells, count, name);
  const auto rows = static_cast<std::size_t>(cells.shape(0));
  const std::vector<NamedSet> of_nodes = sets_in(node_sets, count, "node_sets", name);
  MemoryMesh mesh{.held = MeshFile(), .name = name};
  if (cells.shape(1) == 0) {
    mesh.held = PointCloud{.points = std::move(nodes), .normals = {}, .scanners = {}};
  } else if (cells.shape(1) == 3) {
    NamedSurface surface{.mesh = surface_of(std::move(nodes), cells),
                         .node_sets = of_nodes,
                         .face_sets = sets_in(face_sets, rows, "face_sets", name),
                         .unit = *known};
    mesh.held = MeshFile{.mesh = std::move(surface), .numbers = {}, .warnings = {}};
  } else {
    MeshFile file =
        volume_of(std::move(nodes), cells, of_nodes, sets_in(element_sets, rows, "element_sets", name), name);
    std::get<TetMesh>(file.mesh).unit = *known;
    mesh.held = std::move(file);
  }
  return {std::make_shared<MemoryMesh>(std::move(mesh))};
}

py::str text_of(const std::string& text) {
  PyObject* decoded = PyUnicode_DecodeUTF8(text.data(), static_cast<py::ssize_t>(text.size()), "surrogateescape");
  if (decoded == nullptr) throw py::error_already_set();
  return py::reinterpret_steal<py::str>(decoded);
}

}  // namespace scan2fea::python
