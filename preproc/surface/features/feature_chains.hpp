// The chains that sharp edges form: which weaker edges continue them, and which are too short to mean anything.
#pragma once

#include "preproc/mesh/surface_mesh.hpp"
#include "preproc/surface/kernel/adjacency.hpp"

#include <cstdint>
#include <span>
#include <vector>

namespace scan2fea {

// An interior edge and the angle between the normals of its faces.
struct CreaseEdge {
  FeatureEdge ends;
  double angle_deg;               // by which it may be sharp itself
  double continuation_angle_deg;  // by which it may continue a chain
};

class CreaseChains {
 public:
  // `neighbours`: see face_neighbours; `edges`: those that may be marked, sorted. Keeps a reference to the scan.
  CreaseChains(const SurfaceMesh& scan, const std::vector<Triangle>& neighbours, std::vector<CreaseEdge> edges);

  void mark_above(double angle_deg);

  // Where a chain ends (at a vertex with one marked edge), the sharpest edge above the angle that goes on in its
  // direction, within 45°, is marked too, and so on until there is none or another chain is met. Facets' edges that
  // merely touch a chain are not in its direction, nor at its end.
  void continue_ends(double angle_deg);

  // Unmarks chains with a free end (not on the scan's border) that are shorter.
  void drop_free_ends(double shortest);

  // Unmarks loops and nets of chains whose total length is below, unless they are sharper than the angle in the mean.
  void drop_small_nets(double shortest, double sharp_deg);

  std::vector<FeatureEdge> marked() const;

 private:
  std::span<const std::uint32_t> at(std::uint32_t v) const {
    return {star_.data() + first_[v], first_[v + 1] - first_[v]};
  }
  std::uint32_t other_end(std::uint32_t edge, std::uint32_t v) const {
    const FeatureEdge& e = edges_[edge].ends;
    return e[0] == v ? e[1] : e[0];
  }
  void set(std::uint32_t edge, bool marked);
  // The one marked edge at v where its degree is 1.
  std::uint32_t marked_edge_at(std::uint32_t v, std::uint32_t except) const;
  void extend_from(std::uint32_t v, double angle_deg);

  const SurfaceMesh& scan_;
  std::vector<CreaseEdge> edges_;
  std::vector<double> length_;
  std::vector<std::uint32_t> first_;  // the edges at each vertex, as a flat array
  std::vector<std::uint32_t> star_;
  std::vector<char> marked_;
  std::vector<std::uint32_t> degree_;  // marked edges per vertex
  std::vector<char> on_border_;
};

}  // namespace scan2fea
