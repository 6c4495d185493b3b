#include "preproc/surface/faces/find_faces.hpp"

#include "preproc/surface/faces/face_figures.hpp"
#include "preproc/surface/faces/face_regions.hpp"
#include "preproc/surface/faces/join_faces.hpp"
#include "preproc/surface/faces/triangle_labels.hpp"
#include "preproc/surface/kernel/cut_surface.hpp"

#include <algorithm>

namespace scan2fea {
namespace {

std::vector<bool> border_vertices(const SurfaceMesh& mesh, const std::vector<std::uint32_t>& of_triangle) {
  std::vector<bool> is_border(mesh.vertices.size(), false);
  for (const FeatureEdge& e : borders_between(mesh, of_triangle))
    for (const std::uint32_t v : e) is_border[v] = true;
  return is_border;
}

}  // namespace

std::string_view kind_of(const SurfaceFace& face) {
  return face.shape ? name_of(face.shape->kind) : "free-form";
}

std::vector<FeatureEdge> borders_between(const SurfaceMesh& mesh, const std::vector<std::uint32_t>& label_of_triangle) {
  const std::vector<Triangle> neighbours = face_neighbours(mesh, VertexStars(mesh));
  std::vector<FeatureEdge> edges;
  for (std::uint32_t f = 0; f < neighbours.size(); ++f)
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t g = neighbours[f][k];
      if (g == no_face || g < f || label_of_triangle[f] == label_of_triangle[g]) continue;
      edges.push_back(feature_edge(mesh.triangles[f][(k + 1) % 3], mesh.triangles[f][(k + 2) % 3]));
    }
  std::sort(edges.begin(), edges.end());
  return edges;
}

SurfaceFaces find_faces(const SurfaceMesh& scan, const FeatureOptions& options, const Progress& progress) {
  progress("faces", 0);
  const Features features = find_features(scan, options);
  const CutSurface cut = cut_along(scan, features.edges);
  const Primitives found = find_primitives(cut.mesh, {}, progress);
  TriangleLabels labels(cut.mesh, found);
  FaceRegions regions = find_regions(scan, cut.mesh, labels, labels.label());

  SurfaceFaces faces{.list = {}, .of_triangle = std::move(regions.of_triangle), .noise = found.sigma};
  faces.list.resize(regions.label.size());
  for (std::uint32_t f = 0; f < faces.of_triangle.size(); ++f) faces.list[faces.of_triangle[f]].triangles.push_back(f);
  for (std::size_t i = 0; i < faces.list.size(); ++i) {
    SurfaceFace& face = faces.list[i];
    face.shape = regions.label[i] == no_primitive ? fit_face(scan, face.triangles, found.sigma)
                                                  : std::optional(found.list[regions.label[i]].shape);
  }
  join_faces(scan, face_neighbours(cut.mesh, VertexStars(cut.mesh)), found.sigma, faces);
  const std::vector<bool> is_border = border_vertices(scan, faces.of_triangle);
  for (SurfaceFace& face : faces.list) measure_face(scan, is_border, face);
  name_faces(scan, faces.list);
  for (std::uint32_t i = 0; i < faces.list.size(); ++i)
    for (const std::uint32_t f : faces.list[i].triangles) faces.of_triangle[f] = i;
  return faces;
}

}  // namespace scan2fea
