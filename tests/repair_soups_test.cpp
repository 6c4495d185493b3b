// Inputs that fuzzing found (tests/fuzz/repair_fuzz.cpp), as the bytes that describe them.
#include "tests/fuzz/soup_of_bytes.hpp"
#include "tests/surfaces_to_repair.hpp"

#include <gtest/gtest.h>

namespace scan2fea {
namespace {

SurfaceMesh soup(const std::vector<std::uint8_t>& text) {
  fuzz::Bytes bytes(text);
  return fuzz::soup_of(bytes);
}

// Vertices that a cut splits touch one another where no patch covers them.
TEST(RepairSoups, WhatACutLeavesAtABorderDoesNotTouchItself) {
  const RepairOptions options{.holes = Holes::keep};
  for (const auto& bytes :
       {std::vector<std::uint8_t>{0x80, 0x8c, 0xb8, 0x00, 0xed, 0xe9, 0xe1, 0x7f, 0x4b, 0x44, 0x7c, 0x42, 0xe0, 0xaa},
        {0x80, 0x8c, 0xb8, 0x00, 0xed, 0xe9, 0x03, 0x69, 0xe1, 0x7f, 0x4b, 0x44, 0x7c, 0x42, 0xe0, 0xaa}}) {
    SurfaceMesh mesh = soup(bytes);
    try {
      repair(mesh, options);
    } catch (const NotMeshable&) {  // too much would have to be cut out
      continue;
    }
    EXPECT_TRUE(check_validity(mesh).manifold());
    EXPECT_TRUE(find_self_intersections(mesh).empty());
  }
}

}  // namespace
}  // namespace scan2fea
