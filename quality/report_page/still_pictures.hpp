// The pictures of a report that need no script: three views and the worst place.
#pragma once

#include "quality/element_measures.hpp"
#include "quality/picture/element_colours.hpp"

#include <optional>
#include <string>
#include <vector>

namespace scan2fea {

struct StillPicture {
  std::string png;
  std::string title;
};

// Where the close-up looks, and what it shows.
struct CloseUp {
  Vec3 place;
  std::string title;
};

// Coloured by deviation where there is a reference, otherwise by the shape of the elements. None of a mesh without
// triangles.
std::vector<StillPicture> still_pictures(const ElementMeasures& measures, const TetMesh* volume_mesh,
                                         const std::vector<MeasuredElements>& histograms,
                                         const std::optional<CloseUp>& close_up);

// What their colours mean: the measure, as in `histograms`.
const MeasuredElements& pictured_measure(const std::vector<MeasuredElements>& histograms);

}  // namespace scan2fea
