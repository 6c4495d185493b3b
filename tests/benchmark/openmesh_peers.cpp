#define _USE_MATH_DEFINES
#include "tests/benchmark/peers.hpp"

#include <OpenMesh/Core/IO/MeshIO.hh>
#include <OpenMesh/Core/Mesh/TriMesh_ArrayKernelT.hh>
#include <OpenMesh/Tools/Decimater/DecimaterT.hh>
#include <OpenMesh/Tools/Decimater/ModEdgeLengthT.hh>
#include <OpenMesh/Tools/Decimater/ModNormalFlippingT.hh>
#include <OpenMesh/Tools/Decimater/ModProgMeshT.hh>
#include <OpenMesh/Tools/Decimater/ModQuadricT.hh>
#include <stdexcept>

namespace scan2fea::benchmark {
namespace {

using Mesh = OpenMesh::TriMesh_ArrayKernelT<>;
using Decimater = OpenMesh::Decimater::DecimaterT<Mesh>;

Mesh read(const PeerJob& job) {
  Mesh mesh;
  if (!OpenMesh::IO::read_mesh(mesh, job.input)) throw std::runtime_error("OpenMesh cannot read " + job.input);
  mesh.request_face_normals();
  mesh.update_face_normals();
  return mesh;
}

void decimate_and_write(const PeerJob& job, Mesh& mesh, Decimater& decimater) {
  OpenMesh::Decimater::ModNormalFlippingT<Mesh>::Handle keep_orientation;
  decimater.add(keep_orientation);
  decimater.initialize();
  decimater.decimate_to_faces(0, job.faces);
  mesh.garbage_collection();
  OpenMesh::IO::write_mesh(mesh, job.output, OpenMesh::IO::Options::Binary);
}

}  // namespace

void openmesh_quadric(const PeerJob& job) {
  Mesh mesh = read(job);
  Decimater decimater(mesh);
  OpenMesh::Decimater::ModQuadricT<Mesh>::Handle quadric;
  decimater.add(quadric);
  decimater.module(quadric).unset_max_err();
  decimate_and_write(job, mesh, decimater);
}

void openmesh_progressive(const PeerJob& job) {
  Mesh mesh = read(job);
  Decimater decimater(mesh);
  OpenMesh::Decimater::ModProgMeshT<Mesh>::Handle progressive;
  OpenMesh::Decimater::ModEdgeLengthT<Mesh>::Handle edge_length;
  decimater.add(progressive);
  decimater.add(edge_length);
  decimater.module(edge_length).set_binary(false);
  decimate_and_write(job, mesh, decimater);
}

}  // namespace scan2fea::benchmark
