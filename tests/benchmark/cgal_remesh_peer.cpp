#include "tests/benchmark/peers.hpp"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polygon_mesh_processing/IO/polygon_mesh_io.h>
#include <CGAL/Polygon_mesh_processing/detect_features.h>
#include <CGAL/Polygon_mesh_processing/remesh.h>
#include <CGAL/Surface_mesh.h>

#include <stdexcept>
#include <vector>

namespace scan2fea::benchmark {
namespace {

using Mesh = CGAL::Surface_mesh<CGAL::Exact_predicates_inexact_constructions_kernel::Point_3>;

Mesh read(const std::string& file) {
  Mesh mesh;
  if (!CGAL::Polygon_mesh_processing::IO::read_polygon_mesh(file, mesh))
    throw std::runtime_error("CGAL cannot read " + file);
  return mesh;
}

void write(Mesh& mesh, const std::string& file) {
  mesh.collect_garbage();
  CGAL::IO::write_polygon_mesh(file, mesh, CGAL::parameters::stream_precision(17));
}

}  // namespace

void cgal_isotropic_remeshing(const PeerJob& job) {
  namespace pmp = CGAL::Polygon_mesh_processing;
  Mesh mesh = read(job.input);
  pmp::isotropic_remeshing(faces(mesh), job.edge_length, mesh, pmp::parameters::number_of_iterations(10));
  write(mesh, job.output);
}

void cgal_feature_remeshing(const PeerJob& job) {
  namespace pmp = CGAL::Polygon_mesh_processing;
  Mesh mesh = read(job.input);
  auto sharp = mesh.add_property_map<Mesh::Edge_index, bool>("e:sharp", false).first;
  pmp::detect_sharp_edges(mesh, 40, sharp);
  for (const Mesh::Edge_index e : mesh.edges())
    if (mesh.is_border(e)) sharp[e] = true;
  std::vector<Mesh::Edge_index> edges;
  for (const Mesh::Edge_index e : mesh.edges())
    if (sharp[e]) edges.push_back(e);
  const auto protected_edges = pmp::parameters::edge_is_constrained_map(sharp);
  pmp::split_long_edges(edges, job.edge_length, mesh, protected_edges);
  pmp::isotropic_remeshing(
      faces(mesh), job.edge_length, mesh,
      pmp::parameters::number_of_iterations(10).edge_is_constrained_map(sharp).protect_constraints(true));
  write(mesh, job.output);
}

}  // namespace scan2fea::benchmark
