// The importance function I_f of a scan: which of its points ask for another one beside them, and on which side.
// Source: [1], section 2 (README.md lists the sources). A point is content if it has more than K neighbours within the
// sampling radius R_s, or if they leave no sector of 90 degrees empty; a point that is not asks for a new one on the
// bisector of its widest empty sector.
#pragma once

#include "preproc/surface/enrichment/side_normals.hpp"
#include "preproc/surface/enrichment/surface_walk.hpp"
#include "preproc/surface/kernel/halfedge_mesh.hpp"
#include "preproc/surface/kernel/tangent_frame.hpp"

#include <array>
#include <cstddef>
#include <span>
#include <vector>

namespace scan2fea {

// Cosine of 102 degrees. Vertices whose normals turn farther from one another are on two sheets and no neighbours: the
// sides of a right-angled edge still see each other, those of a thin wall do not.
inline constexpr double smallest_neighbour_cosine = -0.2;

// Which of the six sectors of 60 degrees around a point of a tangent plane hold another point: where no two that adjoin
// are empty, the points surround it.
class FilledSectors {
 public:
  FilledSectors(const Vec3& origin, const Vec3& normal) : origin_(origin), frame_(normal) {}

  void add(const Vec3& p);
  bool surrounded() const;

 private:
  Vec3 origin_;
  TangentFrame frame_;
  std::array<bool, 6> filled_{};
};

struct ImportanceOptions {
  double sampling_radius = 0;       // R_s, model units
  std::size_t most_neighbours = 6;  // K
  double empty_sector_deg = 90;
};

class Importance {
 public:
  using Index = HalfedgeMesh::Index;

  // Keeps references to both and reads them as they are when asked.
  Importance(const HalfedgeMesh& mesh, const SideNormals& normals) : mesh_(mesh), normals_(normals), nearest_(mesh) {}

  // The bisectors of the empty sectors of v, widest first, as unit vectors of its tangent plane; none where v is
  // content. Beyond a border nothing is missing. The search ends at neighbour K + 1, however many there are.
  std::vector<Vec3> empty_sectors(Index v, const ImportanceOptions& options);

  // Of the distances of the sixth neighbour, over those of the vertices that have one; 0 where none has.
  double median_spacing(std::span<const Index> vertices);

 private:
  // Visits the vertices near v on its own sheet, v left out.
  template <class Visit>
  void search_from(Index v, double radius, Visit visit);

  // In the frame at v.
  double angle_to(Index v, const TangentFrame& frame, const Vec3& p) const;
  Vec3 far_end_of_longest_edge(Index v) const;
  void fill_outside(Index v, const TangentFrame& frame, std::vector<double>& angles) const;

  const HalfedgeMesh& mesh_;
  const SideNormals& normals_;
  NearestOnSurface nearest_;
};

}  // namespace scan2fea
