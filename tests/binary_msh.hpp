// Binary MSH files, which no writer of ours makes.
#pragma once

#include "export/msh.hpp"
#include "preproc/mesh/byte_order.hpp"

#include <bit>
#include <cstdint>
#include <string>

namespace scan2fea {

// One tetrahedron of volume 1/6 and a triangle, as Gmsh's manual describes version 2.2 and 4.1 in binary.
template <class T>
std::string bytes(T value, std::endian order) {
  std::string text(sizeof(T), '\0');
  store(value, text.data(), order);
  return text;
}

inline std::string binary_mesh(MshVersion version, std::endian order) {
  const auto i = [&](std::int32_t value) { return bytes(value, order); };
  const auto n = [&](std::uint64_t value) { return bytes(value, order); };
  const auto p = [&](double x, double y, double z) { return bytes(x, order) + bytes(y, order) + bytes(z, order); };
  const std::string groups = "$PhysicalNames\n1\n3 1 \"a #1 $Nodes\"\n$EndPhysicalNames\n";
  if (version == MshVersion::v2_2)
    return "$MeshFormat\n2.2 1 8\n" + i(1) + "\n$EndMeshFormat\n" + groups + "$Nodes\n4\n" + i(7) + p(0, 0, 0) + i(5) +
           p(1, 0, 0) + i(3) + p(0, 1, 0) + i(9) + p(0, 0, 1) + "\n$EndNodes\n$Elements\n2\n" + i(2) + i(1) + i(2) +
           i(1) + i(1) + i(1) + i(7) + i(5) + i(3) + i(4) + i(1) + i(2) + i(2) + i(1) + i(1) + i(7) + i(5) + i(3) +
           i(9) + "\n$EndElements\n";
  return "$MeshFormat\n4.1 1 8\n" + i(1) + "\n$EndMeshFormat\n" + groups + "$Nodes\n" + n(2) + n(4) + n(3) + n(9) +
         i(2) + i(1) + i(1) + n(2) + n(7) + n(5) + p(0, 0, 0) + bytes(0.5, order) + bytes(0.5, order) + p(1, 0, 0) +
         bytes(0.5, order) + bytes(0.5, order) + i(3) + i(1) + i(0) + n(2) + n(3) + n(9) + p(0, 1, 0) + p(0, 0, 1) +
         "\n$EndNodes\n$Elements\n" + n(2) + n(2) + n(1) + n(2) + i(2) + i(1) + i(2) + n(1) + n(1) + n(7) + n(5) +
         n(3) + i(3) + i(1) + i(4) + n(1) + n(2) + n(7) + n(5) + n(3) + n(9) + "\n$EndElements\n";
}

}  // namespace scan2fea
