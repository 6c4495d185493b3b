#include "preproc/volume/face_links.hpp"

#include <algorithm>

namespace scan2fea {
namespace {

// A face of a tetrahedron or a surface triangle, known by its two larger corners within the bucket of its least one.
struct Entry {
  std::uint64_t larger_corners;
  std::uint32_t owner;
  std::uint32_t corner;  // 4 for a surface triangle
};

constexpr std::uint32_t surface = 4;

struct SortedFace {
  std::uint32_t least;
  std::uint64_t larger;
};

SortedFace sorted(Triangle t) {
  std::sort(t.begin(), t.end());
  return {t[0], (std::uint64_t{t[1]} << 32) | t[2]};
}

}  // namespace

FaceLinks link_faces(const std::vector<Tetrahedron>& tetrahedra, const std::vector<Triangle>& triangles,
                     std::size_t node_count) {
  std::vector<std::size_t> bucket(node_count + 1, 0);
  for (const Tetrahedron& t : tetrahedra)
    for (std::size_t k = 0; k < 4; ++k) ++bucket[sorted(face_opposite(t, k)).least + 1];
  for (const Triangle& t : triangles) ++bucket[sorted(t).least + 1];
  for (std::size_t v = 0; v < node_count; ++v) bucket[v + 1] += bucket[v];

  std::vector<Entry> entries(bucket[node_count]);
  std::vector<std::size_t> next(bucket.begin(), bucket.end() - 1);
  const auto add = [&](const Triangle& t, std::uint32_t owner, std::uint32_t corner) {
    const SortedFace face = sorted(t);
    entries[next[face.least]++] = {face.larger, owner, corner};
  };
  for (std::uint32_t i = 0; i < tetrahedra.size(); ++i)
    for (std::uint32_t k = 0; k < 4; ++k) add(face_opposite(tetrahedra[i], k), i, k);
  for (std::uint32_t i = 0; i < triangles.size(); ++i) add(triangles[i], i, surface);

  FaceLinks links;
  links.neighbour.assign(tetrahedra.size(), {no_link, no_link, no_link, no_link});
  links.triangle = links.neighbour;
  for (std::size_t v = 0; v < node_count; ++v) {
    const auto begin = entries.begin() + static_cast<std::ptrdiff_t>(bucket[v]);
    const auto end = entries.begin() + static_cast<std::ptrdiff_t>(bucket[v + 1]);
    // The order within a face (tetrahedra, then its triangle) follows from the order of insertion.
    std::stable_sort(begin, end, [](const Entry& a, const Entry& b) { return a.larger_corners < b.larger_corners; });
    for (auto first = begin; first != end;) {
      const auto last =
          std::find_if(first, end, [&](const Entry& e) { return e.larger_corners != first->larger_corners; });
      const auto sides_end = std::find_if(first, last, [](const Entry& e) { return e.corner == surface; });
      if (sides_end - first >= 2) {
        links.neighbour[first[0].owner][first[0].corner] = first[1].owner;
        links.neighbour[first[1].owner][first[1].corner] = first[0].owner;
      }
      if (sides_end != last)
        for (auto side = first; side != sides_end; ++side) links.triangle[side->owner][side->corner] = sides_end->owner;
      first = last;
    }
  }
  return links;
}

}  // namespace scan2fea
