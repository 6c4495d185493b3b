#include "export/vtk_cells.hpp"

#include "export/raw_mesh.hpp"
#include "preproc/mesh/error.hpp"
#include "preproc/mesh/polygon.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

namespace scan2fea {
namespace {

// Cells without volume: of points, lines and surfaces.
bool is_not_solid(std::uint64_t type) {
  static constexpr std::array<std::uint64_t, 23> types{0,  1,  2,  3,  4,  5,  6,  7,  8,  9,  21, 22,
                                                       23, 28, 30, 34, 35, 36, 68, 69, 70, 75, 76};
  return std::find(types.begin(), types.end(), type) != types.end();
}

class Gather {
 public:
  Gather(const VtkCells& cells, const std::filesystem::path& file) : cells_(cells), file_(file) {}

  MeshFile mesh() {
    add_points();
    add_cells();
    add_sets();
    raw_.unit = cells_.unit;
    const std::string name = file_.string();
    const bool volume = !raw_.corners.empty();
    MeshFile mesh = assemble(
        raw_, file_, [&](std::size_t n) { return name + ": point " + std::to_string(n); },
        [&](std::size_t e) {
          return name + ": cell " + std::to_string(volume ? cell_of_tetrahedron_[e] : cell_of_triangle_[e]);
        });
    mesh.other_arrays = cells_.other_arrays;
    return mesh;
  }

 private:
  void add_points() {
    const std::size_t points = cells_.coordinates.size() / 3;
    raw_.node_numbers.resize(points);
    std::iota(raw_.node_numbers.begin(), raw_.node_numbers.end(), std::uint64_t{0});
    raw_.nodes.resize(points);
    for (std::size_t i = 0; i < 3 * points; ++i)
      raw_.nodes[i / 3][static_cast<Eigen::Index>(i % 3)] = cells_.coordinates[i];
  }

  void add_cells() {
    std::uint64_t begin = 0;
    for (std::size_t c = 0; c < cells_.types.size(); begin = cells_.offsets[c], ++c) {
      const std::uint64_t end = cells_.offsets[c], type = cells_.types[c];
      if (end < begin || end > cells_.connectivity.size())
        fail_vtk(file_, "cell " + std::to_string(c) + " has a wrong offset");
      const std::span<const std::uint64_t> nodes(cells_.connectivity.data() + begin, end - begin);
      if (type == vtk_tetra || type == vtk_quadratic_tetra)
        add_tetrahedron(c, nodes, type == vtk_quadratic_tetra);
      else if (is_not_solid(type))
        add_face(c, type, nodes);
      else
        fail_vtk(file_, "cell " + std::to_string(c) + " is not a tetrahedron", "VTK type " + std::to_string(type),
                 "a mesh of tetrahedra");
    }
  }

  void add_tetrahedron(std::size_t cell, std::span<const std::uint64_t> nodes, bool quadratic) {
    const std::string name = "cell " + std::to_string(cell);
    if (nodes.size() != (quadratic ? 10 : 4)) fail_vtk(file_, name + " has a wrong number of nodes");
    if (raw_.has_other_order(quadratic)) fail_vtk(file_, name + " is of another order than the cells before it");
    raw_.add_tetrahedron(next_number(), nodes);
    cell_of_tetrahedron_.push_back(cell);
  }

  // Triangles of order two give their corners.
  void add_face(std::size_t cell, std::uint64_t type, std::span<const std::uint64_t> nodes) {
    constexpr std::uint64_t quad = 9, pixel = 8, quadratic_triangle = 22;
    const std::size_t n = nodes.size();
    if ((type == vtk_triangle && n == 3) || (type == quadratic_triangle && n == 6)) {
      add_triangle(cell, nodes[0], nodes[1], nodes[2]);
    } else if (type == vtk_triangle_strip) {
      for (std::size_t k = 0; k + 2 < n; ++k) add_triangle(cell, nodes[k], nodes[k + 1 + k % 2], nodes[k + 2 - k % 2]);
    } else if ((type == vtk_polygon || type == quad) && n >= 3) {
      add_polygon(cell, {nodes.begin(), nodes.end()});
    } else if (type == pixel && n == 4) {
      add_polygon(cell, {nodes[0], nodes[1], nodes[3], nodes[2]});
    } else {
      ++raw_.passed_over;
    }
  }

