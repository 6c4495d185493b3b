// The figures of a mesh as one JSON object, the contract of `check --json`, and as a table for people.
//
// Schema "scan2fea/6", which report.schema.json tells in full:
//   schema, input,
//   surface {vertices, faces, edge_ratio {mean, p50, p95, p99, max}, min_angle_deg {mean, min}, max_angle_deg,
//            radius_ratio {mean, min}, degenerate, closed, manifold, oriented, self_intersections, unused_vertices,
//            components, genus, volume, area},
//   deviation {volume_difference_pct, area_difference_pct, hausdorff_pct_diagonal, rms_pct_diagonal, farthest_point,
//              from_mesh {hausdorff_pct_diagonal, rms_pct_diagonal}, from_reference {the same}},
//   points {count, largest_distance, rms_distance, farthest_point},
//   volume_mesh {nodes, tetrahedra, order, min_dihedral_deg, max_dihedral_deg, min_face_angle_deg, max_face_angle_deg,
//                scaled_jacobian {min, mean}, edge_ratio, radius_edge_ratio, volume, inverted},
//   faces [{name, kind, area, triangles, place, what its kind has}],
//   sets [{name, kind, area, area_of_scan, area_difference_pct, triangles; of a file's elements volume, tetrahedra, of
//          nodes nodes}],
//   bodies [{name, volume, volume_of_scan, volume_difference_pct, volume_joined, tetrahedra}],
//   contacts [{bodies, set, triangles_closed, largest_gap, largest_overlap, tolerance, place}],
//   gaps [{bodies, size, tolerance, place}], touches [{bodies, kind, length, drawn_apart, place}],
//   regions [{name, area, faces}], gates [{name, operator, value, limit, pass; reason, set, source,
//   place, element}]
// The command adds where it comes from (program, command, inputs, output, size, reference) and single elements
// (histograms, worst_elements).
// Of a volume mesh of second order, volumes, areas, deviation, points and volume_mesh are those of the curved elements
// (see TetShape); what is said of triangles, edge ratios and angles, is of their corners.
// A section that was not measured is left out; a figure that has no meaning, as the genus of an open surface, is null.
// Numbers are finite. The keys' meanings are those of the structs that the figures come from.
#pragma once

#include "quality/deviation.hpp"
#include "quality/point_distances.hpp"
#include "quality/tetrahedron_measures.hpp"
#include "quality/triangle_measures.hpp"
#include "quality/validity.hpp"

#include <nlohmann/json_fwd.hpp>

#include <optional>
#include <string>
#include <vector>

namespace scan2fea {

// Rises with every change of the format; tests/check_report_format.py holds it against report.schema.json.
inline constexpr const char* report_schema = "scan2fea/6";

using Json = nlohmann::ordered_json;  // keys stay in the order above

// [x, y, z].
Json point_json(const Vec3& p);

struct SurfaceFigures {
  std::size_t vertices = 0;
  std::size_t faces = 0;
  TriangleSummary shape;
  SurfaceValidity validity;
  std::size_t self_intersections = 0;  // pairs of faces
  std::optional<double> volume;        // signed: negative where normals point inwards; nothing if none is enclosed
  double area = 0;
};

// All of it: triangle measures, validity, self-intersections. A scan of 100,000 triangles takes about 0.1 s.
SurfaceFigures measure_surface(const SurfaceMesh& mesh);

struct RegionFigures {
  std::string name;
  double area;
  std::size_t faces;
};

struct Report {
  std::string input;  // the file's name, or what else the user calls it
  std::optional<SurfaceFigures> surface;
  std::optional<Deviation> deviation;
  std::optional<PointDistances> points;  // of a cloud, from the surface
  std::optional<TetSummary> volume_mesh;
  std::vector<RegionFigures> regions;
};

// `gates` is there and empty; see gates.hpp.
Json to_json(const Report& report);

// A line of the table that to_table makes.
std::string table_row(const std::string& name, const std::string& figures);

// What the JSON object says, for a terminal: a few lines for each section that is there. Ends with a line break.
std::string to_table(const Json& report);

}  // namespace scan2fea
