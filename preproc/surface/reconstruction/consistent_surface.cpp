#include "preproc/surface/reconstruction/consistent_surface.hpp"

#include "preproc/mesh/error.hpp"
#include "preproc/mesh/error_text.hpp"
#include "preproc/mesh/sorted_corners.hpp"
#include "preproc/surface/kernel/adjacency.hpp"
#include "preproc/surface/kernel/components.hpp"
#include "preproc/surface/primitives/find_primitives.hpp"
#include "preproc/surface/primitives/point_normals.hpp"
#include "preproc/surface/reconstruction/cell_sides.hpp"
#include "preproc/surface/reconstruction/delaunay.hpp"
#include "preproc/surface/reconstruction/minimum_cut.hpp"
#include "quality/triangle_tree.hpp"
#include "quality/validity.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <set>

namespace scan2fea {
namespace {

// So that each component of a front has its normals outwards, by what it encloses with a fan about its centre.
void orient(const std::vector<Vec3>& points, std::vector<Triangle>& triangles) {
  SurfaceMesh mesh{points, std::move(triangles)};
  const Components components = find_components(mesh);
  std::vector<Vec3> centre(components.count, Vec3::Zero());
  std::vector<double> corners(components.count, 0.0), volume(components.count, 0.0);
  const auto of = [&](const Triangle& t) { return components.of_vertex[t[0]]; };
  for (const Triangle& t : mesh.triangles)
    for (const std::uint32_t v : t) centre[of(t)] += points[v], corners[of(t)] += 1;
  for (const Triangle& t : mesh.triangles) {
    const Vec3 c = centre[of(t)] / corners[of(t)];
    volume[of(t)] += (points[t[0]] - c).dot((points[t[1]] - c).cross(points[t[2]] - c));
  }
  for (Triangle& t : mesh.triangles)
    if (volume[of(t)] < 0) std::swap(t[1], t[2]);
  triangles = std::move(mesh.triangles);
}

struct Candidate {
  ConsistentSurface surface;
  std::string name;
  std::vector<const WoundSurface*> fronts;
  bool is_shaped = false;
  std::size_t faults() const {
    constexpr std::size_t of_body = 10;
    return of_body * (surface.bodies - 1) + surface.off_surface.size() + surface.pinched_edges + surface.overlong;
  }
};

class Search {
 public:
  Search(const std::vector<Vec3>& points, const std::vector<double>& spacing, const PointViews& views,
         const Progress& progress)
      : points_(points), spacing_(spacing), views_(views), progress_(progress) {}

  // Instead of fronts, a surface through most of the points.
  ConsistentSurface run_again(const ConsistentSurface& before) {
    cells_ = Delaunay(points_).cells();
    look();
    for (std::size_t i = 0; i < before.triangles.size(); ++i)
      if (!before.is_made_up[i]) supported_.insert(sorted(before.triangles[i]));
    fronts_.push_back(wind(points_, cells_, before.triangles));
    add_candidate(before.choice, {&fronts_[0]});
    if (candidates_.empty()) return {};
    join_best();
    return choose();
  }

  ConsistentSurface run() {
    make_fronts();
    look();
    std::vector<const WoundSurface*> all;
    for (const WoundSurface& front : fronts_) all.push_back(&front);
    add_candidate("what advancing fronts agree on", all);
    // A share of faults goes with the number of points.
    constexpr std::size_t points_of_one = 20'000;
    const bool is_clean = !candidates_.empty() && candidates_[0].faults() <= points_.size() / points_of_one;
    for (std::size_t i = 0; i < fronts_.size() && !is_clean; ++i)
      add_candidate("an advancing front of beta " + error_text(betas_[i]), {&fronts_[i]});
    if (candidates_.empty())
      throw NotMeshable({.what = "the cloud shows no solid: no surface through its points encloses a volume",
                         .where = {},
                         .value = std::to_string(points_.size()) + " points",
                         .limit = {},
                         .advice = "a scan of all sides of the part"});
    join_best();
    hold_against_shapes();
    return choose();
  }

 private:
  static constexpr std::size_t points_of_fault = 200;

