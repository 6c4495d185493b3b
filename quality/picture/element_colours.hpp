// By what the elements of a picture are coloured, and what the colours mean. They are the report's.
#pragma once

#include "preproc/mesh/named_sets.hpp"
#include "quality/element_measures.hpp"
#include "quality/histogram.hpp"
#include "quality/picture/colour_maps.hpp"

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace scan2fea {

// Either a ramp or names.
struct Legend {
  std::string title;
  double low = 0, high = 1;
  std::vector<Rgb> ramp;  // from low to high
  bool is_open = false;   // what lies beyond has the colours of the ends
  bool has_gaps = false;  // what has no value is grey
  struct Entry {
    std::string name;
    Rgb colour;
  };
  std::vector<Entry> names;

  bool empty() const { return ramp.empty() && names.empty(); }
};

struct ElementColours {
  std::vector<Rgb> of_faces;       // per triangle of ElementMeasures::faces
  std::vector<Rgb> of_tetrahedra;  // where the colours are those of tetrahedra: per tetrahedron
  Legend legend;
};

// The colour of each step's bar.
Rgb colour_of_step(const MeasuredElements& measure, std::uint16_t step);

// The one by this name, of tetrahedra where they have it; null where there is none.
const MeasuredElements* find_measure(const std::vector<MeasuredElements>& histograms, std::string_view name);

// `title`: of the legend. `tetrahedron_of`: per face, where the measure is of tetrahedra.
ElementColours colours_of_measure(const MeasuredElements& measure, std::string title,
                                  std::span<const std::uint32_t> tetrahedron_of);

// By the first set that a face is in, without those of what was made up; and by those.
ElementColours colours_of_sets(std::span<const NamedSet> sets, std::size_t faces);
ElementColours colours_of_made_up(std::span<const NamedSet> sets, std::size_t faces);

}  // namespace scan2fea
