#include "preproc/surface/faces/find_faces.hpp"

#include "preproc/surface/faces/face_figures.hpp"
#include "preproc/surface/faces/face_regions.hpp"
#include "preproc/surface/faces/join_faces.hpp"
#include "preproc/surface/faces/thinned_primitives.hpp"
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

void number_triangles(SurfaceFaces& faces) {
  for (std::uint32_t i = 0; i < faces.list.size(); ++i)
    for (const std::uint32_t f : faces.list[i].triangles) faces.of_triangle[f] = i;
}

// Shapes give faces, and faces that were fitted as a whole give shapes that win back what went elsewhere.
class FaceFinder {
 public:
  FaceFinder(const SurfaceMesh& scan, CutSurface cut, const Progress& progress)
      : scan_(scan),
        cut_(std::move(cut)),
        smooth_(face_neighbours(cut_.mesh, VertexStars(cut_.mesh))),
        known_(find_thinned_primitives(cut_.mesh, progress)),
        is_fitted_(known_.list.size(), false) {}

  SurfaceFaces run() {
    constexpr int most_rounds = 5;
    SurfaceFaces faces = from_shapes();
    for (int round = 1; round < most_rounds; ++round) {
      take_shapes(faces);
      SurfaceFaces next = from_shapes();
      const bool same = next.of_triangle == faces.of_triangle;
      faces = std::move(next);
      if (same) break;
    }
    return faces;
  }

 private:
  SurfaceFaces from_shapes() const {
    TriangleLabels labels(cut_.mesh, known_);
    FaceRegions regions = find_regions(scan_, cut_.mesh, labels, labels.label());
    SurfaceFaces faces{.list = {}, .of_triangle = std::move(regions.of_triangle), .noise = known_.sigma};
    faces.list.resize(regions.label.size());
    for (std::uint32_t f = 0; f < faces.of_triangle.size(); ++f)
      faces.list[faces.of_triangle[f]].triangles.push_back(f);
    for (std::size_t i = 0; i < faces.list.size(); ++i) {
      SurfaceFace& face = faces.list[i];
      const std::uint32_t label = regions.label[i];
      if (label != no_primitive) face.shape = known_.list[label].shape;
      if (label != no_primitive && !is_fitted_[label]) continue;
      if (const auto shape = fit_face(scan_, face.triangles, known_.sigma)) face.shape = shape;
    }
    join_faces(scan_, smooth_, known_.sigma, faces);
    return faces;
  }

  void take_shapes(const SurfaceFaces& faces) {
    std::vector<Primitive> list;
    std::vector<bool> is_fitted;
    std::vector<std::uint32_t> number(faces.list.size(), no_primitive);
    for (std::size_t i = 0; i < number.size(); ++i) {
      const auto& shape = faces.list[i].shape;
      if (!shape) continue;
      number[i] = static_cast<std::uint32_t>(list.size());
      const auto same = std::find_if(known_.list.begin(), known_.list.end(), [&](const Primitive& p) {
        return p.shape.kind == shape->kind && p.shape.origin == shape->origin && p.shape.axis == shape->axis;
      });
      is_fitted.push_back(same == known_.list.end() ||
                          is_fitted_[static_cast<std::size_t>(same - known_.list.begin())]);
      list.push_back({.shape = *shape, .relations = {}});
    }
    for (std::uint32_t f = 0; f < faces.of_triangle.size(); ++f)
      for (const std::uint32_t v : cut_.mesh.triangles[f]) known_.labels[v] = number[faces.of_triangle[f]];
    known_.list = std::move(list);
    is_fitted_ = std::move(is_fitted);
  }

  const SurfaceMesh& scan_;
  CutSurface cut_;
  std::vector<Triangle> smooth_;  // neighbours, but across creases
  Primitives known_;
  std::vector<bool> is_fitted_;  // per shape: to one face, and not by find_primitives
};

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
  FaceFinder finder(scan, cut_along(scan, features.edges), progress);
  SurfaceFaces faces = finder.run();
  const std::vector<bool> is_border = border_vertices(scan, faces.of_triangle);
  for (SurfaceFace& face : faces.list) measure_face(scan, is_border, face);
  name_faces(scan, faces.noise, faces.list);
  number_triangles(faces);
  return faces;
}

}  // namespace scan2fea
