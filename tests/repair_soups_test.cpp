// Inputs that fuzzing found (tests/fuzz/repair_fuzz.cpp), as the bytes that describe them.
#include "preproc/mesh/splitmix64.hpp"
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

void expect_sound_or_refused(SurfaceMesh mesh) {
  if (mesh.triangles.empty()) return;
  try {
    repair(mesh);
  } catch (const NotMeshable&) {
    return;
  }
  expect_sound(mesh);
}

// A face of no area beside faces that are cut.
TEST(RepairSoups, AFaceOfNoAreaIsNotCut) {
  expect_sound_or_refused(
      soup({0x43, 0x1c, 0x83, 0x17, 0x02, 0xd8, 0x9d, 0x02, 0xa4, 0xc1, 0x3b, 0xac, 0xcb, 0xcf, 0x14, 0x03}));
}

TEST(RepairSoups, RandomOnesComeOutSoundOrAreRefused) {
  std::uint64_t state = 7;
  for (int i = 0; i < 4000 && !testing::Test::HasFailure(); ++i) {
    SCOPED_TRACE(i);
    std::vector<std::uint8_t> bytes(16 + splitmix64(state) % 200);
    for (std::uint8_t& byte : bytes) byte = static_cast<std::uint8_t>(splitmix64(state += splitmix64_step));
    expect_sound_or_refused(soup(bytes));
  }
}

}  // namespace
}  // namespace scan2fea
