#include "quality/limits.hpp"

#include "preproc/mesh/error.hpp"

#include <algorithm>
#include <array>
#include <string>

namespace scan2fea {
namespace {

using enum Comparison;
using Beyond = MeasureLimit::Beyond;
using Of = MeasureLimit::Of;

constexpr auto sets = std::to_array<std::string_view>({"abaqus", "ansys", "nastran", "calculix", "paper"});

constexpr auto limits = std::to_array<MeasureLimit>({
    {"deviation.volume_difference_pct", at_most, 0.8, Beyond::worse_than_paper, 'P', "paper", Of::either},
    {"deviation.volume_difference_pct", at_least, -0.8, Beyond::worse_than_paper, 'P', "paper", Of::either},

    {"surface.edge_ratio.mean", at_most, 1.3, Beyond::is_unusual, 'V', "", Of::triangles},
    {"surface.edge_ratio.mean", at_most, 1.5, Beyond::worse_than_paper, 'P', "paper", Of::either},
    {"surface.edge_ratio.max", at_most, 10, Beyond::warning, 'B', "abaqus", Of::triangles},
    {"surface.edge_ratio.max", at_most, 50, Beyond::warning, 'O', "", Of::triangles},
    {"surface.edge_ratio.max", at_most, 500, Beyond::error, 'O', "", Of::triangles},
    {"surface.min_angle_deg.mean", at_least, 30, Beyond::is_unusual, 'V', "", Of::triangles},
    {"surface.min_angle_deg.min", at_least, 15, Beyond::warning, 'O', "", Of::triangles},
    {"surface.min_angle_deg.min", above, 10, Beyond::warning, 'N', "nastran", Of::triangles},
    {"surface.min_angle_deg.min", at_least, 5, Beyond::warning, 'B', "abaqus", Of::triangles},
    {"surface.min_angle_deg.min", at_least, 3, Beyond::error, 'O', "", Of::triangles},
    {"surface.max_angle_deg", at_most, 165, Beyond::warning, 'A', "ansys", Of::triangles},
    {"surface.max_angle_deg", at_most, 165, Beyond::warning, 'O', "", Of::triangles},
    {"surface.max_angle_deg", below, 170, Beyond::warning, 'N', "nastran", Of::triangles},
    {"surface.max_angle_deg", at_most, 170, Beyond::warning, 'B', "abaqus", Of::triangles},
    {"surface.max_angle_deg", at_most, 177, Beyond::error, 'O', "", Of::triangles},
    {"surface.max_angle_deg", at_most, 179.9, Beyond::error, 'A', "", Of::triangles},

    {"surface.self_intersections", equal, 0, Beyond::error, 'T', "", Of::either},

    {"volume_mesh.scaled_jacobian.min", above, 0, Beyond::error, 'C', "calculix", Of::tetrahedra},
    {"volume_mesh.min_dihedral_deg", at_least, 15, Beyond::warning, 'O', "", Of::tetrahedra},
    {"volume_mesh.min_dihedral_deg", at_least, 3, Beyond::error, 'O', "", Of::tetrahedra},
    {"volume_mesh.max_dihedral_deg", at_most, 165, Beyond::warning, 'O', "", Of::tetrahedra},
    {"volume_mesh.max_dihedral_deg", at_most, 177, Beyond::error, 'O', "", Of::tetrahedra},
    {"volume_mesh.min_face_angle_deg", at_least, 5, Beyond::warning, 'B', "abaqus", Of::tetrahedra},
    {"volume_mesh.min_face_angle_deg", above, 5, Beyond::warning, 'N', "nastran", Of::tetrahedra},
    {"volume_mesh.max_face_angle_deg", at_most, 165, Beyond::warning, 'A', "ansys", Of::tetrahedra},
    {"volume_mesh.max_face_angle_deg", below, 170, Beyond::warning, 'N', "nastran", Of::tetrahedra},
    {"volume_mesh.max_face_angle_deg", at_most, 170, Beyond::warning, 'B', "abaqus", Of::tetrahedra},
    {"volume_mesh.max_face_angle_deg", at_most, 179.9, Beyond::error, 'A', "", Of::tetrahedra},
    {"volume_mesh.edge_ratio", at_most, 10, Beyond::warning, 'B', "abaqus", Of::tetrahedra},
    {"volume_mesh.inverted", equal, 0, Beyond::error, 'C', "calculix", Of::tetrahedra},
    {"volume_mesh.inverted", equal, 0, Beyond::error, 'J', "abaqus", Of::tetrahedra},
    {"volume_mesh.inverted", equal, 0, Beyond::error, 'J', "ansys", Of::tetrahedra},
    {"volume_mesh.inverted", equal, 0, Beyond::error, 'J', "nastran", Of::tetrahedra},
});

constexpr auto sources = std::to_array<LimitSource>({
    {'A',
     "Ansys Mechanical APDL Command Reference, \u201cSHPP\u201d: default limits of the maximum corner angle of "
     "triangles "
     "and of triangular faces of solids (its sections of solids, which are tested too, are not measured here)"},
    {'B',
     "Abaqus/CAE, \u201cVerify Mesh\u201d: default limits of the shape metrics of triangles and tetrahedra; their "
     "definitions: Abaqus Scripting Reference, \u201cverifyMeshQuality\u201d"},
    {'C', "CalculiX CrunchiX: an element whose Jacobian determinant is not positive ends the calculation"},
    {'J',
     "FEBio User Manual, \u201cInverted elements\u201d: of any isoparametric element the Jacobian must be positive "
     "throughout"},
    {'N',
     "Autodesk Nastran Reference Guide, \u201cGEOMCHECK\u201d: default tolerances TRIMINIATOL, TRIMAXIATOL, "
     "TETFACEMINIATOL and TETFACEMAXIATOL of interior angles, which warn where they are reached"},
    {'O',
     "Altair OptiStruct Reference Guide, \u201cCTRIA3\u201d and \u201cCTETRA Element Checks and Default Bound "
     "Values\u201d: vertex angles, aspect ratio, and edge angle, which is the dihedral angle less 90 degrees"},
    {'P', "The paper of this method: what it reached of the Horse, mean aspect ratio and volume"},
    {'T', "TetGen User's Manual: facets of a piecewise linear complex meet in common edges and vertices only"},
    {'V', "Stimpson et al., The Verdict Geometric Quality Library, SAND2007-1751: acceptable range of triangles"},
});

}  // namespace

std::span<const MeasureLimit> measure_limits() {
  return limits;
}

std::span<const LimitSource> limit_sources() {
  return sources;
}

std::string_view text_of_source(char letter) {
  return std::ranges::find(sources, letter, &LimitSource::letter)->text;
}

std::span<const std::string_view> gate_sets() {
  return sets;
}

std::vector<Gate> gates_of_set(std::string_view set, bool is_volume_mesh) {
  std::vector<Gate> gates;
  for (const MeasureLimit& limit : limits)
    if (limit.set == set && limit.of != (is_volume_mesh ? Of::triangles : Of::tetrahedra))
      gates.push_back({std::string(limit.figure), limit.comparison, limit.value, std::string(set),
                       std::string(text_of_source(limit.source))});
  if (gates.empty())
    throw WrongUsage(
        {.what = "the set of gates has no limit for " + std::string(is_volume_mesh ? "volume meshes" : "surfaces"),
         .where = "--gates",
         .value = std::string(set),
         .limit = {},
         .advice = "another set (scan2fea --list-gates), or --require"});
  return gates;
}

}  // namespace scan2fea
