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

// Coloured by deviation where there is a reference, otherwise by the shape of the elements. `worst_place`: where the
// close-up looks. None of a mesh without triangles.
std::vector<StillPicture> still_pictures(const ElementMeasures& measures, const TetMesh* volume_mesh,
                                         const std::vector<MeasuredElements>& histograms,
                                         const std::optional<Vec3>& worst_place);

// What their colours mean: the measure, as in `histograms`.
const MeasuredElements& pictured_measure(const std::vector<MeasuredElements>& histograms);

}  // namespace scan2fea