  // The best once more, by what its shapes say where it is a part, else by its normals.
  void hold_against_shapes() {
    constexpr std::size_t few = 20'000;  // beyond, fronts go astray no more, and shapes take long
    const Candidate best = *std::ranges::min_element(candidates_, {}, &Candidate::faults);
    // A surface that crumples tells no shapes: what was scanned is open.
    if (points_.size() > few || best.surface.pinched_edges > points_.size() / points_of_fault) return;
    shapes_ = find_primitives({points_, best.surface.triangles}, {}, progress_);
    if (shapes_.kind != ScanKind::part) return look_twice(best);
    add_instead_of(best,
                   {.surface = {},
                    .name = best.name + ", held against the part's shapes",
                    .fronts = best.fronts,
                    .is_shaped = true},
                   sides_by_shapes(points_, cells_, shapes_), seen_);
  }

  void look() {
    // Over the areas that the cut saves. By trials with 1 to 32: less leaves thin sheets with holes, more crumples
    // edges, beyond which a face's points take for inside what is behind them.
    constexpr double weight = 4;
    if (!views_.is_empty()) seen_ = see_cells(points_, spacing_, cells_, views_, weight);
  }

  // Of a free form the best once more, by the normals that came with the points, or else those that it tells: single
  // points of a thin limb say more about its inside than triangles across it.
  void look_twice(const Candidate& best) {
    // No edges that it crumples, as on parts: by trials with 4 to 32; beyond, webs come in between limbs.
    constexpr double weight = 8;
    PointViews views = views_;
    if (views.normals.empty()) views.normals = normals_ = normals_by(best.surface.triangles);
    add_instead_of(best, {.surface = {}, .name = best.name + ", and what normals tell", .fronts = best.fronts}, {},
                   see_cells(points_, spacing_, cells_, views, weight));
  }

  std::vector<Vec3> normals_by(const std::vector<Triangle>& triangles) const {
    constexpr std::size_t neighbours = 20;
    const std::vector<Vec3> outwards = vertex_normals({points_, triangles});
    return own_side_normals(points_, nearest_in_space(points_, outwards, neighbours), outwards).normals;
  }

  // Cut by more than fronts say, and alone from then on unless more is wrong with it.
  void add_instead_of(const Candidate& best, Candidate candidate, const std::vector<CellSide>& known,
                      const SeenCells& seen) {
    if (!take(cut_surface(points_, spacing_, cells_, best.fronts, known, seen), candidate.surface)) return;
    // Where shapes meet in edges, a fault or two may come in with what they mend.
    if (candidate.surface.bodies > best.surface.bodies ||
        candidate.faults() > best.faults() + points_.size() / points_of_fault)
      return;
    candidates_.clear();
    candidates_.push_back(std::move(candidate));
  }

  void make_fronts() {
    constexpr std::size_t few = 50'000;  // beyond, the time of more fronts is better spent elsewhere
    betas_ = points_.size() < few ? std::vector{0.3, 0.52, 0.7, 0.9} : std::vector{0.52, 0.9};
    Delaunay delaunay(points_);
    progress_("reconstruction", 0.3);
    cells_ = delaunay.cells();
    for (const double beta : betas_) {
      std::vector<Triangle> front = delaunay.advancing_front(beta);
      for (const Triangle& t : front) supported_.insert(sorted(t));
      orient(points_, front);
      fronts_.push_back(wind(points_, cells_, std::move(front)));
      progress_("reconstruction", 0.3 + 0.4 * static_cast<double>(fronts_.size()) / static_cast<double>(betas_.size()));
    }
  }

  void add_candidate(std::string name, const std::vector<const WoundSurface*>& fronts) {
    Candidate candidate{.surface = {}, .name = std::move(name), .fronts = fronts};
    const bool is_any = take(cut_surface(points_, spacing_, cells_, fronts, {}, seen_), candidate.surface);
    progress_("reconstruction", 0.75 + 0.05 * static_cast<double>(candidates_.size()));
    if (is_any) candidates_.push_back(std::move(candidate));
  }

  // By what its own fronts have in one, and by what any has.
  void join_best() {
    const Candidate best = *std::ranges::min_element(candidates_, {}, &Candidate::faults);
    if (best.surface.bodies == 1) return;
    constexpr double longest = 2;  // spacings: wider gaps are no accident of a front
    std::vector<const WoundSurface*> all;
    for (const WoundSurface& front : fronts_) all.push_back(&front);
    for (const auto& fronts : {best.fronts, all}) {
      Candidate joined{.surface = {}, .name = best.name + " with its pieces joined", .fronts = fronts};
      if (take(join_pieces(points_, spacing_, cells_, fronts, best.surface.triangles, longest, seen_), joined.surface))
        candidates_.push_back(std::move(joined));
    }
  }

