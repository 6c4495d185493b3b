// The readers of the surface formats, one source file each. `read_surface` chooses among them.
// All throw InvalidInput as read_surface.hpp says, give finite coordinates and indices in range, and leave it to
// `read_surface` to refuse a surface without faces. `take`, where given, takes the triangles in blocks; what is
// returned then has none.
#pragma once

#include "preproc/mesh/input_file.hpp"
#include "preproc/mesh/named_sets.hpp"
#include "preproc/mesh/read_surface.hpp"
#include "preproc/mesh/surface_mesh.hpp"

namespace scan2fea {

// STL, ASCII or binary, of any number of solids; bit-identical corners become one vertex, -0 being 0. `sets`, where
// given: the triangles of each solid that has a name, where there are several.
SurfaceMesh read_stl(const InputFile& file, std::vector<NamedSet>* sets = nullptr, const TakeBlock& take = {});

// Wavefront OBJ: the positions and faces of all groups together; texture, normals and colours are passed over. `sets`,
// where given: the triangles of each group, object and material.
SurfaceMesh read_obj(const InputFile& file, std::vector<NamedSet>* sets = nullptr, const TakeBlock& take = {});

// Stanford PLY 1.0: x, y, z of `vertex`, the list of `face` and of `tristrips`, among any other properties and
// elements. `sets`, where given: the triangles of each value of the whole numbers that faces have as label, object_id,
// segment, segment_id, group, group_id, region, material_index or category_id: "label_3". One value, or more than 1000,
// make no sets.
SurfaceMesh read_ply(const InputFile& file, std::vector<NamedSet>* sets = nullptr, const TakeBlock& take = {});

// Geomview OFF, also with normals, colours or texture (NOFF, COFF, STOFF), which are passed over.
SurfaceMesh read_off(const InputFile& file, const TakeBlock& take = {});

// Any of them, without faces too.
SurfaceMesh read_faces_and_vertices(const InputFile& file, std::vector<NamedSet>* sets = nullptr,
                                    const TakeBlock& take = {});

// The unit of a comment that `write_surface` wrote; empty where there is none.
std::string unit_in_head(const InputFile& file);

// What the content alone tells.
bool is_binary_stl(const InputFile& file);  // its triangle count and its size agree
bool is_ply(const InputFile& file);
bool is_off(const InputFile& file);

}  // namespace scan2fea
