#include "preproc/surface/collapse/collapse.hpp"

#include "preproc/mesh/error.hpp"
#include "preproc/mesh/names.hpp"
#include "preproc/surface/collapse/collapse_cost.hpp"
#include "preproc/surface/kernel/face_boxes.hpp"
#include "preproc/surface/kernel/halfedge_mesh.hpp"
#include "preproc/surface/kernel/indexed_heap.hpp"
#include "preproc/surface/placement/lifting.hpp"
#include "preproc/surface/placement/place_vertex.hpp"
#include "quality/face_blocks.hpp"
#include "quality/self_intersections.hpp"
#include "quality/triangle_tree.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <string>
#include <utility>

namespace scan2fea {
namespace {

using Index = HalfedgeMesh::Index;

constexpr NameTable<CollapseCost, 4> cost_names{{
    {CollapseCost::bending_energy, "bending-energy"},
    {CollapseCost::quadric_error, "quadric-error"},
    {CollapseCost::edge_length, "edge-length"},
    {CollapseCost::sized_length, "sized-length"},
}};

double cosine_of_deg(double angle) {
  return std::cos(angle * std::numbers::pi / 180);
}

void check(const CollapseOptions& options, const SurfaceMesh& mesh) {
  const auto refuse = [](const char* what, std::string value, const char* limit) {
    throw WrongUsage({.what = what, .where = {}, .value = std::move(value), .limit = limit, .advice = {}});
  };
  if (options.target_faces < 4) refuse("too few target faces", std::to_string(options.target_faces), "at least 4");
  if (!(options.largest_normal_turn_deg >= 10 && options.largest_normal_turn_deg <= 85))
    refuse("largest normal turn out of range", std::to_string(options.largest_normal_turn_deg), "10 to 85 degrees");
  if (options.cost != CollapseCost::sized_length) return;
  if (options.sizing.size() != mesh.vertices.size())
    refuse("the sizing field does not fit the surface", std::to_string(options.sizing.size()), "one value per vertex");
  for (const double h : options.sizing)
    if (!(h > 0)) refuse("wanted edge length is not positive", std::to_string(h), "> 0");
}

class Simplifier {
 public:
  Simplifier(const SurfaceMesh& mesh, const CollapseOptions& options)
      : mesh_(mesh),
        options_(options),
        predictor_(mesh_, options.cost, options.sizing),
        heap_(3 * mesh_.face_slots()),
        smallest_turn_cosine_(cosine_of_deg(options.largest_normal_turn_deg)) {
    if (options.keep_clear) boxes_.emplace(mesh);
    if (options.lifting == CollapseLifting::closest_point) {
      scan_.emplace(mesh);
      scan_normals_.reserve(mesh.triangles.size());
      scan_triangle_.resize(mesh.vertices.size());
      for (Index f = 0; f < mesh.triangles.size(); ++f) {
        scan_normals_.push_back(mesh_.area_vector(f).cast<float>());
        for (const Index v : mesh.triangles[f]) scan_triangle_[v] = f;
      }
    }
  }

  CollapseResult run(const Progress& progress) {
    CollapseResult result{.faces_before = mesh_.face_count()};
    const std::size_t to_remove = mesh_.face_count() - std::min(mesh_.face_count(), options_.target_faces);
    const std::size_t report_every = std::max<std::size_t>(1, to_remove / 200);
    bool progressed = true;
    while (mesh_.face_count() > options_.target_faces) {
      if (heap_.empty()) {
        // What was refused may have become possible as its surroundings changed.
        if (!std::exchange(progressed, false)) break;
        fill_heap();
        continue;
      }
      const double key = heap_.top_key();
      const Index h = heap_.pop();
      if (predictor_.sees_far()) {
        // Contractions around have changed it. At 0 or 20 % instead of 2 % the 99th percentile of the edge ratio
        // is 2.42 or 2.45 instead of 2.39 (the Horse to 8,000 faces).
        const double now = predictor_(h);
        if (now > key * 1.02) {
          heap_.push(h, now);
          continue;
        }
      }
      if (!try_contract(h)) {
        ++result.refused;
        continue;
      }
      progressed = true;
      if (++result.collapses % report_every == 0)
        progress("collapse",
                 static_cast<double>(result.faces_before - mesh_.face_count()) / static_cast<double>(to_remove));
    }
    result.faces_after = mesh_.face_count();
    result.reached_target = mesh_.face_count() <= options_.target_faces;
    return result;
  }