  void add_triangle(std::size_t cell, std::uint64_t a, std::uint64_t b, std::uint64_t c) {
    raw_.triangles.insert(raw_.triangles.end(), {a, b, c});
    raw_.triangle_numbers.push_back(next_number());
    cell_of_triangle_.push_back(cell);
  }

  void add_polygon(std::size_t cell, const std::vector<std::uint64_t>& nodes) {
    if (nodes.size() == 3) return add_triangle(cell, nodes[0], nodes[1], nodes[2]);
    SurfaceMesh mesh;
    std::vector<std::uint32_t> corners;
    for (const std::uint64_t n : nodes) {
      if (n >= raw_.nodes.size())
        fail_vtk(file_, "cell " + std::to_string(cell) + ": element uses node " + std::to_string(n) +
                            ", which is not defined");
      corners.push_back(static_cast<std::uint32_t>(mesh.vertices.size()));
      mesh.vertices.push_back(raw_.nodes[n]);
    }
    append_polygon(mesh, corners);
    for (const Triangle& t : mesh.triangles) add_triangle(cell, nodes[t[0]], nodes[t[1]], nodes[t[2]]);
  }

  std::uint64_t next_number() { return raw_.tetrahedron_numbers.size() + raw_.triangle_numbers.size(); }

  void add_sets() {
    for (const auto& [name, values] : cells_.point_arrays) {
      auto& members = members_of(raw_.node_sets, name.substr(vtk_node_set.size()));
      for (std::size_t n = 0; n < std::min(values.size(), raw_.nodes.size()); ++n)
        if (values[n] != 0) members.push_back(n);
    }
    for (const auto& [name, values] : cells_.cell_arrays) {
      const auto value = [&values = values](std::size_t cell) { return cell < values.size() ? values[cell] : 0.0; };
      const bool of_faces = name.starts_with(vtk_face_set);
      const std::string set = name.substr(of_faces ? vtk_face_set.size() : vtk_element_set.size());
      if (of_faces && !raw_.corners.empty()) {
        RawFaceSet faces{set, {}};
        for (std::size_t t = 0; t < cell_of_tetrahedron_.size(); ++t)
          for (std::uint8_t f = 0; f < 4; ++f)
            if (std::fmod(std::floor(std::clamp(value(cell_of_tetrahedron_[t]), 0.0, 15.0) / (1 << f)), 2) == 1)
              faces.faces.emplace_back(raw_.tetrahedron_numbers[t], f);
        raw_.face_sets.push_back(std::move(faces));
        continue;
      }
      auto& members = members_of(raw_.element_sets, set);
      for (std::size_t t = 0; t < cell_of_tetrahedron_.size(); ++t)
        if (value(cell_of_tetrahedron_[t]) != 0) members.push_back(raw_.tetrahedron_numbers[t]);
      for (std::size_t t = 0; t < cell_of_triangle_.size(); ++t)
        if (value(cell_of_triangle_[t]) != 0) members.push_back(raw_.triangle_numbers[t]);
    }
  }

  const VtkCells& cells_;
  const std::filesystem::path& file_;
  RawMesh raw_;
  std::vector<std::size_t> cell_of_tetrahedron_, cell_of_triangle_;
};

}  // namespace

[[noreturn]] void fail_vtk(const std::filesystem::path& file, std::string what, std::string value, std::string advice) {
  throw InvalidInput({.what = std::move(what),
                      .where = file.string(),
                      .value = std::move(value),
                      .limit = {},
                      .advice = std::move(advice)});
}

MeshFile mesh_of(const VtkCells& cells, const std::filesystem::path& file) {
  return Gather(cells, file).mesh();
}

}  // namespace scan2fea
