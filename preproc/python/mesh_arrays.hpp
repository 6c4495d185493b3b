// The arrays of a mesh in memory as NumPy's.
#pragma once

#include "preproc/command/caller.hpp"

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <string>

namespace scan2fea::python {

// What Python holds. Never changed: calls that are on share it.
struct PythonMesh {
  command::SharedMesh mesh;
};

const char* kind_of(const PythonMesh& mesh);  // "surface", "volume", "cloud"
int order_of(const PythonMesh& mesh);
std::string unit_of(const PythonMesh& mesh);

// Views of the mesh's own memory, which `self` keeps; not to be written. (n, 3) float64; (m, 3) or (m, 4) int32, but
// (m, 10), which is a copy, and (0, 0) of a cloud. The triangles of a volume mesh are its boundary, and a copy.
pybind11::array points_of(const pybind11::object& self);
pybind11::array cells_of(const pybind11::object& self);
pybind11::array triangles_of(const pybind11::object& self);
// {name: (k,) int32}, views.
pybind11::dict node_sets_of(const pybind11::object& self);
pybind11::dict face_sets_of(const pybind11::object& self);
pybind11::dict element_sets_of(const pybind11::object& self);

// Copies. `cells`: none for a cloud, or 3, 4 or 10 columns. The sets are of names and rows; those of faces are of a
// surface's, those of elements of a volume mesh's. Throws InvalidInput for what is no mesh.
PythonMesh mesh_of_arrays(const pybind11::array_t<double, pybind11::array::c_style>& points,
                          const pybind11::array_t<std::int64_t, pybind11::array::c_style>& cells,
                          const std::string& unit, const std::string& name, const pybind11::dict& node_sets,
                          const pybind11::dict& face_sets, const pybind11::dict& element_sets);

pybind11::str text_of(const std::string& text);  // of any bytes, as os.fsdecode

}  // namespace scan2fea::python
