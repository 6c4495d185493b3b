#include "quality/report_page/still_pictures.hpp"

#include "preproc/mesh/surface_mesh.hpp"
#include "quality/picture/picture.hpp"
#include "quality/triangle_tree.hpp"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

namespace scan2fea {
namespace {

struct Direction {
  const char* title;
  Vec3 towards;
};

const std::vector<Direction>& directions() {
  static const std::vector<Direction> list{{"From the front, right and above", {-1, 1.4, -0.9}},
                                           {"From the back, left and above", {1, -1.4, -0.9}},
                                           {"From the front, right and below", {-1, 1.4, 0.9}}};
  return list;
}

PictureView near_to(const SurfaceMesh& mesh, const Vec3& place) {
  const Triangle& face = mesh.triangles[TriangleTree(mesh).closest(place).triangle];
  const Vec3 outward = area_vector(mesh, face).stableNormalized();
  constexpr double edges_across = 16;
  const double height = std::min(edges_across * mean_edge_length(mesh), bounding_box(mesh.vertices).diagonal());
  return {.towards = -outward,
          .up = std::abs(outward.z()) < 0.9 ? Vec3::UnitZ() : Vec3::UnitY(),
          .centre = place,
          .height = height,
          .nearest = height};
}

}  // namespace

const MeasuredElements& pictured_measure(const std::vector<MeasuredElements>& histograms) {
  const auto named = [&](const char* name) {
    return std::find_if(histograms.begin(), histograms.end(), [&](const auto& m) { return m.measure == name; });
  };
  for (const char* name : {"deviation", "scaled_jacobian"})
    if (const auto it = named(name); it != histograms.end()) return *it;
  return histograms.front();
}

std::vector<StillPicture> still_pictures(const ElementMeasures& measures, const TetMesh* volume_mesh,
                                         const std::vector<MeasuredElements>& histograms,
                                         const std::optional<CloseUp>& close_up) {
  std::vector<StillPicture> pictures;
  const SurfaceMesh& mesh = measures.faces;
  if (mesh.triangles.empty()) return pictures;
  std::vector<std::uint32_t> behind;
  if (volume_mesh != nullptr)
    for (std::size_t f = 0; f < mesh.triangles.size(); ++f) behind.push_back(volume_mesh->boundary[f].tetrahedron);
  const std::vector<Rgb> colours = colours_of_measure(pictured_measure(histograms), {}, behind).of_faces;
  const std::size_t views = directions().size();
  pictures.resize(views + (close_up ? 1 : 0));
  tbb::parallel_for(std::size_t{0}, pictures.size(), [&](std::size_t i) {
    if (i < views) {
      const Direction& direction = directions()[i];
      const PictureView view = view_of_all(mesh, direction.towards, Vec3::UnitZ());
      pictures[i] = {draw_picture(mesh, colours, view), direction.title};
    } else {
      const PictureOptions options{.edges = true, .ring = close_up->place};
      pictures[i] = {draw_picture(mesh, colours, near_to(mesh, close_up->place), options), close_up->title};
    }
  });
  return pictures;
}

}  // namespace scan2fea
