// 3MF (.3mf), of printers and scanners: a ZIP of XML with the unit that it is in. Read by ourselves: Debian's lib3mf is
// of an interface that its makers gave up in 2018, and keeps coordinates in 32 bits.
#pragma once

#include "export/mesh_file.hpp"

#include <filesystem>

namespace scan2fea {

// The triangles of all objects that the build names, with their transformations; objects that have a name are sets of
// faces of it. Materials, textures and the extensions (beams, slices) are passed over. Throws InvalidInput naming the
// file and what is wrong: unreadable, not 3MF, cut short, an index out of range, objects that are made of one another,
// parts that promise more than their bytes can hold.
MeshFile read_3mf(const std::filesystem::path& file);

}  // namespace scan2fea
