// Scans that are larger than memory, thinned block by block as they are read.
#pragma once

#include "preproc/mesh/surface_mesh.hpp"
#include "preproc/surface/thinning/cluster_seeds.hpp"
#include "preproc/surface/thinning/facet_chain.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

namespace scan2fea {

struct ThinnedSurface {
  SurfaceMesh mesh;
  std::vector<std::uint32_t> origin;  // per triangle the first of the given ones that became it
  // What the faces enclose, each as often as it was given; nothing where they have a border. Model units cubed.
  std::optional<double> volume;
  // No point of the given surface is farther from this one, nor any of this one from the given: a bound, model units.
  double largest_distance = 0;
  Vec3 farthest = Vec3::Zero();  // of the given surface, about, where the bound is reached
};

// All vertices that are nearest to a seed become one, where it fits best to the planes of the triangles about them
// (Lindstrom, "Out-of-core simplification of large polygonal models", 2000; quadrics of Garland and Heckbert, 1997), as
// far as the planes agree: of noise, which has no such place, it is their mean. Triangles that lose a corner go, and so
// do pairs of opposite ones, as both sides of a wall thinner than the seeds are apart. What was closed stays so, but
// where noise is wider than that; crossings may come about, which are the repair's. 200 bytes a seed and none for what
// was given; a microsecond a triangle. The result depends on nothing but the triangles and their order.
class VertexClusters {
 public:
  explicit VertexClusters(ClusterSeeds seeds);

  // More triangles of the surface that the seeds are of, behind those before.
  void add(const SurfaceMesh& block);

  ThinnedSurface surface() &&;

 private:
  // In units of the seeds' cells, from the seed.
  struct Cluster {
    std::array<float, 6> planes{};                   // sum of n n^T, by area: xx, xy, xz, yy, yz, zz
    Eigen::Vector3f pull = Eigen::Vector3f::Zero();  // of n (n . p)
    float squares = 0;                               // of (n . p)^2
    Eigen::Vector3f sum = Eigen::Vector3f::Zero();   // of corners
    Eigen::Vector3f low = Eigen::Vector3f::Zero(), high = Eigen::Vector3f::Zero();
    std::uint32_t corners = 0;
  };
  using Edge = std::array<std::uint32_t, 2>;  // clusters, in rising order

  struct Corner {
    std::uint32_t cluster;
    Eigen::Vector3f from_seed;
  };

  Corner corner_at(const Vec3& p, std::uint32_t vertex);
  void gather(const std::array<Corner, 3>& corners, const Vec3& area_vector);
  void add_image(const std::array<Corner, 3>& corners);
  void compact_edges();
  static Eigen::Vector3f place(const Cluster& cluster);
  static float reach(const Cluster& cluster, const Eigen::Vector3f& place);
  std::vector<Triangle> lost_images(const std::vector<Facet>& facets) const;

  ClusterSeeds seeds_;
  std::vector<Cluster> clusters_;
  // Of vertices of a block, at their number's last bits: six triangles ask for each.
  struct Known {
    std::uint32_t vertex, cluster;
  };
  std::vector<Known> known_;
  FacetChain facets_;
  std::vector<Edge> edges_;  // of triangles that became one
  std::size_t edges_when_compact_ = 0;
  std::uint32_t given_ = 0;
};

}  // namespace scan2fea
