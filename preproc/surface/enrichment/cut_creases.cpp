#include "preproc/surface/enrichment/cut_creases.hpp"

#include "preproc/surface/kernel/delaunay_flips.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <vector>

namespace scan2fea {
namespace {

using Index = HalfedgeMesh::Index;

// Of an edge: a crease nearer to its end goes through the end, so that no sliver is made.
constexpr double merged_share = 0.12;
// Of an edge: how far beside it the meeting of its primitives may lie. The chord of a right-angled corner is off by
// half of itself at most.
constexpr double farthest_share = 0.75;
// Cosines: a face may lean so far from its primitive's normal, or from what it was.
constexpr double least_on_primitive = 0.1, least_to_before = 0.2;

// Of the mean edge: nearer to its primitive a point is on it.
constexpr double all_but_none = 1e-7;

struct Meeting {
  Vec3 point = Vec3::Zero();
  Vec3 base = Vec3::Zero();  // on the edge
  LabelSet labels;
};

class Cutter {
 public:
  Cutter(HalfedgeMesh& mesh, SurfaceLabels& labels, ClearSurface& clear)
      : mesh_(mesh), labels_(labels), clear_(clear), edge_(mean_edge_length(mesh.to_surface())) {}

  CreaseCutResult run() {
    snap();
    turn_edges();
    merge_near_ends();
    // Splitting leaves edges between a crease and a third primitive, where a corner lies.
    for (int pass = 0; pass < 3; ++pass) {
      if (!split_mixed_edges()) break;
      turn_edges();
    }
    for (int pass = 0; pass < 3; ++pass) {
      if (!leave_holes()) break;
      turn_edges();
    }
    return result_;
  }

 private:
  void snap() {
    for (Index v = 0; v < mesh_.vertex_slots(); ++v) {
      if (!mesh_.is_alive(v) || labels_.of(v).size() != 1) continue;
      const Vec3 foot = labels_.shape(*labels_.of(v).begin()).foot(mesh_.points[v]);
      if ((foot - mesh_.points[v]).norm() < all_but_none * edge_) continue;
      result_.snapped += move_if_sound(v, foot);
    }
  }

  bool move_if_sound(Index v, const Vec3& place) {
    const Vec3 before = mesh_.points[v];
    std::vector<Vec3> normals;
    mesh_.for_each_outgoing(v,
                            [&](Index h) { normals.push_back(mesh_.area_vector(HalfedgeMesh::face(h)).normalized()); });
    mesh_.points[v] = place;
    bool sound = true;
    std::size_t i = 0;
    mesh_.for_each_outgoing(v, [&](Index h) {
      sound = sound && mesh_.area_vector(HalfedgeMesh::face(h)).normalized().dot(normals[i++]) > least_to_before;
    });
    mesh_.points[v] = before;
    return sound && clear_.move(v, place);
  }

  // Edges that run through the part or over a hole are turned, where the other diagonal lies nearer to the primitives.
  void turn_edges() {
    constexpr int most_passes = 5;
    for (int pass = 0; pass < most_passes; ++pass) {
      std::size_t turned = 0;
      for (Index h = 0; h < 3 * mesh_.face_slots(); ++h) {
        if (!mesh_.is_face_alive(HalfedgeMesh::face(h)) || mesh_.is_border(h) || h > mesh_.opposite(h)) continue;
        if (!is_better_turned(h) || !mesh_.can_flip(h) || !clear_.clear_to_flip(h)) continue;
        mesh_.flip(h);
        ++turned;
      }
      result_.turned += turned;
      if (turned == 0) break;
    }
  }

  bool is_better_turned(Index h) const {
    constexpr double least_gain = 0.1;
    const Index a = mesh_.origin(h), b = mesh_.target(h);
    const Index c = mesh_.origin(HalfedgeMesh::prev(h)), d = mesh_.origin(HalfedgeMesh::prev(mesh_.opposite(h)));
    for (const Index v : {a, b, c, d})
      if (labels_.of(v).size() == 0) return false;
    return misfit(d, c, a) + misfit(c, d, b) + least_gain < misfit(a, b, c) + misfit(b, a, d);
  }

