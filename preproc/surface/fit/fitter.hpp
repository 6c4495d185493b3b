// The state of a fit (shape_fit.hpp): where the samples of each side lie on the other, condensed to moments, and the
// steps that move vertices by them.
#pragma once

#include "preproc/surface/features/feature_net.hpp"
#include "preproc/surface/fit/fit_moments.hpp"
#include "preproc/surface/fit/reference_surface.hpp"
#include "preproc/surface/fit/sample_surface.hpp"
#include "preproc/surface/fit/shape_fit_options.hpp"
#include "preproc/surface/kernel/adjacency.hpp"
#include "preproc/surface/kernel/locate.hpp"

#include <Eigen/Core>

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace scan2fea {

class Fitter {
 public:
  // Keeps references to all of them. `patch_of_vertex`: of the mesh, empty where the scan has none.
  Fitter(SurfaceMesh& mesh, const ReferenceSurface& scan, const ShapeFitOptions& options,
         std::vector<std::uint32_t> patch_of_vertex);

  // The dial between shape and fit, of the diagonal; from the next location on.
  void set_fidelity(double fidelity);

  // The same as `factor` times the RMS distance over the diagonal, each body's own, between the given fidelity and the
  // loosest; returns that of all. After a location.
  double set_fidelity_by_residual(double factor, double loosest, const ShapeFitResult& located);

  // Of equilateral triangles.
  double mean_edge() const { return mean_edge_; }

  // Locates all samples anew, condenses them, and measures how far they are.
  void locate_samples(ShapeFitResult& result);

  // One Gauss-Seidel sweep of Newton steps over all free vertices, by so many times what they ask for, as in successive
  // over-relaxation; returns the largest step.
  double sweep(double over_relaxation);

  // Moves a vertex, which is there in several copies.
  void put(std::span<const std::uint32_t> copies, const Vec3& point);

  // One Newton step, along its line, of a vertex that is there in several copies; not beyond `backward` and `forward`
  // (distances), and only to where the energy is lower.
  void slide(const FeatureLine& line, double& place, std::span<const std::uint32_t> copies, double backward,
             double forward);

 private:
  // Samples by the face they lie on: those of face f are order[first[f]] .. order[first[f + 1]].
  struct ByFace {
    std::vector<std::uint32_t> first;
    std::vector<std::uint32_t> order;
  };
  static ByFace sort_by_face(const std::vector<Location>& locations, std::size_t faces);

  // Of the faces around a vertex.
  double energy(std::span<const std::uint32_t> copies) const;
  std::array<Vec3, 3> moved_corners(const Triangle& t) const;

  bool is_free(std::uint32_t v) const {
    return options_.constraints.empty() || options_.constraints[v] == VertexConstraint::free;
  }
  bool has_free_vertex(std::size_t f) const;

  // Whether samples whose search starts at the vertex can matter to a free one: two rings is as far as they walk.
  std::vector<bool> vertices_of_interest() const;

  void start_locations();
  void sort_samples();
  void locate_faces(const ByFace& by_face);

  // The factor on a sample's weight by its distance, see ShapeFitOptions::lift_tail_of_diagonal.
  double lift(double squared_distance) const;
  // That the face lies on.
  std::size_t body_of(const ByFace& by_face, std::size_t f) const;
  double condense(const ByFace& by_face, std::size_t f);  // returns the largest squared distance of its samples
  void condense_all(const ByFace& by_face, ShapeFitResult& result);
  void measure(ShapeFitResult& result);
  void measure_bodies();

  // Adds the derivatives of the energy by the place of v. False where a face around it has no area.
  bool add_star(std::uint32_t v, Vec3& gradient, Eigen::Matrix3d& hessian, double& least_squared_length) const;
  double move(std::uint32_t v, double over_relaxation);

  SurfaceMesh& mesh_;
  const ReferenceSurface& scan_;
  const ShapeFitOptions& options_;
  std::vector<std::uint32_t> patch_of_vertex_;
  VertexStars stars_;
  std::vector<Triangle> neighbours_;
  std::vector<std::vector<std::uint32_t>> colours_;
  double mean_edge_;
  double weight_unit_ = 0;
  double tail_ = 0;                                        // model units
  std::vector<double> weight_of_body_, distance_of_body_;  // by ReferenceSurface's bodies; one weight for one body
  SurfaceSamples forward_;
  std::vector<Vec3> normals_;
  std::vector<Location> locations_;                // of the scan's samples on the mesh
  std::vector<Location> on_scan_;                  // of the mesh's samples on the scan, four a face
  std::vector<double> squared_, squared_on_scan_;  // distances of both
  std::vector<Vec3> located_;                      // the vertices when the samples were located
  std::vector<FaceFit> fits_;
  std::vector<PointFit> point_fits_;
};

}  // namespace scan2fea
