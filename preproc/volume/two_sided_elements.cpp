#include "preproc/volume/two_sided_elements.hpp"

#include "preproc/volume/max_min_relocation.hpp"
#include "preproc/volume/vertex_insertion.hpp"

#include <algorithm>
#include <limits>

namespace scan2fea {
namespace {

// Of goal_quality: a straight element that is to be curved needs some to lose.
constexpr double least_of_before = 0.5, least_quality = 0.9;
constexpr int relocation_sweeps = 3, relocation_steps = 8;

// Whether two faces of the element are on the boundary and meet at an edge that is no crease.
bool is_two_sided(const TetComplex::Element& element, std::span<const std::array<std::uint32_t, 2>> creases) {
  const auto is_boundary = [&](std::size_t k) { return (element.link[k] & TetComplex::boundary_bit) != 0; };
  for (std::size_t i = 0; i < 4; ++i)
    for (std::size_t j = i + 1; j < 4; ++j) {
      if (!is_boundary(i) || !is_boundary(j)) continue;
      // The edge of both is between the other two corners.
      std::array<std::uint32_t, 2> edge;
      std::size_t n = 0;
      for (std::size_t k = 0; k < 4; ++k)
        if (k != i && k != j) edge[n++] = element.corners[k];
      if (edge[0] > edge[1]) std::swap(edge[0], edge[1]);
      if (!std::ranges::binary_search(creases, edge)) return true;
    }
  return false;
}

void relocate(TetComplex& complex, std::uint32_t v, std::vector<std::uint32_t>& around, StarFaces& faces) {
  double quality = look_from(complex, v, around, faces);
  Vec3 place = complex.node(v);
  if (relocate_max_min(faces, place, quality, relocation_steps)) complex.move_node(v, place, around);
}

}  // namespace

std::size_t part_two_sided_elements(TetMesh& mesh, std::size_t kept,
                                    std::span<const std::array<std::uint32_t, 2>> creases) {
  TetComplex complex(mesh);
  VertexInsertion insertion;
  std::size_t parted = 0;
  const auto first_new = static_cast<std::uint32_t>(complex.node_count());
  for (std::uint32_t t = 0; t < complex.slot_count(); ++t)
    if (complex.alive(t) && is_two_sided(complex.element(t), creases))
      parted += insertion.mend(complex, t, least_of_before, least_quality);
  if (parted == 0) return 0;
  std::vector<std::uint32_t> around, star;
  StarFaces faces;
  for (int sweep = 0; sweep < relocation_sweeps; ++sweep)
    for (std::uint32_t v = first_new; v < complex.node_count(); ++v) {
      if (!complex.used(v)) continue;
      relocate(complex, v, around, faces);
      complex.star(v, star);
      std::vector<std::uint32_t> beside;
      for (const std::uint32_t t : star)
        for (const std::uint32_t w : complex.element(t).corners)
          if (w != v && !complex.fixed(w)) beside.push_back(w);
      std::sort(beside.begin(), beside.end());
      beside.erase(std::unique(beside.begin(), beside.end()), beside.end());
      for (const std::uint32_t w : beside) relocate(complex, w, around, faces);
    }
  mesh = complex.to_mesh(kept);
  return parted;
}

}  // namespace scan2fea
