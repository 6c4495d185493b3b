#include "quality/report_page/view_data.hpp"

#include "quality/picture/colour_maps.hpp"
#include "quality/picture/deflate.hpp"
#include "quality/report_page/packed_arrays.hpp"
#include "quality/report_page/thinned_view.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace scan2fea {
namespace {

using nlohmann::json;

constexpr auto unused = std::numeric_limits<std::uint32_t>::max();
constexpr std::uint16_t no_set = 65535;

// Sets of what no scanner has seen have these names in all files.
constexpr std::array<const char*, 2> made_up_names{"FILLED", "ENRICHED"};

BoundingBox box_of_both(const ViewInput& input) {
  BoundingBox box = bounding_box(input.measures.faces.vertices);
  if (input.reference != nullptr) {
    const BoundingBox other = bounding_box(input.reference->vertices);
    box = {box.low.cwiseMin(other.low), box.high.cwiseMax(other.high)};
  }
  return box;
}

// In steps of a 65535th of the box, which no eye sees.
void add_positions(const std::string& name, const std::vector<Vec3>& points, const BoundingBox& box,
                   PackedArrays& arrays) {
  constexpr double steps = 65535;
  std::vector<std::uint16_t> values;
  values.reserve(3 * points.size());
  for (int k = 0; k < 3; ++k) {
    const double size = box.high[k] - box.low[k];
    for (const Vec3& p : points)
      values.push_back(static_cast<std::uint16_t>(
          size > 0 ? std::lround(std::clamp((p[k] - box.low[k]) / size, 0.0, 1.0) * steps) : 0));
  }
  arrays.add(name, std::span<const std::uint16_t>(values));
}

template <std::size_t n>
void add_elements(const std::string& name, const std::vector<std::array<std::uint32_t, n>>& elements,
                  PackedArrays& arrays) {
  std::vector<std::uint32_t> values;
  values.reserve(n * elements.size());
  for (const auto& element : elements) values.insert(values.end(), element.begin(), element.end());
  arrays.add_indices(name, values, n);
}

template <class Value>
std::vector<Value> picked(const std::vector<Value>& values, const std::vector<std::uint32_t>& origin) {
  std::vector<Value> list;
  list.reserve(origin.size());
  for (const std::uint32_t i : origin) list.push_back(values[i]);
  return list;
}

// Faces and tetrahedra with one list of nodes, since the cut goes through both.
struct ShownResult {
  std::vector<Vec3> nodes;
  std::vector<Triangle> faces;
  std::vector<std::uint32_t> origin;  // of the faces
  std::vector<Tetrahedron> tetrahedra;
  bool is_thinned = false;
};

ShownResult shown_result(const ViewInput& input) {
  const SurfaceMesh& faces = input.measures.faces;
  const bool whole = faces.triangles.size() <= most_triangles_in_view;
  if (input.volume_mesh == nullptr || !whole || input.volume_mesh->tetrahedra.size() > most_tetrahedra_in_view) {
    ThinnedView view = thinned_view(faces, most_triangles_in_view);
    return {std::move(view.mesh.vertices), std::move(view.mesh.triangles), std::move(view.origin), {}, view.is_thinned};
  }
  ShownResult shown{{}, faces.triangles, {}, input.volume_mesh->tetrahedra, false};
  for (std::uint32_t f = 0; f < faces.triangles.size(); ++f) shown.origin.push_back(f);
  std::vector<std::uint32_t> renumbered(faces.vertices.size(), unused);
  for (const Tetrahedron& t : shown.tetrahedra)
    for (const std::uint32_t n : t) renumbered[n] = 0;
  for (std::size_t n = 0; n < renumbered.size(); ++n) {
    if (renumbered[n] == unused) continue;
    renumbered[n] = static_cast<std::uint32_t>(shown.nodes.size());
    shown.nodes.push_back(faces.vertices[n]);
  }
  for (Triangle& t : shown.faces)
    for (std::uint32_t& v : t) v = renumbered[v];
  for (Tetrahedron& t : shown.tetrahedra)
    for (std::uint32_t& v : t) v = renumbered[v];
  return shown;
}

json add_sets(const ViewInput& input, const ShownResult& shown, PackedArrays& arrays) {
  const std::size_t count = input.measures.faces.triangles.size();
  std::vector<std::uint16_t> set_of(count, no_set);
  std::vector<std::uint8_t> made_up(count, 0);
  json names = json::array();
  for (const NamedSet& set : input.face_sets) {
    const auto* const made = std::find(made_up_names.begin(), made_up_names.end(), set.name);
    const auto index = static_cast<std::uint16_t>(names.size());
    if (made == made_up_names.end()) {
      const Rgb colour = category_colour(index);
      names.push_back({{"name", set.name}, {"colour", {colour[0], colour[1], colour[2]}}});
    }
    for (const std::uint32_t f : set.members) {
      if (f >= count) continue;  // of faces between bodies
      if (made != made_up_names.end())
        made_up[f] = static_cast<std::uint8_t>(made - made_up_names.begin() + 1);
      else if (set_of[f] == no_set)
        set_of[f] = index;
    }
  }
  arrays.add("result.set", std::span<const std::uint16_t>(picked(set_of, shown.origin)));
  arrays.add("result.made_up", std::span<const std::uint8_t>(picked(made_up, shown.origin)));
  return names;
}

// Of each measure its bars, and in the arrays the step of each element that is shown: of a triangle's tetrahedron, too.
json add_measures(const ViewInput& input, const ShownResult& shown, PackedArrays& arrays) {
  json list = json::array();
  for (const MeasuredElements& m : input.histograms) {
    const bool of_tetrahedra = m.of == "tetrahedra";
    const std::string name = m.of + "." + m.measure;
    list.push_back({{"name", name},
                    {"measure", m.measure},
                    {"of", m.of},
                    {"low", m.scale.low},
                    {"high", m.scale.high},
                    {"bars", m.scale.bars},
                    {"steps_per_bar", m.scale.steps_per_bar()},
                    {"counts", m.counts}});
    if (!of_tetrahedra) {
      arrays.add(name, std::span<const std::uint16_t>(picked(m.steps, shown.origin)));
    } else if (!shown.tetrahedra.empty()) {
      arrays.add(name, std::span<const std::uint16_t>(m.steps));
    } else {  // those at the surface, which are all that is shown
      std::vector<std::uint32_t> behind;
      for (const std::uint32_t f : shown.origin) behind.push_back(input.volume_mesh->boundary[f].tetrahedron);
      arrays.add(name + ".behind", std::span<const std::uint16_t>(picked(m.steps, behind)));
    }
  }
  return list;
}

void add_reference(const ViewInput& input, const BoundingBox& box, PackedArrays& arrays, json& description) {
  if (input.reference == nullptr) return;
  const ThinnedView view = thinned_view(*input.reference, most_triangles_in_view);
  description["reference"] = {{"triangles", input.reference->triangles.size()},
                              {"shown", view.mesh.triangles.size()},
                              {"is_thinned", view.is_thinned}};
  add_positions("reference.positions", view.mesh.vertices, box, arrays);
  add_elements("reference.triangles", view.mesh.triangles, arrays);
  const MeasuredElements steps =
      count_elements("deviation", "reference", picked(input.measures.deviation_of_reference, view.origin),
                     input.histograms.front().scale);  // that of the deviation
  arrays.add("reference.deviation", std::span<const std::uint16_t>(steps.steps));
}

json worst_of(const ViewInput& input) {
  json list = json::array();
  for (const std::uint32_t e : input.worst) {
    json corners = json::array();
    const auto add = [&](std::uint32_t node) {
      const Vec3& p = input.measures.faces.vertices[node];
      corners.push_back({p.x(), p.y(), p.z()});
    };
    if (input.volume_mesh != nullptr)
      std::ranges::for_each(input.volume_mesh->tetrahedra[e], add);
    else
      std::ranges::for_each(input.measures.faces.triangles[e], add);
    list.push_back({{"index", e}, {"corners", std::move(corners)}});
  }
  return list;
}

json map_of(const ColourMap& map) {
  std::string bytes;
  for (const Rgb& colour : map) bytes.append(colour.begin(), colour.end());
  return base64(bytes);
}

}  // namespace

