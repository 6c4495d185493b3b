#include "preproc/surface/mending/mend_places.hpp"

#include "preproc/mesh/error.hpp"
#include "preproc/surface/kernel/adjacency.hpp"
#include "preproc/surface/mending/mend_patches.hpp"

#include <initializer_list>
#include <limits>
#include <string>
#include <utility>

namespace scan2fea {
namespace {

// Of faces around those of the place: they hold what moves to make room. Where it cannot be mended as it is, edges are
// made shorter, with more faces for the change of lengths.
constexpr int rings_moved = 1, rings_shortened = 2;

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

// As they are, then those that are left with shorter edges.
MendPlacesResult mend(PatchMender& mender, std::vector<PatchPlace> places, const PatchGoal& goal,
                      const Progress& progress) {
  places = mender.mend(std::move(places), rings_moved, Mending::improve, goal, progress);
  const std::size_t good_enough =
      std::erase_if(places, [](const PatchPlace& place) { return place.shorter.factor >= least_shortening; });
  places = mender.mend(std::move(places), rings_shortened, Mending::shorten, goal, progress);
  const PatchChanges changes = mender.take_changes();
  return {changes.patches, changes.inserted, good_enough + places.size()};
}

PatchGoal goal_of(const MendPlacesOptions& options, const ReferenceSurface& scan) {
  PatchGoal goal;
  goal.limit = options.limit;
  goal.fidelity = options.fidelity_of_diagonal * scan.diagonal;
  goal.least_angle_deg = options.least_angle_deg;
  goal.most_vertices = std::numeric_limits<std::size_t>::max();
  goal.for_shape = true;
  return goal;
}

}  // namespace

MendPlacesResult mend_places(SurfaceMesh& mesh, FeatureNet& net, const ReferenceSurface& scan,
                             const TriangleTree* scan_tree, std::span<const ShorterEdges> places,
                             const MendPlacesOptions& options, const Progress& progress) {
  check(options);
  PatchMender mender(mesh, net, scan, scan_tree);
  const VertexStars stars(mesh);
  std::vector<PatchPlace> left;
  for (const ShorterEdges& place : places)
    left.push_back({vertices_of_place(mesh, stars, place.where), options.limit, place});
  return mend(mender, std::move(left), goal_of(options, scan), progress);
}

MendPlacesResult bring_faces_within(SurfaceMesh& mesh, FeatureNet& net, const ReferenceSurface& scan,
                                    const TriangleTree* scan_tree, std::span<const std::uint32_t> faces,
                                    double deviation, const MendPlacesOptions& options, const Progress& progress) {
  constexpr double factor = 0.6;
  check(options);
  PatchMender mender(mesh, net, scan, scan_tree);
  std::vector<PatchPlace> places;
  for (const std::uint32_t f : faces) {
    const Triangle& t = mesh.triangles[f];
    places.push_back({{t.begin(), t.end()}, options.limit, shorter_around(mesh, f, factor)});
  }
  PatchGoal goal = goal_of(options, scan);
  goal.for_shape = false;
  goal.limit = goal.allowed = deviation;
  goal.elsewhere = options.limit;
  for (const int rings : {rings_moved, rings_shortened})
    places = mender.mend(std::move(places), rings, Mending::improve, goal, progress);
  places = mender.mend(std::move(places), rings_shortened, Mending::shorten, goal, progress);
  const PatchChanges changes = mender.take_changes();
  return {changes.patches, changes.inserted, places.size()};
}

MendPlacesResult mend_tangles(SurfaceMesh& mesh, FeatureNet& net, const ReferenceSurface& scan,
                              const SurfaceDefects& defects, const MendPlacesOptions& options,
                              const Progress& progress) {
  check(options);
  std::vector<PatchPlace> tangles;
  const auto add = [&](std::initializer_list<std::uint32_t> faces) {
    PatchPlace place{{}, options.limit, shorter_around(mesh, *faces.begin(), most_shortening)};
    for (const std::uint32_t f : faces)
      place.seeds.insert(place.seeds.end(), mesh.triangles[f].begin(), mesh.triangles[f].end());
    tangles.push_back(std::move(place));
  };
  for (const FacePair& pair : defects.crossings) add({pair.face, pair.other});
  for (const std::uint32_t f : defects.inverted) add({f});
  PatchGoal goal = goal_of(options, scan);
  goal.may_be_tangled = true;
  PatchMender mender(mesh, net, scan, nullptr);
  return mend(mender, std::move(tangles), goal, progress);
}

}  // namespace scan2fea
