#include "quality/picture/element_colours.hpp"

#include <algorithm>
#include <array>
#include <utility>

namespace scan2fea {
namespace {

// As in the page's view; see view_data.cpp.
const std::array<Legend::Entry, 2> made_up_entries{{{"FILLED", {196, 90, 40}}, {"ENRICHED", {62, 120, 178}}}};

bool is_made_up(const NamedSet& set) {
  return std::ranges::any_of(made_up_entries, [&](const auto& entry) { return entry.name == set.name; });
}

void paint(std::span<const std::uint32_t> faces, const Rgb& colour, std::vector<bool>& is_painted,
           std::vector<Rgb>& colours) {
  for (const std::uint32_t f : faces) {
    if (f >= colours.size() || is_painted[f]) continue;  // beyond are those between bodies
    is_painted[f] = true;
    colours[f] = colour;
  }
}

ElementColours unpainted(std::string title, std::size_t faces) {
  ElementColours colours;
  colours.of_faces.assign(faces, neutral_colour);
  colours.legend.title = std::move(title);
  return colours;
}

}  // namespace

Rgb colour_of_step(const MeasuredElements& measure, std::uint16_t step) {
  if (step == no_step) return neutral_colour;
  const double share = step / (static_cast<double>(measure.scale.bars) * measure.scale.steps_per_bar());
  if (measure.measure == "deviation") return diverging_colours()[static_cast<std::size_t>(255 * share)];
  const bool large_is_bad = measure.measure == "edge_ratio" || measure.measure == "max_dihedral_deg";
  return sequential_colours()[static_cast<std::size_t>(255 * (large_is_bad ? share : 1 - share))];
}

const MeasuredElements* find_measure(const std::vector<MeasuredElements>& histograms, std::string_view name) {
  const auto found = std::find_if(histograms.rbegin(), histograms.rend(),  // those of tetrahedra are behind
                                  [&](const MeasuredElements& m) { return m.measure == name; });
  return found == histograms.rend() ? nullptr : &*found;
}

ElementColours colours_of_measure(const MeasuredElements& measure, std::string title,
                                  std::span<const std::uint32_t> tetrahedron_of) {
  ElementColours colours;
  std::vector<Rgb> list;
  list.reserve(measure.steps.size());
  for (const std::uint16_t step : measure.steps) list.push_back(colour_of_step(measure, step));
  if (measure.of == "tetrahedra") {
    for (const std::uint32_t t : tetrahedron_of) colours.of_faces.push_back(list[t]);
    colours.of_tetrahedra = std::move(list);
  } else {
    colours.of_faces = std::move(list);
  }
  colours.legend = {.title = std::move(title),
                    .low = measure.scale.low,
                    .high = measure.scale.high,
                    .ramp = {},
                    .is_open = measure.beyond > 0,
                    .has_gaps = std::ranges::find(measure.steps, no_step) != measure.steps.end(),
                    .names = {}};
  const int last = measure.scale.bars * measure.scale.steps_per_bar() - 1;
  constexpr int stops = 256;
  for (int i = 0; i < stops; ++i)
    colours.legend.ramp.push_back(colour_of_step(measure, static_cast<std::uint16_t>(last * i / (stops - 1))));
  return colours;
}

ElementColours colours_of_sets(std::span<const NamedSet> sets, std::size_t faces) {
  ElementColours colours = unpainted("Set of faces", faces);
  std::vector<bool> is_painted(faces, false);
  for (const NamedSet& set : sets) {
    if (is_made_up(set)) continue;
    const Rgb colour = category_colour(colours.legend.names.size());
    colours.legend.names.push_back({set.name, colour});
    paint(set.members, colour, is_painted, colours.of_faces);
  }
  return colours;
}

ElementColours colours_of_made_up(std::span<const NamedSet> sets, std::size_t faces) {
  ElementColours colours = unpainted("Where a face comes from", faces);
  colours.legend.names = {
      {"measured", neutral_colour}, {"filled", made_up_entries[0].colour}, {"enriched", made_up_entries[1].colour}};
  std::vector<bool> is_painted(faces, false);
  for (const Legend::Entry& entry : made_up_entries)
    for (const NamedSet& set : sets)
      if (set.name == entry.name) paint(set.members, entry.colour, is_painted, colours.of_faces);
  return colours;
}

}  // namespace scan2fea
