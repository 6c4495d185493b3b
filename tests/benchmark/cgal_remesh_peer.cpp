#include "tests/benchmark/peers.hpp"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polygon_mesh_processing/IO/polygon_mesh_io.h>
#include <CGAL/Polygon_mesh_processing/remesh.h>
#include <CGAL/Surface_mesh.h>

#include <stdexcept>

namespace scan2fea::benchmark {

void cgal_isotropic_remeshing(const PeerJob& job) {
  namespace pmp = CGAL::Polygon_mesh_processing;
  using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
  CGAL::Surface_mesh<Kernel::Point_3> mesh;
  if (!pmp::IO::read_polygon_mesh(job.input, mesh)) throw std::runtime_error("CGAL cannot read " + job.input);
  pmp::isotropic_remeshing(faces(mesh), job.edge_length, mesh, pmp::parameters::number_of_iterations(10));
  mesh.collect_garbage();
  CGAL::IO::write_polygon_mesh(job.output, mesh, CGAL::parameters::stream_precision(17));
}

}  // namespace scan2fea::benchmark