  SurfaceMesh take() const { return mesh_.to_surface(); }

 private:
  static Index edge_of(const HalfedgeMesh& mesh, Index h) {
    return mesh.is_border(h) ? h : std::min(h, mesh.opposite(h));
  }

  void fill_heap() {
    for (Index h = 0; h < 3 * mesh_.face_slots(); ++h)
      if (mesh_.is_face_alive(HalfedgeMesh::face(h)) && edge_of(mesh_, h) == h) heap_.push(h, predictor_(h));
  }

  template <class Visit>
  void for_each_edge_at(Index v, Visit visit) const {
    mesh_.for_each_outgoing(v, [&](Index h) {
      visit(edge_of(mesh_, h));
      const Index p = HalfedgeMesh::prev(h);
      if (mesh_.is_border(p)) visit(p);
    });
  }

  bool try_contract(Index h) {
    if (!mesh_.can_collapse(h)) return false;
    const bool border_origin = mesh_.is_border_vertex(mesh_.origin(h));
    const bool border_target = mesh_.is_border_vertex(mesh_.target(h));
    if (border_target && !border_origin) h = mesh_.opposite(h);  // the border's vertex is kept
    merged_rim(mesh_, h, rim_);
    link_.clear();
    for (const Index r : rim_) link_.push_back(mesh_.points[mesh_.origin(r)]);

    const Index kept = mesh_.origin(h), removed = mesh_.target(h);
    std::optional<Vec3> place;
    Index scan_triangle = scan_ ? scan_triangle_[kept] : 0;
    if (border_origin || border_target)
      place = border_place(h);
    else
      place = inner_place(h, scan_triangle);
    if (!place || (boxes_ && !stays_clear(h, *place))) return false;

    for (const Index v : {kept, removed})
      for_each_edge_at(v, [&](Index e) {
        if (heap_.contains(e)) heap_.remove(e);
      });
    if (boxes_) boxes_->remove(HalfedgeMesh::face(h));
    if (boxes_ && !mesh_.is_border(h)) boxes_->remove(HalfedgeMesh::face(mesh_.opposite(h)));
    predictor_.merge(kept, removed);
    mesh_.collapse(h);
    mesh_.points[kept] = *place;
    if (boxes_)
      mesh_.for_each_outgoing(kept, [&](Index out) {
        const Index f = HalfedgeMesh::face(out);
        boxes_->set(f, box_of_face(mesh_.points, mesh_.triangle(f)));
      });
    if (scan_) scan_triangle_[kept] = scan_triangle;
    for_each_edge_at(kept, [&](Index e) { heap_.push(e, predictor_(e)); });
    return true;
  }

  // A border's vertex stays unless the border itself is contracted, which it is only where it is nearly straight.
  std::optional<Vec3> border_place(Index h) const {
    const Vec3 a = mesh_.points[mesh_.origin(h)], b = mesh_.points[mesh_.target(h)];
    if (!mesh_.is_border(h)) return keeps_orientation(a) ? std::optional(a) : std::nullopt;
    const Vec3 before = mesh_.points[border_predecessor(mesh_.origin(h))];
    const Vec3 after = mesh_.points[mesh_.target(mesh_.outgoing(mesh_.target(h)))];
    // A border with the turns of a regular polygon of more than twelve sides may be thinned; sharper corners stay.
    const double straight = cosine_of_deg(30);
    const auto turns = [&](const Vec3& from, const Vec3& to) {
      return from.dot(to) < straight * from.norm() * to.norm();
    };
    const Vec3 middle = 0.5 * (a + b);
    if (turns(a - before, b - a) || turns(b - a, after - b) || !keeps_orientation(middle)) return std::nullopt;
    return middle;
  }