  // How far the face is from the nearest of its corners' primitives: in its own plane, over its longest edge, and by
  // its normal. 0 on a primitive, about a half across a sharp edge.
  double misfit(Index a, Index b, Index c) const {
    const Vec3 &p = mesh_.points[a], &q = mesh_.points[b], &r = mesh_.points[c];
    const Vec3 middle = (p + q + r) / 3, area = (q - p).cross(r - p);
    const double longest = std::sqrt(std::max({(q - p).squaredNorm(), (r - q).squaredNorm(), (p - r).squaredNorm()}));
    const Vec3 normal = area.norm() > 1e-3 * longest * longest ? Vec3(area.normalized()) : Vec3(Vec3::Zero());
    double least = 4;
    for (const Index v : {a, b, c})
      for (const std::uint32_t label : labels_.of(v)) {
        const Shape& shape = labels_.shape(label);
        least =
            std::min(least, std::abs(shape.signed_distance(middle)) / longest + 1 - shape.normal(middle).dot(normal));
      }
    return least;
  }

  bool is_mixed(Index h) const {
    const LabelSet& a = labels_.of(mesh_.origin(h));
    const LabelSet& b = labels_.of(mesh_.target(h));
    if (a.size() == 0 || b.size() == 0) return false;
    return std::none_of(a.begin(), a.end(), [&](std::uint32_t label) { return b.holds(label); });
  }

  // Where two primitives, or the three of a crease and a face, meet near an edge. For a crease both ends must lie on
  // the same side of the other's primitive: inside at an outer edge, outside at an inner one.
  std::optional<Meeting> meeting_on(Index h) const {
    const Index u = mesh_.origin(h), v = mesh_.target(h);
    const LabelSet& a = labels_.of(u);
    const LabelSet& b = labels_.of(v);
    const Vec3 &p = mesh_.points[u], &q = mesh_.points[v];
    const double length = (q - p).norm();
    if (a.size() + b.size() == 3 && !has_rounding(a, b)) {
      Meeting corner{.point = 0.5 * (p + q), .base = 0.5 * (p + q), .labels = a};
      for (const std::uint32_t label : b) corner.labels.add(label);
      if (const auto at = labels_.meeting(corner.labels, corner.point); at && (*at - corner.point).norm() < length) {
        corner.point = *at;
        return corner;
      }
    }
    std::optional<Meeting> best;
    double nearest = farthest_share * length;
    for (const std::uint32_t la : a)
      for (const std::uint32_t lb : b) {
        if (const std::uint32_t between = labels_.rounding_between(la, lb); between != no_primitive) {
          // The scan has missed a piece of it.
          const Vec3 middle = 0.5 * (p + q), foot = labels_.shape(between).foot(middle);
          if (!((foot - middle).norm() < nearest)) continue;
          nearest = (foot - middle).norm();
          best = Meeting{foot, middle, LabelSet(between)};
          continue;
        }
        const double of_p = labels_.shape(lb).signed_distance(p), of_q = labels_.shape(la).signed_distance(q);
        if (!(of_p * of_q > 0)) continue;
        const double t = std::clamp(std::abs(of_p) / (std::abs(of_p) + std::abs(of_q)), 0.1, 0.9);
        const Vec3 start = (1 - t) * p + t * q;
        LabelSet both(la);
        both.add(lb);
        const auto at = labels_.meeting(both, start);
        if (!at || !((*at - start).norm() < nearest)) continue;
        nearest = (*at - start).norm();
        best = Meeting{*at, start, both};
      }
    return best;
  }

  bool has_rounding(const LabelSet& a, const LabelSet& b) const {
    for (const std::uint32_t la : a)
      for (const std::uint32_t lb : b)
        if (labels_.rounding_between(la, lb) != no_primitive) return true;
    return false;
  }

  // Vertices that are all but on a crease become its own, those of creases that are all but at a corner as well:
  // whatever side of it the noise has put them on.
  void merge_near_ends() {
    for (Index v = 0; v < mesh_.vertex_slots(); ++v) {
      if (!mesh_.is_alive(v)) continue;
      while (labels_.of(v).size() == 1 || labels_.of(v).size() == 2)
        if (!join_nearest(v)) break;
    }
  }

