#include "preproc/named_parts.hpp"

#include "preproc/mesh/error.hpp"
#include "preproc/surface/faces/carry_sets.hpp"
#include "preproc/surface/kernel/nearest.hpp"

#include <algorithm>
#include <cstdint>
#include <span>
#include <string>
#include <utility>

namespace scan2fea {
namespace {

FeatureOptions features_of(const PipelineOptions& options) {
  return options.simplify ? options.simplify->features : FeatureOptions{};
}

// The given sets on the surface that is to be simplified: by the nearest triangle where it is another one.
std::vector<NamedSet> sets_on(const SurfaceMesh& scan, const SurfaceMesh& given, const std::vector<NamedSet>& sets) {
  if (sets.empty() || scan.triangles == given.triangles) return sets;
  return carried_sets(sets, nearest_faces(centroids(scan), given));
}

std::vector<NamedSelection> with_given(std::vector<NamedSelection> selections, const std::vector<NamedSet>& given,
                                       std::size_t triangles) {
  std::vector<NamedSet> taken;
  for (const NamedSelection& s : selections) taken.push_back({s.name, {}});
  for (const NamedSet& set : given) {
    if (find_set(taken, set.name) < taken.size() || set.members.empty() || set.members.size() == triangles) continue;
    NamedSelection& added = selections.emplace_back();
    added.name = added.selection.text = set.name;
  }
  return selections;
}

NotMeshable nothing_left(const std::string& set, std::optional<double> area) {
  return NotMeshable({.what = "nothing is left of the set " + set,
                      .where = {},
                      .value = area ? "area " + std::to_string(*area) : "",
                      .limit = {},
                      .advice = "smaller triangles (--deviation, --faces, --size-ball), --method lattice"});
}

// The selected sets on a surface that was made of the scan, with these lines.
std::vector<NamedSet> sets_on_surface(const SelectedScan& selected, const SurfaceMesh& surface,
                                      const std::vector<FeatureEdge>& lines) {
  const std::vector<std::uint32_t> label = carry_labels(selected.mesh, selected.of_triangle, surface, lines);
  // One triangle of the scan for each label: in the same sets as all others.
  std::vector<std::uint32_t> example;
  for (std::uint32_t f = 0; f < selected.of_triangle.size(); ++f)
    if (selected.of_triangle[f] == example.size()) example.push_back(f);
  std::vector<std::uint32_t> origin;
  for (const std::uint32_t l : label) origin.push_back(example[l]);
  return carried_sets(selected.sets, origin);
}

// Of all faces but a single one. They add no lines: creases are lines of the mesh already, and where two faces join
// without a crease the sets end between triangles, each of which goes to the face that most of it lies on.
void name_faces(const SelectedScan& selected, const SimplifyResult& simplified, PipelineResult& result) {
  const std::vector<SurfaceFace>& faces = selected.faces.list;
  if (faces.size() < 2) return;
  const std::vector<std::uint32_t> face =
      carry_labels(selected.mesh, selected.faces.of_triangle, result.surface, simplified.line_edges);
  std::vector<NamedSet> sets;
  for (const SurfaceFace& f : faces) sets.push_back({f.name, {}});
  for (std::uint32_t t = 0; t < face.size(); ++t) sets[face[t]].members.push_back(t);
  for (std::size_t f = 0; f < sets.size(); ++f)
    if (!sets[f].members.empty() && find_set(result.face_sets, sets[f].name) == result.face_sets.size())
      add_set(std::move(sets[f]), faces[f].area, result);
}

}  // namespace

SelectedScan select_parts(const SurfaceMesh& whole, const SurfaceMesh& given_scan, const PipelineOptions& options,
                          const Progress& progress, std::optional<SimplifyOptions>& simplification,
                          StageRecord& record) {
  const FeatureOptions features = features_of(options);
  const std::vector<NamedSet> given = sets_on(whole, given_scan, options.given_sets);
  SurfaceMesh scan = whole;
  std::vector<NamedSelection> selections = with_given(options.sets, given, scan.triangles.size());
  std::optional<SurfaceFaces> faces;
  if (options.idealise || options.name_faces) faces = find_faces(scan, features, progress);
  if (options.idealise) {
    const IdealiseResult idealised = idealise(scan, *faces, *options.idealise);
    record.changes = {{"idealised", static_cast<double>(idealised.moved)},
                      {"not_idealised", static_cast<double>(idealised.left)},
                      {"largest_move", idealised.largest_move},
                      {"rms_move", idealised.rms_move}};
  }
  SelectedScan selected = select_sets(std::move(scan), selections, given, features, progress, std::move(faces));
  if (simplification)
    simplification->kept_lines = lines_of(selected.mesh, borders_between(selected.mesh, selected.of_triangle));
  record.changes.emplace_back("faces", static_cast<double>(selected.faces.list.size()));
  record.changes.emplace_back("sets", static_cast<double>(selected.sets.size()));
  return selected;
}

void carry_parts(const SelectedScan& selected, const PipelineOptions& options, const SimplifyResult& simplified,
                 PipelineResult& result) {
  std::vector<NamedSet> carried = sets_on_surface(selected, result.surface, simplified.line_edges);
  for (std::size_t s = 0; s < carried.size(); ++s) {
    NamedSet& set = carried[s];
    if (set.members.empty() && s >= options.sets.size()) continue;
    if (set.members.empty()) throw nothing_left(set.name, selected.areas[s]);
    add_set(std::move(set), selected.areas[s], result);
  }
  if (options.name_faces) name_faces(selected, simplified, result);
  result.faces = selected.faces;
}

void require_sets_of_layers(const SelectedScan* selected, const std::vector<LayerOptions>& layers) {
  for (const LayerOptions& asked : layers) {
    if (asked.set.empty() || (selected != nullptr && find_set(selected->sets, asked.set) < selected->sets.size()))
      continue;
    std::string known;
    for (std::size_t s = 0; selected != nullptr && s < selected->sets.size(); ++s)
      known += (s > 0 ? ", " : "") + selected->sets[s].name;
    throw WrongUsage({.what = "layers behind a set that there is not",
                      .where = {},
                      .value = asked.set,
                      .limit = known.empty() ? "no set" : known,
                      .advice = "--set '" + asked.set + "=" +
                                (asked.set.starts_with("FACE_") ? asked.set : std::string("EXPRESSION")) + "'"});
  }
}

LayeredTriangles layered_triangles(const SelectedScan* selected, const std::vector<LayerOptions>& layers,
                                   const SurfaceMesh& surface, const std::vector<FeatureEdge>& lines) {
  LayeredTriangles result{{}, std::vector<std::uint32_t>(surface.triangles.size(), no_layers)};
  std::vector<NamedSet> sets;
  if (selected != nullptr) sets = sets_on_surface(*selected, surface, lines);
  for (const LayerOptions& asked : layers) {
    const auto same = std::ranges::find(result.heights, asked.heights);
    const auto number = static_cast<std::uint32_t>(same - result.heights.begin());
    if (same == result.heights.end()) result.heights.push_back(asked.heights);
    const auto take = [&](std::uint32_t f) {
      if (result.of_triangle[f] != no_layers && result.of_triangle[f] != number)
        throw WrongUsage({.what = "two kinds of layers behind the same triangles",
                          .where = "--layers",
                          .value = asked.set.empty() ? "all of the surface" : asked.set,
                          .limit = {},
                          .advice = "sets that do not overlap"});
      result.of_triangle[f] = number;
    };
    if (asked.set.empty())
      for (std::uint32_t f = 0; f < result.of_triangle.size(); ++f) take(f);
    else if (const NamedSet& set = sets[find_set(sets, asked.set)]; !set.members.empty())
      std::ranges::for_each(set.members, take);
    else
      throw nothing_left(set.name, {});
  }
  return result;
}

void add_set(NamedSet set, std::optional<double> area_of_scan, PipelineResult& result) {
  double area = 0;
  for (const std::uint32_t f : set.members) area += area_vector(result.surface, result.surface.triangles[f]).norm() / 2;
  result.sets.push_back(
      {.name = set.name, .area_of_scan = area_of_scan.value_or(area), .area = area, .triangles = set.members.size()});
  result.face_sets.push_back(std::move(set));
}

std::vector<bool> domain_of(const SurfaceMesh& scan, const NamedSelection& selection, const PipelineOptions& options,
                            const Progress& progress) {
  const SelectedScan selected = select_sets(scan, std::span(&selection, 1), {}, features_of(options), progress);
  std::vector<bool> domain(scan.vertices.size(), false);
  // Vertices that cuts have added come after those of the scan.
  for (const std::uint32_t v : vertices_of_faces(selected.mesh, selected.sets.front().members))
    if (v < domain.size()) domain[v] = true;
  return domain;
}

void measure_sets(PipelineResult& result) {
  const TetMesh& mesh = *result.volume_mesh;
  for (std::size_t s = 0; s < result.sets.size(); ++s) {
    result.sets[s].area = 0;
    for (const std::uint32_t f : mesh.face_sets[s].members) result.sets[s].area += face_area(mesh, mesh.boundary[f]);
  }
}

}  // namespace scan2fea
