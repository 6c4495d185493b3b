// cgal_deviation MESH REFERENCE ERROR: CGAL's bounded-error Hausdorff distance between two surfaces, two-sided, as
// JSON. What is printed is an upper bound of the true distance: CGAL's figure plus ERROR, all in per cent of the
// reference's bounding-box diagonal.
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polygon_mesh_processing/IO/polygon_mesh_io.h>
#include <CGAL/Polygon_mesh_processing/bbox.h>
#include <CGAL/Polygon_mesh_processing/distance.h>
#include <CGAL/Surface_mesh.h>

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <stdexcept>
#include <string>

namespace {

namespace pmp = CGAL::Polygon_mesh_processing;
using Mesh = CGAL::Surface_mesh<CGAL::Exact_predicates_inexact_constructions_kernel::Point_3>;

Mesh read(const std::string& file) {
  Mesh mesh;
  if (!pmp::IO::read_polygon_mesh(file, mesh)) throw std::runtime_error("CGAL cannot read " + file);
  return mesh;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 4) {
    std::fprintf(stderr, "usage: cgal_deviation MESH REFERENCE ERROR\n");
    return 2;
  }
  try {
    const Mesh mesh = read(argv[1]), reference = read(argv[2]);
    const CGAL::Bbox_3 box = pmp::bbox(reference);
    const double per_cent = std::hypot(box.x_span(), box.y_span(), box.z_span()) / 100;
    const double error = std::strtod(argv[3], nullptr) * per_cent;
    // Faces that both have count too: a file's rounding is no reason to look away.
    const double distance = pmp::bounded_error_symmetric_Hausdorff_distance<CGAL::Parallel_if_available_tag>(
        mesh, reference, error, pmp::parameters::match_faces(false));
    std::printf("{\"upper_pct_diagonal\": %.17g}\n", (distance + error) / per_cent);
    return 0;
  } catch (const std::exception& e) {
    std::fprintf(stderr, "cgal_deviation: %s\n", e.what());
    return 1;
  }
}
