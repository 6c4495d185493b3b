// What the page's interactive view shows, as the page carries it.
#pragma once

#include "quality/element_measures.hpp"
#include "quality/worst_elements.hpp"

#include <nlohmann/json.hpp>

#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace scan2fea {

// More are thinned, or, of tetrahedra, left out: what a browser on a laptop turns smoothly, in a page of a few MB.
inline constexpr std::size_t most_triangles_in_view = 220'000, most_tetrahedra_in_view = 1'000'000;

struct ViewInput {
  const ElementMeasures& measures;
  const std::vector<MeasuredElements>& histograms;
  const TetMesh* volume_mesh = nullptr;
  const SurfaceMesh* reference = nullptr;
  const std::vector<NamedSet>& face_sets;  // of measures.faces
  std::vector<std::uint32_t> worst;        // elements: tetrahedra, or triangles of a surface
  std::uint64_t first_element = 1;         // the number of the first one in the file
  // Those of the file, where they are no row from the first on.
  const std::vector<std::uint32_t>& element_numbers;
};

struct ViewData {
  nlohmann::json description;  // see view_data.cpp
  std::string arrays;          // base64
};

ViewData view_data(const ViewInput& input);

}  // namespace scan2fea