  bool join_nearest(Index v) {
    std::optional<Meeting> nearest;
    double least = merged_share;
    mesh_.for_each_neighbour(v, [&](Index w) {
      const double length = (mesh_.points[w] - mesh_.points[v]).norm();
      for (const std::uint32_t label : labels_.of(w)) {
        if (labels_.of(v).holds(label)) continue;
        const double off = std::abs(labels_.shape(label).signed_distance(mesh_.points[v]));
        if (!(off < least * length)) continue;
        Meeting meeting{.labels = labels_.of(v)};
        meeting.labels.add(label);
        const auto at = labels_.meeting(meeting.labels, mesh_.points[v]);
        if (!at || !((*at - mesh_.points[v]).norm() < least * length)) continue;
        meeting.point = *at;
        least = (*at - mesh_.points[v]).norm() / length;
        nearest = meeting;
      }
    });
    if (!nearest || !move_if_sound(v, nearest->point)) return false;
    labels_.set(v, nearest->labels);
    ++result_.moved;
    return true;
  }

  bool split_mixed_edges() {
    std::vector<std::array<Index, 2>> mixed;
    for (Index h = 0; h < 3 * mesh_.face_slots(); ++h)
      if (mesh_.is_face_alive(HalfedgeMesh::face(h)) && !mesh_.is_border(h) && h < mesh_.opposite(h) && is_mixed(h))
        mixed.push_back({mesh_.origin(h), mesh_.target(h)});
    const std::size_t before = result_.bases.size();
    for (const auto& [a, b] : mixed) {
      const Index h = mesh_.find_halfedge(a, b);
      if (h == HalfedgeMesh::none || mesh_.is_border(h)) continue;
      if (const auto meeting = meeting_on(h); meeting && stays_sound(h, *meeting)) split(h, *meeting);
    }
    return result_.bases.size() > before;
  }

  struct Hole {
    std::uint32_t label;
    double low, high;  // along the axis, about the origin
  };

  std::vector<Hole> holes() const {
    constexpr double infinity = std::numeric_limits<double>::infinity();
    std::vector<Hole> all;
    for (std::uint32_t label = 0; label < labels_.primitives().size(); ++label)
      if (labels_.primitives()[label].use == PrimitiveUse::hole) all.push_back({label, infinity, -infinity});
    for (Index v = 0; v < mesh_.vertex_slots(); ++v)
      for (Hole& hole : all) {
        if (!mesh_.is_alive(v) || !labels_.of(v).holds(hole.label)) continue;
        const Shape& shape = labels_.shape(hole.label);
        const double along = (mesh_.points[v] - shape.origin).dot(shape.axis);
        hole.low = std::min(hole.low, along - edge_);
        hole.high = std::max(hole.high, along + edge_);
      }
    return all;
  }

  // Where the wall of a hole was hardly seen, edges beside it cut through its inside. They are split, and the new
  // vertex goes out to the rim or the wall.
  bool leave_holes() {
    const std::vector<Hole> all = holes();
    std::vector<std::array<Index, 2>> inside;
    for (Index h = 0; h < 3 * mesh_.face_slots(); ++h)
      if (mesh_.is_face_alive(HalfedgeMesh::face(h)) && !mesh_.is_border(h) && h < mesh_.opposite(h) && !all.empty() &&
          out_of_hole(h, all))
        inside.push_back({mesh_.origin(h), mesh_.target(h)});
    const std::size_t before = result_.bases.size();
    for (const auto& [a, b] : inside) {
      const Index h = mesh_.find_halfedge(a, b);
      if (h == HalfedgeMesh::none || mesh_.is_border(h)) continue;
      if (const auto meeting = out_of_hole(h, all); meeting && stays_sound(h, *meeting)) split(h, *meeting);
    }
    return result_.bases.size() > before;
  }

