// Sets of a scan's triangles by expressions, with lines on the scan where they end.
#pragma once

#include "preproc/mesh/named_sets.hpp"
#include "preproc/surface/faces/find_faces.hpp"
#include "preproc/surface/faces/selection.hpp"

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace scan2fea {

struct SelectedScan {
  SurfaceMesh mesh;                        // the scan, cut where a set ends within a triangle
  std::vector<NamedSet> sets;              // of its triangles, in the order of the selections
  std::vector<double> areas;               // of each
  SurfaceFaces faces;                      // of it; none where no selection asks for faces
  std::vector<std::uint32_t> of_triangle;  // per triangle a number that is the same where it is in the same sets
};

// `given`: sets that the scan came with, by which expressions may call them; only those become sets themselves that
// are selected. Edges that the border of a place (a box, a ball, a half-space, an angle) crosses are cut there, but for
// a twentieth next to their ends; edges longer than a sixtieth of the diagonal are halved before, so that places
// smaller than a triangle are found. Throws WrongUsage where a selection, or what stands in it by itself, selects
// nothing: it says what is near. `known_faces`: of the scan, where they have been found. Cost: find_faces where faces
// are asked for; else linear.
SelectedScan select_sets(SurfaceMesh scan, std::span<const NamedSelection> selections,
                         std::span<const NamedSet> given = {}, const FeatureOptions& features = {},
                         const Progress& progress = {}, std::optional<SurfaceFaces> known_faces = {});

}  // namespace scan2fea