  Index border_predecessor(Index v) const {
    Index last = HalfedgeMesh::none;
    mesh_.for_each_outgoing(v, [&](Index h) { last = h; });
    return mesh_.origin(HalfedgeMesh::prev(last));
  }

  std::optional<Vec3> inner_place(Index h, Index& scan_triangle) const {
    const Vec3 a = mesh_.points[mesh_.origin(h)], b = mesh_.points[mesh_.target(h)];
    const Vec3 normal = star_normal(link_);
    const Star star{0.5 * (a + b), link_};
    const Lift lift = [&](const Vec3& x) -> Vec3 {
      switch (options_.lifting) {
        case CollapseLifting::keep_volume:
          return volume_keeping(x, normal, h);
        case CollapseLifting::closest_point:
          return closest_on_scan(x, normal, scan_triangle);
        case CollapseLifting::shepard:
          return shepard_over_star(x, normal, a, b);
      }
      return x;
    };
    if (options_.objective) {
      const PlaceVertexResult placed = place_vertex(star, normal, {.objective = *options_.objective}, lift);
      if (placed.feasible && keeps_orientation(placed.position)) return placed.position;
    }
    const Vec3 middle = lift(star.centre);
    const bool sound = is_star_feasible({middle, link_}, normal, PlaceVertexOptions{}.smallest_normal_cosine) &&
                       keeps_orientation(middle);
    return sound ? std::optional(middle) : std::nullopt;
  }

  // The other side of a thin wall may be nearer: a point whose normal looks away is no lift.
  Vec3 closest_on_scan(const Vec3& x, const Vec3& normal, Index& scan_triangle) const {
    const ClosestPoint found = scan_->closest(x, scan_triangle);
    if (!(scan_normals_[found.triangle].cast<double>().dot(normal) > 0)) return x;
    scan_triangle = found.triangle;
    return found.point;
  }

  // The star's volume is linear in the height of its centre over the plane, with the link's area as slope.
  Vec3 volume_keeping(const Vec3& x, const Vec3& normal, Index h) const {
    double sixfold_volume = 0, doubled_area = 0;
    const auto add_face = [&](Index f) {
      const Triangle t = mesh_.triangle(f);
      sixfold_volume += (mesh_.points[t[0]] - x).dot((mesh_.points[t[1]] - x).cross(mesh_.points[t[2]] - x));
    };
    for (const Index r : rim_) {
      add_face(HalfedgeMesh::face(r));
      doubled_area += (mesh_.points[mesh_.origin(r)] - x).cross(mesh_.points[mesh_.target(r)] - x).dot(normal);
    }
    add_face(HalfedgeMesh::face(h));
    add_face(HalfedgeMesh::face(mesh_.opposite(h)));
    return doubled_area > 0 ? Vec3(x + sixfold_volume / doubled_area * normal) : x;
  }

  Vec3 shepard_over_star(const Vec3& x, const Vec3& normal, const Vec3& a, const Vec3& b) const {
    samples_.assign({{a, normal}, {b, normal}});
    double radius = 0;
    for (const Vec3& p : link_) {
      samples_.push_back({p, normal});
      radius = std::max(radius, (p - x).norm());
    }
    // Wendland's weight is 0 at the radius: the farthest vertex would not count.
    return x + lifted_height(Lifting::shepard, samples_, x, normal, 1.01 * radius) * normal;
  }

