#include "tests/benchmark/peers.hpp"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polygon_mesh_processing/IO/polygon_mesh_io.h>
#include <CGAL/Surface_mesh.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/Bounded_normal_change_filter.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/Count_stop_predicate.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/GarlandHeckbert_policies.h>
#include <CGAL/Surface_mesh_simplification/edge_collapse.h>

#include <stdexcept>

namespace scan2fea::benchmark {
namespace {

namespace sms = CGAL::Surface_mesh_simplification;
using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Mesh = CGAL::Surface_mesh<Kernel::Point_3>;

Mesh read(const PeerJob& job) {
  Mesh mesh;
  if (!CGAL::Polygon_mesh_processing::IO::read_polygon_mesh(job.input, mesh))
    throw std::runtime_error("CGAL cannot read " + job.input);
  return mesh;
}

void write(const PeerJob& job, Mesh& mesh) {
  mesh.collect_garbage();
  CGAL::IO::write_polygon_mesh(job.output, mesh, CGAL::parameters::stream_precision(17));
}

// A closed surface has three edges for two faces.
sms::Count_stop_predicate<Mesh> stop_at(const PeerJob& job) {
  return {job.faces * 3 / 2};
}

}  // namespace

void cgal_garland_heckbert(const PeerJob& job) {
  Mesh mesh = read(job);
  sms::GarlandHeckbert_plane_policies<Mesh, Kernel> policies(mesh);
  const sms::Bounded_normal_change_filter<> keep_orientation;
  sms::edge_collapse(
      mesh, stop_at(job),
      CGAL::parameters::get_cost(policies.get_cost()).get_placement(policies.get_placement()).filter(keep_orientation));
  write(job, mesh);
}

void cgal_lindstrom_turk(const PeerJob& job) {
  Mesh mesh = read(job);
  sms::edge_collapse(mesh, stop_at(job));
  write(job, mesh);
}

}  // namespace scan2fea::benchmark
