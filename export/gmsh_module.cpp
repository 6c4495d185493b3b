#include "export/gmsh_module.hpp"

#include "export/gmsh_elements.hpp"

#include <gmsh.h>

#include <array>
#include <mutex>
#include <numeric>
#include <stdexcept>
#include <string>

namespace scan2fea {
namespace {

// Gmsh from initialize to finalize; one at a time, since its state is global.
class GmshSession {
 public:
  GmshSession() : lock_(mutex()) {
    gmsh::initialize(0, nullptr, false);  // no configuration files: output must not depend on the user's
    gmsh::option::setNumber("General.Terminal", 0);
    gmsh::option::setNumber("General.NumThreads", 1);
  }
  ~GmshSession() {
    try {
      gmsh::finalize();
    } catch (...) {  // nothing to be done, and a destructor must not throw
    }
  }
  GmshSession(const GmshSession&) = delete;
  GmshSession& operator=(const GmshSession&) = delete;

 private:
  static std::mutex& mutex() {
    static std::mutex instance;
    return instance;
  }
  std::lock_guard<std::mutex> lock_;
};

// Gmsh throws std::string, int or standard exceptions, by version and function.
std::string current_exception_text() {
  try {
    throw;
  } catch (const std::string& text) {
    return text;
  } catch (const std::exception& error) {
    return error.what();
  } catch (...) {
    return "unknown error of Gmsh";
  }
}

std::vector<std::size_t> tags(std::size_t count) {
  std::vector<std::size_t> result(count);
  std::iota(result.begin(), result.end(), std::size_t{1});
  return result;
}

void add_nodes(const TetMesh& mesh, const std::vector<bool>& chosen, int dimension, int entity) {
  std::vector<std::size_t> node_tags;
  std::vector<double> coordinates;
  for (std::size_t n = 0; n < mesh.nodes.size(); ++n) {
    if (!chosen[n]) continue;
    node_tags.push_back(n + 1);
    const Vec3& p = mesh.nodes[n];
    coordinates.insert(coordinates.end(), {p.x(), p.y(), p.z()});
  }
  if (!node_tags.empty()) gmsh::model::mesh::addNodes(dimension, entity, node_tags, coordinates);
}

std::vector<std::size_t> tetrahedron_nodes(const TetMesh& mesh) {
  std::vector<std::size_t> nodes;
  nodes.reserve(mesh.tetrahedra.size() * (mesh.order() == 2 ? 10 : 4));
  for (std::size_t t = 0; t < mesh.tetrahedra.size(); ++t) {
    for (const std::uint32_t n : mesh.tetrahedra[t]) nodes.push_back(std::size_t{n} + 1);
    if (mesh.order() == 2)
      for (const std::size_t e : gmsh_mid_edges) nodes.push_back(std::size_t{mesh.mid_edge_nodes[t][e]} + 1);
  }
  return nodes;
}

std::uint32_t mid_edge_node(const TetMesh& mesh, std::uint32_t tetrahedron, std::uint32_t a, std::uint32_t b) {
  const Tetrahedron& corners = mesh.tetrahedra[tetrahedron];
  std::size_t e = 0;
  for (; e + 1 < tetrahedron_edges.size(); ++e) {
    const std::uint32_t p = corners[static_cast<std::size_t>(tetrahedron_edges[e][0])];
    const std::uint32_t q = corners[static_cast<std::size_t>(tetrahedron_edges[e][1])];
    if ((p == a && q == b) || (p == b && q == a)) break;
  }
  return mesh.mid_edge_nodes[tetrahedron][e];
}

// Corners counter-clockwise seen from outside, then the nodes of the edges 12, 23, 31.
std::vector<std::size_t> triangle_nodes(const TetMesh& mesh) {
  std::vector<std::size_t> nodes;
  nodes.reserve(mesh.boundary.size() * (mesh.order() == 2 ? 6 : 3));
  for (const BoundaryFace f : mesh.boundary) {
    const Triangle corners = boundary_triangle(mesh, f);
    for (const std::uint32_t n : corners) nodes.push_back(std::size_t{n} + 1);
    if (mesh.order() == 2)
      for (std::size_t k = 0; k < 3; ++k)
        nodes.push_back(std::size_t{mid_edge_node(mesh, f.tetrahedron, corners[k], corners[(k + 1) % 3])} + 1);
  }
  return nodes;
}

void build_model(const TetMesh& mesh, MshVersion version) {
  gmsh::model::add("scan2fea");
  const int surface = gmsh::model::addDiscreteEntity(2);
  const int volume = gmsh::model::addDiscreteEntity(3, -1, {surface});
  const std::vector<std::size_t> triangles = triangle_nodes(mesh);
  // Version 4.1 files a node under the entity it lies on. In 2.2 nodes have no entity, and Gmsh renumbers them entity
  // by entity: all go to one, to keep their numbers.
  std::vector<bool> on_surface(mesh.nodes.size(), false);
  if (version == MshVersion::v4_1)
    for (const std::size_t tag : triangles) on_surface[tag - 1] = true;
  add_nodes(mesh, on_surface, 2, surface);
  on_surface.flip();
  add_nodes(mesh, on_surface, 3, volume);

  const std::size_t tetrahedra = mesh.tetrahedra.size();
  std::vector<std::size_t> triangle_tags(mesh.boundary.size());
  std::iota(triangle_tags.begin(), triangle_tags.end(), tetrahedra + 1);
  gmsh::model::mesh::addElementsByType(volume, mesh.order() == 2 ? gmsh_tetrahedron_10 : gmsh_tetrahedron_4,
                                       tags(tetrahedra), tetrahedron_nodes(mesh));
  if (!triangles.empty())
    gmsh::model::mesh::addElementsByType(surface, mesh.order() == 2 ? gmsh_triangle_6 : gmsh_triangle_3, triangle_tags,
                                         triangles);
  gmsh::model::setPhysicalName(2, gmsh::model::addPhysicalGroup(2, {surface}), "SALL");
  gmsh::model::setPhysicalName(3, gmsh::model::addPhysicalGroup(3, {volume}), "EALL");
}

}  // namespace

extern "C" WriteByGmsh scan2fea_write_by_gmsh;

void scan2fea_write_by_gmsh(const TetMesh& mesh, const std::filesystem::path& file, MshVersion version,
                            std::string& failure) {
  try {
    const GmshSession session;
    build_model(mesh, version);
    gmsh::option::setNumber("Mesh.MshFileVersion", version == MshVersion::v2_2 ? 2.2 : 4.1);
    gmsh::option::setNumber("Mesh.Binary", 0);
    gmsh::option::setNumber("Mesh.SaveAll", 0);
    gmsh::write(file.string());
    failure.clear();
  } catch (...) {
    failure = current_exception_text();
  }
}

}  // namespace scan2fea
