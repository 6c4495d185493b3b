// The least squares of fit_curves.hpp.
#pragma once

#include "preproc/surface/curved/curved_surface.hpp"
#include "preproc/surface/fit/reference_surface.hpp"
#include "preproc/surface/fit/sample_surface.hpp"
#include "preproc/surface/kernel/locate.hpp"

#include <Eigen/SparseCore>

#include <cstdint>
#include <vector>

namespace scan2fea {

class CurveFitter {
 public:
  // `cut`: the same faces cut open along the lines, so that no sample is looked for across one. `patch_of_face`: empty
  // without lines. Keeps references to both surfaces and the scan.
  CurveFitter(CurvedSurface& surface, CurvedSurface& cut, const std::vector<std::uint32_t>& patch_of_face,
              const ReferenceSurface& scan);

  // Locates the samples, then moves each node along its direction (zero: it stays) to where the sum of squares is
  // least.
  void step(const std::vector<Vec3>& directions);

 private:
  struct Equations {
    std::array<double, 36> matrix{};
    std::array<double, 6> right{};
  };

  void sample_scan(const std::vector<std::uint32_t>& patch_of_face);
  void locate_samples();
  void follow_surface();
  Equations equations_of(std::size_t face, const std::vector<Vec3>& directions) const;
  void solve(const std::vector<Equations>& of_face, const std::vector<Vec3>& directions);

  CurvedSurface& surface_;
  CurvedSurface& cut_;
  const ReferenceSurface& scan_;
  double mean_edge_;
  std::vector<double> edge_of_face_;  // of an equilateral triangle of its area
  std::vector<double> edge_of_node_;  // of its smallest face
  SurfaceSamples samples_;
  std::vector<std::uint32_t> face_of_sample_;  // of the four times finer surface
  std::vector<Location> locations_;            // on the curved faces
  std::vector<std::uint32_t> first_, order_;   // samples by face
};

}  // namespace scan2fea
