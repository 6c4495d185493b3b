// How often a surface, open or not, winds about a point: 1 inside of what it encloses, 0 outside, and in between where
// it has holes. Source: Jacobson, Kavan, Sorkine-Hornung, "Robust inside-outside segmentation using generalized winding
// numbers", 2013; far triangles are taken together as in Barill et al., "Fast winding numbers for soups and clouds",
// 2018, here by their first moment alone.
#pragma once

#include "preproc/mesh/surface_mesh.hpp"

#include <cstdint>
#include <vector>

namespace scan2fea {

class WindingNumber {
 public:
  // Of triangles that are counter-clockwise seen from outside. O(n log n).
  WindingNumber(const std::vector<Vec3>& points, const std::vector<Triangle>& triangles);

  // Within a few hundredths. O(log n); from any number of threads.
  double operator()(const Vec3& p) const;

 private:
  struct Node {
    Vec3 centre = Vec3::Zero();       // of its triangles, by area
    Vec3 area_vector = Vec3::Zero();  // sum
    double radius = 0;                // of a ball about the centre that holds all its triangles
    std::uint32_t first = 0, last = 0;
    std::uint32_t left = 0, right = 0;  // 0: a leaf
  };
  struct Corners {
    Vec3 a, b, c;
  };

  std::uint32_t build(std::uint32_t first, std::uint32_t last);
  double of_node(std::uint32_t node, const Vec3& p) const;

  std::vector<Corners> triangles_;
  std::vector<Node> nodes_;
};

}  // namespace scan2fea