  // And measures it; false where there is none.
  bool take(CutSurface cut, ConsistentSurface& surface) const {
    if (cut.triangles.empty()) return false;
    surface.triangles = std::move(cut.triangles);
    surface.pinched_edges = cut.pinched_edges;
    const SurfaceMesh mesh{points_, surface.triangles};
    surface.bodies = check_validity(mesh).components;
    std::vector<bool> used(points_.size(), false);
    for (const Triangle& t : mesh.triangles) {
      for (const std::uint32_t v : t) used[v] = true;
      surface.overlong += length_in_spacings(points_, spacing_, t) > long_for_spacing;
    }
    const TriangleTree tree(mesh);
    for (std::uint32_t i = 0; i < points_.size(); ++i)
      if (!used[i] && !tree.closest_within(points_[i], 0.5 * spacing_[i])) surface.off_surface.push_back(i);
    return true;
  }

  ConsistentSurface choose() {
    const auto best = std::ranges::min_element(candidates_, {}, &Candidate::faults);
    const auto text = [](const ConsistentSurface& s) {
      return std::to_string(s.bodies) + (s.bodies == 1 ? " body, " : " bodies, ") +
             std::to_string(s.off_surface.size()) + " points off it, " + std::to_string(s.pinched_edges) +
             " edges where it met itself, " + std::to_string(s.overlong) + " overlong triangles";
    };
    best->surface.choice = best->name + ": " + text(best->surface);
    if (candidates_.size() > 1) {
      const auto worst = std::ranges::max_element(candidates_, {}, &Candidate::faults);
      best->surface.choice += "; the best of " + std::to_string(candidates_.size());
      if (worst->faults() > best->faults()) best->surface.choice += ", the worst with " + text(worst->surface);
    }
    // Shapes and normals say more than fronts; but across a gap they say nothing.
    for (const Triangle& t : best->surface.triangles)
      best->surface.is_made_up.push_back(
          !supported_.contains(sorted(t)) &&
          ((!best->is_shaped && !is_seen(t)) || length_in_spacings(points_, spacing_, t) > long_for_spacing));
    best->surface.shapes = std::move(shapes_);
    return std::move(best->surface);
  }

  // By the normals of its corners: the cap of a gap turns from those of the gap's rim.
  bool is_seen(const Triangle& t) const {
    constexpr double least = 0.3;  // cosine: a bevel of an edge has 0.7, or 0.6 in a corner
    const std::vector<Vec3>& normals = views_.normals.empty() ? normals_ : views_.normals;
    if (normals.empty()) return false;
    const Vec3 n = (points_[t[1]] - points_[t[0]]).cross(points_[t[2]] - points_[t[0]]).normalized();
    return std::ranges::all_of(t, [&](std::uint32_t v) { return normals[v].dot(n) > least; });
  }

  const std::vector<Vec3>& points_;
  const std::vector<double>& spacing_;
  const PointViews& views_;
  const Progress& progress_;
  std::vector<Vec3> normals_;  // where none came with the points
  SeenCells seen_;
  std::vector<double> betas_;
  DelaunayCells cells_;
  std::vector<WoundSurface> fronts_;
  std::set<Triangle> supported_;  // by a front
  std::vector<Candidate> candidates_;
  Primitives shapes_;
};

}  // namespace

double length_in_spacings(const std::vector<Vec3>& points, const std::vector<double>& spacing, const Triangle& t) {
  double longest = 0, widest = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    longest = std::max(longest, (points[t[(k + 1) % 3]] - points[t[k]]).norm());
    widest = std::max(widest, spacing[t[k]]);
  }
  return longest / widest;
}

ConsistentSurface renew_surface(const std::vector<Vec3>& points, const std::vector<double>& spacing,
                                const ConsistentSurface& before, const PointViews& views, const Progress& progress) {
  return Search(points, spacing, views, progress).run_again(before);
}

ConsistentSurface find_consistent_surface(const std::vector<Vec3>& points, const std::vector<double>& spacing,
                                          const PointViews& views, const Progress& progress) {
  return Search(points, spacing, views, progress).run();
}

}  // namespace scan2fea