ViewData view_data(const ViewInput& input) {
  const BoundingBox box = box_of_both(input);
  const ShownResult shown = shown_result(input);
  PackedArrays arrays;
  json description{{"low", {box.low.x(), box.low.y(), box.low.z()}},
                   {"high", {box.high.x(), box.high.y(), box.high.z()}},
                   {"first_element", input.first_element},
                   {"diverging", map_of(diverging_colours())},
                   {"sequential", map_of(sequential_colours())},
                   {"neutral", {neutral_colour[0], neutral_colour[1], neutral_colour[2]}}};
  add_positions("result.positions", shown.nodes, box, arrays);
  add_elements("result.triangles", shown.faces, arrays);
  std::vector<std::uint32_t> element;
  for (const std::uint32_t f : shown.origin)
    element.push_back(input.volume_mesh != nullptr ? input.volume_mesh->boundary[f].tetrahedron : f);
  arrays.add_indices("result.element", element, 1);
  if (!input.element_numbers.empty()) arrays.add_indices("element_numbers", input.element_numbers, 1);
  if (!shown.tetrahedra.empty()) add_elements("result.tetrahedra", shown.tetrahedra, arrays);
  description["result"] = {{"is_volume", input.volume_mesh != nullptr},
                           {"is_curved", input.volume_mesh != nullptr && input.volume_mesh->order() == 2},
                           {"triangles", input.measures.faces.triangles.size()},
                           {"shown", shown.faces.size()},
                           {"is_thinned", shown.is_thinned},
                           {"tetrahedra", input.volume_mesh != nullptr ? input.volume_mesh->tetrahedra.size() : 0},
                           {"tetrahedra_shown", shown.tetrahedra.size()}};
  description["sets"] = add_sets(input, shown, arrays);
  description["measures"] = add_measures(input, shown, arrays);
  add_reference(input, box, arrays, description);
  description["worst"] = worst_of(input);
  description["arrays"] = arrays.directory();
  return {std::move(description), arrays.text()};
}

}  // namespace scan2fea
