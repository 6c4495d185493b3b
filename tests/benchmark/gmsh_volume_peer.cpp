#include "tests/benchmark/gmsh_volume_peer.hpp"

#include <gmsh.h>

namespace scan2fea::benchmark {

TetMesh gmsh_hxt(const SurfaceMesh& surface, int rounds) {
  gmsh::initialize();
  gmsh::option::setNumber("General.Terminal", 0);
  gmsh::option::setNumber("General.NumThreads", 1);
  gmsh::option::setNumber("Mesh.Algorithm3D", 10);  // HXT
  gmsh::model::add("surface");
  const int face = gmsh::model::addDiscreteEntity(2);
  std::vector<std::size_t> tags, triangles;
  std::vector<double> coordinates;
  for (std::size_t v = 0; v < surface.vertices.size(); ++v) {
    tags.push_back(v + 1);
    for (const double x : surface.vertices[v]) coordinates.push_back(x);
  }
  for (const Triangle& t : surface.triangles)
    for (const std::uint32_t v : t) triangles.push_back(v + 1);
  gmsh::model::mesh::addNodes(2, face, tags, coordinates);
  gmsh::model::mesh::addElementsByType(face, 2, {}, triangles);
  gmsh::model::geo::addVolume({gmsh::model::geo::addSurfaceLoop({face})});
  gmsh::model::geo::synchronize();
  gmsh::model::mesh::generate(3);
  gmsh::option::setNumber("Mesh.OptimizeThreshold", 0.7);
  for (int round = 0; round < rounds; ++round) gmsh::model::mesh::optimize("", true);

  TetMesh mesh;
  std::vector<double> parameters;
  gmsh::model::mesh::getNodes(tags, coordinates, parameters);
  std::vector<std::uint32_t> index;
  for (std::size_t i = 0; i < tags.size(); ++i) {
    if (tags[i] >= index.size()) index.resize(tags[i] + 1);
    index[tags[i]] = static_cast<std::uint32_t>(i);
    mesh.nodes.emplace_back(coordinates[3 * i], coordinates[3 * i + 1], coordinates[3 * i + 2]);
  }
  std::vector<std::size_t> elements, corners;
  gmsh::model::mesh::getElementsByType(4, elements, corners);
  for (std::size_t i = 0; i + 3 < corners.size(); i += 4)
    mesh.tetrahedra.push_back({index[corners[i]], index[corners[i + 1]], index[corners[i + 2]], index[corners[i + 3]]});
  gmsh::finalize();
  return mesh;
}

}  // namespace scan2fea::benchmark
