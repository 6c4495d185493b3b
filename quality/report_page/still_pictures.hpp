// The pictures of a report that need no script: three views and the worst place.
#pragma once

#include "quality/element_measures.hpp"
#include "quality/report_page/colour_maps.hpp"

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

// The colour of each step's bar.
Rgb colour_of_step(const MeasuredElements& measure, std::uint16_t step);

}  // namespace scan2fea
