#include "preproc/surface/enrichment/undo_folds.hpp"

#include "quality/self_intersections.hpp"

#include <algorithm>

namespace scan2fea {
namespace {

using Index = HalfedgeMesh::Index;

bool is_turned(const HalfedgeMesh& mesh, const SurfaceLabels& labels, Index f) {
  // Cosine of 135 degrees: two faces that meet so sharply are a fold, where no crease was cut.
  constexpr double fold_cosine = -0.7;
  const Vec3 normal = mesh.area_vector(f).normalized();
  if (const std::uint32_t label = labels.of_face(f); label != no_primitive) {
    const Triangle t = mesh.triangle(f);
    return labels.shape(label).normal((mesh.points[t[0]] + mesh.points[t[1]] + mesh.points[t[2]]) / 3).dot(normal) < 0;
  }
  for (Index h = 3 * f; h < 3 * f + 3; ++h)
    if (!mesh.is_border(h) && mesh.area_vector(HalfedgeMesh::face(mesh.opposite(h))).normalized().dot(normal) < fold_cosine)
      return true;
  return false;
}

// As the mesh's faces with all vertices, so that numbers agree.
SurfaceMesh surface_of(const HalfedgeMesh& mesh, std::vector<Index>& faces) {
  SurfaceMesh surface{mesh.points, {}};
  faces.clear();
  for (Index f = 0; f < mesh.face_slots(); ++f) {
    if (!mesh.is_face_alive(f)) continue;
    faces.push_back(f);
    surface.triangles.push_back(mesh.triangle(f));
  }
  return surface;
}

std::vector<bool> bad_vertices(const HalfedgeMesh& mesh, const SurfaceLabels& labels) {
  std::vector<bool> bad(mesh.vertex_slots(), false);
  const auto mark = [&](Index f) {
    for (const Index v : mesh.triangle(f)) bad[v] = true;
  };
  std::vector<Index> faces;
  const SurfaceMesh surface = surface_of(mesh, faces);
  for (const Index f : faces)
    if (is_turned(mesh, labels, f)) mark(f);
  for (const FacePair& pair : find_self_intersections(surface)) {
    mark(faces[pair.face]);
    mark(faces[pair.other]);
  }
  return bad;
}

}  // namespace

std::size_t undo_folds(HalfedgeMesh& mesh, SurfaceLabels& labels, const std::vector<Vec3>& bases) {
  constexpr int most_rounds = 12, halved = 3;
  std::vector<bool> undone(mesh.vertex_slots(), false);
  for (int round = 0; round < most_rounds; ++round) {
    const std::vector<bool> bad = bad_vertices(mesh, labels);
    bool moved = false;
    for (Index v = 0; v < bad.size(); ++v) {
      if (!bad[v] || mesh.points[v] == bases[v]) continue;
      mesh.points[v] = round < halved ? Vec3(0.5 * (mesh.points[v] + bases[v])) : bases[v];
      labels.set(v, LabelSet());
      undone[v] = moved = true;
    }
    if (!moved) break;
  }
  return static_cast<std::size_t>(std::count(undone.begin(), undone.end(), true));
}

}  // namespace scan2fea
