// The report as one page that needs nothing else: no network, no server, no file beside it.
//
// Its text comes from the report's JSON alone; its pictures, its histograms and its interactive view from the meshes.
// The scripts and their libraries are built into this one (see CMakeLists.txt). The same input gives the same bytes.
#pragma once

#include "quality/element_measures.hpp"
#include "quality/report.hpp"
#include "quality/worst_elements.hpp"

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace scan2fea {

struct ReportPageInput {
  std::string title;
  const Json& report;
  const ElementMeasures& measures;
  const std::vector<MeasuredElements>& histograms;
  const TetMesh* volume_mesh = nullptr;  // that the measures are of
  const SurfaceMesh* reference = nullptr;
  const std::vector<NamedSet>& face_sets;             // of measures.faces
  std::vector<std::uint32_t> worst;                   // elements, as in the report's list
  std::uint64_t first_element = 1;                    // the number of the first one in the file
  const std::vector<std::uint32_t>& element_numbers;  // where those of the file are no row from the first on
};

// O(n log n); about 2 MB for 100,000 triangles, and 0.6 MB of scripts. Surfaces of more than 220,000 triangles are
// thinned in the view, and of more than a million tetrahedra none are shown; the page says so. All else is of all.
std::string report_page(const ReportPageInput& input);

}  // namespace scan2fea