  std::optional<Meeting> out_of_hole(Index h, const std::vector<Hole>& all) const {
    constexpr double least_depth = 0.1;  // of the edge: a chord that spans a seventh of the circle
    const LabelSet& a = labels_.of(mesh_.origin(h));
    const LabelSet& b = labels_.of(mesh_.target(h));
    const Vec3 &p = mesh_.points[mesh_.origin(h)], &q = mesh_.points[mesh_.target(h)], middle = 0.5 * (p + q);
    for (const Hole& hole : all) {
      const Shape& shape = labels_.shape(hole.label);
      const double along = (middle - shape.origin).dot(shape.axis);
      if (along < hole.low || along > hole.high) continue;
      if (!(shape.signed_distance(middle) > least_depth * (q - p).norm())) continue;
      const std::optional<Vec3> wall = behind(h, shape, middle);
      if (!wall) continue;
      Meeting meeting{.base = middle, .labels = LabelSet(hole.label)};
      for (const std::uint32_t label : a)
        if (b.holds(label)) meeting.labels.add(label);
      if (const auto at = labels_.meeting(meeting.labels, *wall)) {
        meeting.point = *at;
        return meeting;
      }
    }
    return {};
  }

  // The wall of a hole on the edge's inner side; nothing where the faces beside it look along the hole.
  std::optional<Vec3> behind(Index h, const Shape& hole, const Vec3& middle) const {
    constexpr double least_across = 0.3;
    const Vec3 out = mesh_.area_vector(HalfedgeMesh::face(h)).normalized() +
                     mesh_.area_vector(HalfedgeMesh::face(mesh_.opposite(h))).normalized();
    Vec3 inwards = out.dot(hole.axis) * hole.axis - out;
    if (!(inwards.norm() > least_across * out.norm())) return {};
    inwards.normalize();
    const Vec3 from_origin = middle - hole.origin;
    const Vec3 from_axis = from_origin - from_origin.dot(hole.axis) * hole.axis;
    const double half = from_axis.dot(inwards);
    const double square = half * half + hole.radius * hole.radius - from_axis.squaredNorm();
    return square > 0 ? middle + (std::sqrt(square) - half) * inwards : std::optional<Vec3>();
  }

  // The four faces that a split makes.
  bool stays_sound(Index h, const Meeting& meeting) const {
    // Ends that could not be moved onto the crease are not given needles instead.
    constexpr double least_share = 0.03;
    const Vec3 &p = mesh_.points[mesh_.origin(h)], &q = mesh_.points[mesh_.target(h)];
    if (std::min((meeting.point - p).norm(), (meeting.point - q).norm()) < least_share * (q - p).norm()) return false;
    for (const Index side : {h, mesh_.opposite(h)}) {
      const Index a = mesh_.origin(side), b = mesh_.target(side), c = mesh_.origin(HalfedgeMesh::prev(side));
      const Vec3 before = mesh_.area_vector(HalfedgeMesh::face(side)).normalized();
      if (!is_sound(a, c, meeting, before, true) || !is_sound(b, c, meeting, before, false)) return false;
    }
    return true;
  }

  bool is_sound(Index end, Index apex, const Meeting& meeting, const Vec3& before, bool end_first) const {
    const Vec3 &p = mesh_.points[end], &q = mesh_.points[apex];
    Vec3 area = (q - p).cross(meeting.point - p);
    if (end_first) area = -area;
    const Vec3 normal = area.normalized();
    for (const std::uint32_t label : labels_.of(end))
      if (labels_.of(apex).holds(label) && meeting.labels.holds(label))
        return labels_.shape(label).normal((p + q + meeting.point) / 3).dot(normal) > least_on_primitive;
    return normal.dot(before) > least_to_before;
  }

  void split(Index h, const Meeting& meeting) {
    result_.bases.push_back(meeting.base);
    const Index v = mesh_.split_edge(h, meeting.base);
    clear_.vertex_added(v);
    const bool there = clear_.move(v, meeting.point);
    labels_.add(there ? meeting.labels : LabelSet());
    DelaunayFlipLimits limits;
    limits.may_flip = [&](Index edge) {
      return labels_.may_flip(edge) && labels_.of_face(HalfedgeMesh::face(edge)) != no_primitive &&
             clear_.clear_to_flip(edge);
    };
    restore_delaunay(mesh_, v, limits);
  }

  HalfedgeMesh& mesh_;
  SurfaceLabels& labels_;
  ClearSurface& clear_;
  double edge_;  // mean, at the start
  CreaseCutResult result_;
};

}  // namespace

CreaseCutResult cut_creases(HalfedgeMesh& mesh, SurfaceLabels& labels, ClearSurface& clear) {
  return Cutter(mesh, labels, clear).run();
}

}  // namespace scan2fea
