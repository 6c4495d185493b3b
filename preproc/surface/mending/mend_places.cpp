#include "preproc/surface/mending/mend_places.hpp"

#include "preproc/mesh/error.hpp"
#include "preproc/surface/kernel/adjacency.hpp"
#include "preproc/surface/mending/refinement_patch.hpp"
#include "quality/face_blocks.hpp"

#include <algorithm>
#include <string>

namespace scan2fea {
namespace {

// Of faces around those of the place: they hold the change of lengths, and what moves to make room.
constexpr int rings = 1;

void check(const MendPlacesOptions& options) {
  if (!(options.limit > 0) || !(options.least_angle_deg > 0 && options.least_angle_deg < 60))
    throw WrongUsage({.what = "options of mending places out of range",
                      .where = {},
                      .value = "limit " + std::to_string(options.limit) + ", " +
                               std::to_string(options.least_angle_deg) + " degrees",
                      .limit = "above 0, 0 to 60 degrees",
                      .advice = {}});
}

// The vertex nearest to the middle, and those within the ball that are connected to it there: not the other side of a
// wall.
std::vector<std::uint32_t> vertices_of_place(const SurfaceMesh& mesh, const VertexStars& stars, const Ball& where) {
  const auto squared_distance = [&](std::uint32_t v) { return (mesh.vertices[v] - where.centre).squaredNorm(); };
  std::uint32_t nearest = mesh.triangles.front()[0];
  for (std::uint32_t v = 0; v < mesh.vertices.size(); ++v)
    if (squared_distance(v) < squared_distance(nearest) && !stars.corners(v).empty()) nearest = v;
  std::vector<std::uint32_t> reached{nearest};
  std::vector<bool> is_known(mesh.vertices.size(), false);
  is_known[nearest] = true;
  for (std::size_t i = 0; i < reached.size(); ++i)
    for (const std::uint32_t corner : stars.corners(reached[i]))
      for (const std::uint32_t v : mesh.triangles[corner / 3]) {
        if (is_known[v] || squared_distance(v) > where.radius * where.radius) continue;
        is_known[v] = true;
        reached.push_back(v);
      }
  return reached;
}

std::vector<std::uint32_t> faces_around(const SurfaceMesh& mesh, const RefinementPatch& patch) {
  std::vector<std::uint32_t> around;
  for (std::uint32_t f = 0; f < mesh.triangles.size(); ++f)
    if (boxes_meet(box_of_face(mesh, f), patch.box()) &&
        !std::binary_search(patch.faces().begin(), patch.faces().end(), f))
      around.push_back(f);
  return around;
}

std::vector<std::uint32_t> scan_faces_around(const TriangleTree& tree, const RefinementPatch& patch) {
  std::vector<std::uint32_t> around;
  tree.for_each_overlap(patch.box(), [&](std::uint32_t f) { around.push_back(f); });
  std::sort(around.begin(), around.end());
  return around;
}

}  // namespace

MendPlacesResult mend_places(SurfaceMesh& mesh, FeatureNet& net, const ReferenceSurface& scan,
                             const TriangleTree& scan_tree, std::span<const ShorterEdges> places,
                             const MendPlacesOptions& options, const Progress& progress) {
  check(options);
  net.patch_of_face.clear();
  PatchGoal goal;
  goal.limit = options.limit;
  goal.fidelity = options.fidelity_of_diagonal * scan.diagonal;
  goal.least_angle_deg = options.least_angle_deg;
  goal.for_shape = true;
  MendPlacesResult result;
  for (std::size_t i = 0; i < places.size(); ++i) {
    progress("mending places", static_cast<double>(i) / static_cast<double>(places.size()));
    const ShorterEdges& place = places[i];
    const VertexStars stars(mesh);
    RefinementPatch patch(mesh, stars, vertices_of_place(mesh, stars, place.where), rings, options.limit,
                          line_edges(net));
    const std::vector<std::uint32_t> around = faces_around(mesh, patch);
    const std::vector<std::uint32_t> scan_faces = scan_faces_around(scan_tree, patch);
    goal.most_vertices = options.most_vertices - std::min(options.most_vertices, result.inserted);
    const PatchOutcome outcome = options.reason == MendFor::shape
                                     ? patch.improve(mesh, around, scan.whole, scan_faces, net, goal)
                                     : patch.shorten(mesh, around, scan.whole, scan_faces, net, goal, place);
    if (!outcome.reached) result.left.push_back(place);
    if (!outcome.improved) continue;
    patch.write(mesh, net);
    result.inserted += patch.inserted();
    ++result.mended;
  }
  return result;
}

}  // namespace scan2fea
