#include "tests/machined_part.hpp"

#include <gmsh.h>

#if defined(__SANITIZE_ADDRESS__)
#include <sanitizer/lsan_interface.h>
#endif

#include <algorithm>
#include <cctype>
#include <cmath>
#include <map>
#include <random>

namespace scan2fea::analytic {
namespace {

using Tags = gmsh::vectorpair;
namespace occ = gmsh::model::occ;

Tags cylinder(const Vec3& start, const Vec3& along, double radius) {
  return {{3, occ::addCylinder(start.x(), start.y(), start.z(), along.x(), along.y(), along.z(), radius)}};
}

Tags rib() {
  const std::vector<std::array<double, 2>> outline{{-8, 9}, {30, 9}, {30, 26}, {-8, 16}};
  std::vector<int> points, lines;
  for (const auto& [x, z] : outline) points.push_back(occ::addPoint(x, -3, z));
  for (std::size_t i = 0; i < points.size(); ++i)
    lines.push_back(occ::addLine(points[i], points[(i + 1) % points.size()]));
  Tags made, solid;
  occ::extrude({{2, occ::addPlaneSurface({occ::addCurveLoop(lines)})}}, 0, 6, 0, made);
  std::copy_if(made.begin(), made.end(), std::back_inserter(solid), [](const auto& e) { return e.first == 3; });
  return solid;
}

void join(Tags& all, const Tags& more) {
  all.insert(all.end(), more.begin(), more.end());
}

// Each rounded edge, told by its box.
void round_edges(int solid) {
  std::vector<int> edges;
  std::vector<double> radii;
  Tags curves;
  gmsh::model::getEntities(curves, 1);
  const auto near = [](double a, double b) { return std::abs(a - b) < 1e-3; };
  for (const auto& [dimension, tag] : curves) {
    Vec3 low, high;
    gmsh::model::getBoundingBox(dimension, tag, low.x(), low.y(), low.z(), high.x(), high.y(), high.z());
    const Vec3 size = high - low;
    double radius = 0;
    if (near(low.x(), -40) && near(high.x(), -40) && near(size.y(), 0) && size.z() > 8) radius = 6;
    if (near(low.z(), 10) && near(high.z(), 10) && high.x() < -2 && low.x() > -39 && size.y() > 20) radius = 2.5;
    if (near(low.z(), 30) && near(high.z(), 30) && near(low.x(), 36) && near(high.x(), 36)) radius = 3;
    if (radius == 0) continue;
    edges.push_back(tag);
    radii.push_back(radius);
  }
  Tags rounded;
  occ::fillet({solid}, edges, radii, rounded);
  occ::synchronize();
}

void draw() {
  Tags tools, body, cut;
  std::vector<Tags> map;
  join(tools, cylinder({-15, 0, 5}, {0, 0, 25}, 12));
  join(tools, {{3, occ::addBox(28, -25, 5, 8, 50, 25)}});
  join(tools, rib());
  occ::fuse({{3, occ::addBox(-40, -25, 0, 80, 50, 10)}}, tools, body, map);
  tools.clear();
  join(tools, cylinder({-15, 0, -1}, {0, 0, 40}, 6.5));
  join(tools, cylinder({15, 17, -1}, {0, 0, 12}, 3));
  join(tools, cylinder({15, -17, -1}, {0, 0, 12}, 3));
  join(tools, {{3, occ::addCone(15, 17, 6.5, 0, 0, 4, 2.4, 6.5)}});
  join(tools, cylinder({20, -14, 22}, {20, 0, 0}, 4));
  join(tools, {{3, occ::addSphere(-32, 16, 14, 7)}});
  occ::cut(body, tools, cut, map);
  occ::synchronize();
  round_edges(cut.at(0).second);
}

// Those with more than one radius in the drawing are told by their places.
double radius_of(const Vec3& middle) {
  if (std::abs(middle.x() + 15) < 1 && std::abs(middle.y()) < 1) return 0;  // the boss or its bore: by the area
  if (middle.x() < -36) return 6;
  if (middle.x() > 33 && middle.z() > 27) return 3;
  return middle.x() > 26 ? 4 : 3;
}

DrawnFace drawn_face(int tag) {
  DrawnFace face;
  gmsh::model::getType(2, tag, face.kind);
  std::transform(face.kind.begin(), face.kind.end(), face.kind.begin(),
                 [](unsigned char c) { return std::tolower(c); });
  occ::getMass(2, tag, face.area);
  if (face.kind != "cylinder") return face;
  Vec3 low, high;
  gmsh::model::getBoundingBox(2, tag, low.x(), low.y(), low.z(), high.x(), high.y(), high.z());
  face.radius = radius_of((low + high) / 2);
  if (face.radius == 0) face.radius = high.x() - low.x() > 20 ? 12 : 6.5;
  const bool is_along_y = low.x() > 32 && high.z() > 29 && high.y() - low.y() > 40;
  face.axis = face.radius == 4 ? Vec3::UnitX() : is_along_y ? Vec3::UnitY() : Vec3::UnitZ();
  return face;
}

MachinedPart meshed() {
  MachinedPart part;
  std::map<std::size_t, std::uint32_t> vertex_of_node;
  Tags surfaces;
  gmsh::model::getEntities(surfaces, 2);
  for (const auto& entry : surfaces) {
    std::vector<int> types;
    std::vector<std::vector<std::size_t>> elements, nodes;
    gmsh::model::mesh::getElements(types, elements, nodes, 2, entry.second);
    for (std::size_t i = 0; i < nodes.at(0).size(); ++i) {
      const auto [at, is_new] =
          vertex_of_node.try_emplace(nodes[0][i], static_cast<std::uint32_t>(part.scan.vertices.size()));
      if (is_new) {
        std::vector<double> place, parameters;
        gmsh::model::mesh::getNode(nodes[0][i], place, parameters);
        part.scan.vertices.emplace_back(place[0], place[1], place[2]);
      }
      if (i % 3 == 0) part.scan.triangles.emplace_back();
      part.scan.triangles.back()[i % 3] = at->second;
    }
    part.face_of_triangle.resize(part.scan.triangles.size(), static_cast<std::uint32_t>(part.faces.size()));
    part.faces.push_back(drawn_face(entry.second));
  }
  return part;
}

MachinedPart drawn_and_meshed(double edge) {
#if defined(__SANITIZE_ADDRESS__)
  // Gmsh and OpenCASCADE keep some of what they allocate until the program ends: that is theirs to free.
  const __lsan::ScopedDisabler leaks_are_not_ours;
#endif
  gmsh::initialize();
  gmsh::option::setNumber("General.Terminal", 0);
  gmsh::option::setNumber("General.NumThreads", 1);
  gmsh::option::setNumber("Mesh.MeshSizeMin", edge);
  gmsh::option::setNumber("Mesh.MeshSizeMax", edge);
  gmsh::model::add("part");
  draw();
  gmsh::model::mesh::generate(2);
  MachinedPart part = meshed();
  gmsh::finalize();
  return part;
}

}  // namespace

MachinedPart machined_part(double edge, double noise, std::uint64_t seed) {
  MachinedPart part = drawn_and_meshed(edge);
  std::mt19937_64 random(seed);
  const double sigma = noise * bounding_box(part.scan.vertices).diagonal();
  std::normal_distribution<double> normal;  // not of `sigma`, which may be zero here and may not there
  if (noise > 0)
    for (Vec3& p : part.scan.vertices)
      for (double& coordinate : p) coordinate += sigma * normal(random);
  return part;
}

}  // namespace scan2fea::analytic
