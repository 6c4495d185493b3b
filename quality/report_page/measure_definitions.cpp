#include "quality/report_page/measure_definitions.hpp"

#include <array>

namespace scan2fea {
namespace {

using enum MeasureDefinition::Unit;

constexpr auto definitions = std::to_array<MeasureDefinition>({
    {"deviation.hausdorff_pct_diagonal", "Hausdorff distance", percent_of_diagonal,
     "Largest distance between the two surfaces, either way; sampled, so a lower bound", ""},
    {"deviation.rms_pct_diagonal", "RMS distance", percent_of_diagonal,
     "Root of the mean squared distance, the larger of both ways", ""},
    {"deviation.from_mesh.hausdorff_pct_diagonal", "Mesh to reference, largest", percent_of_diagonal,
     "From points of the mesh to the reference: what was added", ""},
    {"deviation.from_reference.hausdorff_pct_diagonal", "Reference to mesh, largest", percent_of_diagonal,
     "From points of the reference to the mesh: what was lost", ""},
    {"deviation.volume_difference_pct", "Volume difference", percent, "(mesh \u2212 reference) / reference", ""},
    {"deviation.area_difference_pct", "Area difference", percent, "(mesh \u2212 reference) / reference", ""},
    {"points.largest_distance", "Points of the cloud, largest distance", model,
     "Of the given points, less outliers, from the mesh", ""},
    {"points.rms_distance", "Points of the cloud, RMS distance", model, "Of the same points", ""},
    {"surface.edge_ratio.mean", "Edge ratio, mean", none, "Longest edge / shortest edge of a triangle; 1 at best",
     "1 to 1.3 acceptable [V]"},
    {"surface.edge_ratio.p95", "Edge ratio, 95 %", none, "So many triangles have no larger one", ""},
    {"surface.edge_ratio.max", "Edge ratio, largest", none, "", "50 warning, 500 error [O]"},
    {"surface.min_angle_deg.mean", "Smallest angle, mean", degrees, "Of each triangle its smallest; 60 at best",
     "30 to 60 acceptable [V]"},
    {"surface.min_angle_deg.min", "Smallest angle, least", degrees, "", "15 warning, 3 error [O]"},
    {"surface.max_angle_deg", "Largest angle", degrees, "Of all triangles", "165 warning [O, A], 177 error [O]"},
    {"surface.radius_ratio.mean", "Radius ratio, mean", none, "2 \u00d7 inscribed / circumscribed radius; 1 at best",
     ""},
    {"surface.self_intersections", "Self-intersections", none, "Pairs of triangles that pass through one another",
     "0 for any tetrahedral mesher"},
    {"surface.closed", "Closed", none, "No edge belongs to one triangle alone", ""},
    {"surface.manifold", "Manifold", none, "Every edge joins two triangles, every vertex one fan", ""},
    {"surface.components", "Components", none, "Pieces that share no edge", ""},
    {"surface.genus", "Genus", none, "Number of through holes", ""},
    {"surface.volume", "Enclosed volume", model_cubed, "", ""},
    {"surface.area", "Area", model_squared, "", ""},
    {"volume_mesh.scaled_jacobian.min", "Scaled Jacobian, least", none,
     "\u221a2 \u00d7 Jacobian / product of the three longest edges at a corner; 1 for a regular tetrahedron, 0 or less "
     "is "
     "inside out; of second order the smallest in the whole element",
     "above 0, else an error [C]"},
    {"volume_mesh.scaled_jacobian.mean", "Scaled Jacobian, mean", none, "", ""},
    {"volume_mesh.min_dihedral_deg", "Dihedral angle, least", degrees,
     "Between two faces of a tetrahedron; 70.5 in a regular one", "15 warning, 3 error [O]"},
    {"volume_mesh.max_dihedral_deg", "Dihedral angle, largest", degrees, "", "165 warning, 177 error [O]"},
    {"volume_mesh.edge_ratio", "Edge ratio of tetrahedra, largest", none, "Longest edge / shortest edge", ""},
    {"volume_mesh.radius_edge_ratio", "Radius-edge ratio, largest", none,
     "Circumscribed radius / shortest edge; 0.612 in a regular tetrahedron", ""},
    {"volume_mesh.inverted", "Inside out", none, "Tetrahedra whose Jacobian is not positive throughout",
     "0 for any solver [C]"},
    {"volume_mesh.volume", "Volume of the elements", model_cubed, "", ""},
});

constexpr auto sources = std::to_array<LimitSource>({
    {"A",
     "Ansys Theory Reference, \u201cElement Shape Testing\u201d: default warning of the maximum corner angle of "
     "triangles, of solids that of their faces"},
    {"C", "CalculiX CrunchiX: an element whose Jacobian determinant is not positive ends the calculation"},
    {"O",
     "Altair OptiStruct Reference Guide, \u201cCTRIA3\u201d and \u201cCTETRA Element Checks and Default Bound "
     "Values\u201d: vertex angles, aspect ratio, and edge angle, which is the dihedral angle less 90 degrees"},
    {"V", "Stimpson et al., The Verdict Geometric Quality Library, SAND2007-1751: acceptable range of triangles"},
});

}  // namespace

std::span<const MeasureDefinition> measure_definitions() {
  return definitions;
}

std::span<const LimitSource> limit_sources() {
  return sources;
}

}  // namespace scan2fea