  // No face of the star turns by more than the limit, and none folds back onto its outer neighbour: by
  // more than 102 degrees, where it did so less before. Without that limit the 99th percentile of the edge ratio
  // is 2.43 instead of 2.39 on the Horse at 8,000 faces; at 73 degrees, which refuses too much, 2.47.
  bool keeps_orientation(const Vec3& place) const {
    for (const Index r : rim_) {
      const Vec3& from = mesh_.points[mesh_.origin(r)];
      const Vec3& to = mesh_.points[mesh_.target(r)];
      const Vec3 now = (from - place).cross(to - place);
      const Vec3 before = mesh_.area_vector(HalfedgeMesh::face(r));
      const double size = now.norm();
      if (!(size > 0)) return false;
      if (now.dot(before) < smallest_turn_cosine_ * size * before.norm()) return false;
      if (mesh_.is_border(r)) continue;
      const Vec3 outer = mesh_.area_vector(HalfedgeMesh::face(mesh_.opposite(r)));
      const double fold = now.dot(outer) / (size * outer.norm());
      if (fold < -0.2 && fold < before.dot(outer) / (before.norm() * outer.norm())) return false;
    }
    return true;
  }

  // Whether the faces that the contraction would leave meet no others, nor one another.
  bool stays_clear(Index h, const Vec3& place) {
    const Index kept = mesh_.origin(h), removed = mesh_.target(h);
    const Vec3 old_place = std::exchange(mesh_.points[kept], place);
    star_.clear();
    BoundingBox box{place, place};
    for (const Index r : rim_) {
      star_.push_back({kept, mesh_.origin(r), mesh_.target(r)});
      box.low = box.low.cwiseMin(mesh_.points[mesh_.origin(r)]).cwiseMin(mesh_.points[mesh_.target(r)]);
      box.high = box.high.cwiseMax(mesh_.points[mesh_.origin(r)]).cwiseMax(mesh_.points[mesh_.target(r)]);
    }
    bool clear = true;
    const auto test = [&](const Triangle& s, const Triangle& t) {
      if (clear && faces_intersect(mesh_.points, s, t)) clear = false;
    };
    for (std::size_t i = 0; i < star_.size(); ++i) {
      if (is_collinear(mesh_.points, star_[i])) clear = false;
      for (std::size_t j = 0; j < i; ++j) test(star_[i], star_[j]);
    }
    boxes_->for_each_overlap(box, [&](Index f) {
      const Triangle t = mesh_.triangle(f);
      const bool replaced = std::any_of(t.begin(), t.end(), [&](Index v) { return v == kept || v == removed; });
      for (std::size_t i = 0; i < star_.size() && clear && !replaced; ++i) test(star_[i], t);
    });
    mesh_.points[kept] = old_place;
    return clear;
  }

  HalfedgeMesh mesh_;
  const CollapseOptions& options_;
  CollapsePredictor predictor_;
  IndexedHeap heap_;
  double smallest_turn_cosine_;

  std::optional<TriangleTree> scan_;
  std::vector<Eigen::Vector3f> scan_normals_;
  std::vector<Index> scan_triangle_;  // per vertex: where it lies on the scan, the hint of the next query
  std::optional<FaceBoxes> boxes_;    // of the faces that are left; where they must not meet

  // Of the contraction at hand.
  std::vector<Index> rim_;
  std::vector<Vec3> link_;
  std::vector<Triangle> star_;
  mutable std::vector<SurfaceSample> samples_;
};

}  // namespace

std::string_view name_of(CollapseCost cost) {
  return name_in(cost_names, cost);
}

std::optional<CollapseCost> collapse_cost_named(std::string_view name) {
  return value_in(cost_names, name);
}

CollapseResult collapse(SurfaceMesh& mesh, const CollapseOptions& options, const Progress& progress) {
  check(options, mesh);
  if (mesh.triangles.size() <= options.target_faces)
    return {.faces_before = mesh.triangles.size(), .faces_after = mesh.triangles.size()};
  Simplifier simplifier(mesh, options);
  const CollapseResult result = simplifier.run(progress);
  mesh = simplifier.take();
  return result;
}

}  // namespace scan2fea
