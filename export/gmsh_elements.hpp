// What reading and writing MSH files know alike about Gmsh's elements.
#pragma once

#include <array>
#include <cstddef>

namespace scan2fea {

// Types are numbers, in files.
inline constexpr int gmsh_point = 15;
inline constexpr int gmsh_triangle_3 = 2;
inline constexpr int gmsh_tetrahedron_4 = 4;
inline constexpr int gmsh_triangle_6 = 9;
inline constexpr int gmsh_tetrahedron_10 = 11;

// Position in our order of each of Gmsh's mid-edge nodes: the last two are swapped.
inline constexpr std::array<std::size_t, 6> gmsh_mid_edges{0, 1, 2, 3, 5, 4};

}  // namespace scan2fea
