#include "preproc/surface/enrichment/insertion.hpp"

#include "preproc/mesh/numbers.hpp"
#include "preproc/surface/enrichment/importance.hpp"
#include "preproc/surface/enrichment/side_normals.hpp"
#include "preproc/surface/enrichment/surface_walk.hpp"
#include "preproc/surface/kernel/delaunay_flips.hpp"
#include "preproc/surface/placement/place_vertex.hpp"
#include "quality/triangle_measures.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace scan2fea {
namespace {

using Index = HalfedgeMesh::Index;

// A vertex asks at most this often: sectors of 90 degrees are filled by four. Where more are asked for, the surface is
// so bent that points put into a sector are not seen in it.
constexpr std::uint8_t most_requests = 6;

// Measured points whose side turns more than 60 degrees from the new point's tangent plane tell nothing of its height.
constexpr double smallest_sample_cosine = 0.5;

double area_of(const HalfedgeMesh& mesh) {
  double area = 0;
  for (Index f = 0; f < mesh.face_slots(); ++f)
    if (mesh.is_face_alive(f)) area += 0.5 * mesh.area_vector(f).norm();
  return area;
}

class Inserter {
 public:
  Inserter(HalfedgeMesh& mesh, SurfaceLabels& labels, ClearSurface& clear, Index original, const EnrichOptions& options)
      : mesh_(mesh),
        labels_(labels),
        clear_(clear),
        options_(options),
        nearest_(mesh_),
        normals_(mesh_, labels.primitives().empty() ? CornerWeight::angle : CornerWeight::area),
        importance_(mesh_, normals_),
        original_(original) {
    done_.first = static_cast<Index>(mesh_.vertex_slots());
    mark_domain();
    const double area = area_of(mesh_);
    radius_ = options.sampling_radius ? *options.sampling_radius : default_radius(area);
    requests_.assign(mesh_.vertex_slots(), 0);
    mark_creases();
    if (radius_ > 0) {
      const double packed =
          2 * equilateral_area * options.separation * options.separation * radius_ * radius_;  // of each point
      const double bound = std::min(2 * area / packed + 100, 1e9);
      most_new_vertices_ = std::min(options.most_new_vertices, static_cast<std::size_t>(bound));
    }
    flip_limits_.may_flip = [this](Index h) { return labels_.may_flip(h) && clear_.clear_to_flip(h); };
  }

  Insertion run(const Progress& progress) {
    EnrichResult& result = done_.result;
    result.sampling_radius = radius_;
    const ImportanceOptions condition{radius_, options_.most_neighbours, options_.empty_sector_deg};
    std::vector<Index> waiting = domain_;
    bool inserted = options_.sampling_radius.has_value() || is_wanting(condition);
    while (inserted && !waiting.empty() && radius_ > 0) {
      progress("enrich", 0.8 - 0.8 * static_cast<double>(waiting.size()) / static_cast<double>(domain_.size()));
      ++result.rounds;
      inserted = false;
      const std::size_t known = domain_.size();
      std::vector<Index> not_content;
      for (const Index v : waiting) {
        const std::vector<Vec3> gaps = importance_.empty_sectors(v, condition);
        if (gaps.empty()) continue;
        not_content.push_back(v);
        if (result.added >= most_new_vertices_ || requests_[v] == most_requests) continue;
        if (!fill_one_of(v, gaps)) continue;
        ++requests_[v];
        inserted = true;
      }
      waiting = std::move(not_content);
      waiting.insert(waiting.end(), domain_.begin() + static_cast<std::ptrdiff_t>(known), domain_.end());
    }
    result.domain_vertices = domain_.size();
    for (const Index v : domain_) result.content += importance_.empty_sectors(v, condition).empty();
    if (result.content < result.domain_vertices)
      result.stop = result.added < options_.most_new_vertices ? EnrichStop::no_room : EnrichStop::too_many_vertices;
    return std::move(done_);
  }

 private:
  // A vertex that a crease was cut at belongs to the domain if a measured one beside it does.
  void mark_domain() {
    in_domain_.assign(mesh_.vertex_slots(), !options_.domain.has_value());
    if (options_.domain) {
      for (Index v = 0; v < original_; ++v) in_domain_[v] = (*options_.domain)[v];
      for (Index v = original_; v < mesh_.vertex_slots(); ++v)
        if (mesh_.is_alive(v))
          mesh_.for_each_neighbour(v, [&](Index w) {
            if (w < original_ && in_domain_[w]) in_domain_[v] = true;
          });
    }
    for (Index v = 0; v < mesh_.vertex_slots(); ++v)
      if (mesh_.is_alive(v) && in_domain_[v]) domain_.push_back(v);
  }

  // Where half of the points crowd in a small part of the surface the median tells about that part alone; as many
  // points spread evenly, in equilateral triangles, would have the other spacing.
  double default_radius(double area) {
    constexpr double spacing_share = 0.75, least_of_diagonal = 0.01;
    std::vector<Index> measured;
    for (const Index v : domain_)
      if (v < original_) measured.push_back(v);
    const auto points = static_cast<double>(std::max<std::size_t>(1, original_));
    return std::max(spacing_share * std::max(importance_.median_spacing(measured), equilateral_edge(area, 2 * points)),
                    least_of_diagonal * bounding_box(mesh_.points).diagonal());
  }

  // Of a scan that is dense enough a few places look empty: flat lids of holes that were closed, for one. They stay as
  // they are where nobody has asked for a spacing.
  bool is_wanting(const ImportanceOptions& condition) {
    constexpr std::size_t fewest = 50;  // one in so many
    std::size_t wanting = 0;
    for (const Index v : domain_) wanting += !importance_.empty_sectors(v, condition).empty();
    return fewest * wanting > domain_.size();
  }

  void mark_creases() {
    done_.on_crease.assign(mesh_.vertex_slots(), false);
    for (Index h = 0; h < 3 * mesh_.face_slots(); ++h) {
      if (!mesh_.is_face_alive(HalfedgeMesh::face(h)) || mesh_.is_border(h)) continue;
      if (!labels_.is_crease(h) && !normals_.is_crease(mesh_, h)) continue;
      done_.on_crease[mesh_.origin(h)] = done_.on_crease[mesh_.target(h)] = true;
    }
  }

  bool fill_one_of(Index v, const std::vector<Vec3>& bisectors) {
    for (const Vec3& direction : bisectors) {
      const auto base = walk_straight(mesh_, v, normals_.mean(v), direction, options_.placement_distance * radius_);
      if (base && insert(*base)) return true;
    }
    return false;
  }

  // Refused where another point is too near, or where a border edge would have to be split.
  bool insert(SurfacePoint base) {
    // Close to an edge the point goes onto it, so that no face of almost no height is made. On a thinned Horse, at 0.01
    // the smallest angle falls from 3.5 to 0.2 degrees; at 0.2 the mean edge ratio rises from 1.444 to 1.465.
    Eigen::Index corner;
    const bool on_edge = base.weights.minCoeff(&corner) < 0.1;
    const Index edge = 3 * base.face + static_cast<Index>(corner + 1) % 3;
    if (on_edge) {
      if (mesh_.is_border(edge)) return false;
      base.weights[corner] = 0;
      base.weights /= base.weights.sum();
    }
    const Triangle t = mesh_.triangle(base.face);
    const Vec3 point = position(mesh_, base);
    const Vec3 normal = normal_at(base);
    if (!std::ranges::all_of(t, [&](Index w) { return in_domain_[w]; }) ||
        !has_room(t, point, normal, HalfedgeMesh::none))
      return false;

    const bool on_crease = on_edge && (labels_.is_crease(edge) || normals_.is_crease(mesh_, edge));
    const LabelSet labels =
        on_edge && labels_.is_crease(edge) ? crease_labels(edge, point) : LabelSet(label_at(base, normal));
    // Between points that lie on primitives and a place that lies on none the triangulation is wrong: it spans a gap,
    // or the mouth of a hole. Nothing tells the height there.
    const bool spans_gap = labels.size() == 0 && std::all_of(t.begin(), t.end(), [&](Index w) { return is_known(w); });
    if (on_crease)
      normals_.add(normal, normal_at(across(edge, base)));
    else
      normals_.add(normal);
    const Index v = on_edge ? mesh_.split_edge(edge, point) : mesh_.split_face(base.face, point);
    clear_.vertex_added(v);
    labels_.add(labels);
    done_.bases.push_back(point);
    done_.on_crease.push_back(on_crease);
    requests_.push_back(0);
    domain_.push_back(v);
    in_domain_.push_back(true);
    ++done_.result.added;
    const double farthest = farthest_move(t);
    restore_delaunay(mesh_, v, flip_limits_);
    done_.in_gap.push_back(spans_gap);
    if (spans_gap)
      ++done_.result.not_lifted;
    else
      place(v, t, on_crease, farthest);
    return true;
  }

  bool is_known(Index v) const {
    return labels_.of(v).size() > 0 || (v >= done_.first && done_.in_gap[v - done_.first]);
  }

  // Of a point of a crease; where a side runs over from one primitive into another, of the one that is nearer.
  LabelSet crease_labels(Index edge, const Vec3& point) const {
    LabelSet labels(labels_.of_face(HalfedgeMesh::face(edge)));
    labels.add(labels_.of_face(HalfedgeMesh::face(mesh_.opposite(edge))));
    if (labels.size() == 2) return labels;
    std::uint32_t nearest = no_primitive;
    double least = infinity;
    for (const Index end : {mesh_.origin(edge), mesh_.target(edge)})
      for (const std::uint32_t label : labels_.of(end))
        if (const double off = std::abs(labels_.shape(label).signed_distance(point));
            !labels.holds(label) && off < least) {
          least = off;
          nearest = label;
        }
    labels.add(nearest);
    return labels;
  }

  // The face's primitive; where its corners lie on several and no crease parts them, the one whose normal is nearest to
  // that between the corners': beside a rounding this finds the line where it begins. None where the face runs across
  // the primitive, as over the mouth of a hole.
  std::uint32_t label_at(const SurfacePoint& base, const Vec3& normal) const {
    constexpr double least_agreement = 0.5;  // cosine of 60 degrees
    const Triangle t = mesh_.triangle(base.face);
    const Vec3 point = position(mesh_, base), face_normal = mesh_.area_vector(base.face).normalized();
    std::uint32_t best = labels_.of_face(base.face);
    if (best == no_primitive) {
      if (labels_.of(t[0]).size() == 0 || labels_.of(t[1]).size() == 0 || labels_.of(t[2]).size() == 0) return best;
      double most = least_agreement;
      for (const std::uint32_t label : labels_around(t)) {
        const double agreement = labels_.shape(label).normal(point).dot(normal);
        if (!(agreement > most)) continue;
        most = agreement;
        best = label;
      }
    }
    if (best == no_primitive) return best;
    const Shape& shape = labels_.shape(best);
    const bool near = std::abs(shape.signed_distance(point)) < farthest_move(t);
    return near && shape.normal(point).dot(face_normal) > least_agreement ? best : no_primitive;
  }

  // Over a rounding of a right angle the chord is off by a fifth of its length.
  double farthest_move(const Triangle& t) const {
    constexpr double share = 0.35;
    double longest = radius_;
    for (std::size_t i = 0; i < 3; ++i)
      longest = std::max(longest, (mesh_.points[t[i]] - mesh_.points[t[(i + 1) % 3]]).norm());
    return share * longest;
  }

  // The primitives of the corners, and the roundings between them.
  std::vector<std::uint32_t> labels_around(const Triangle& t) const {
    std::vector<std::uint32_t> all;
    for (const Index v : t) all.insert(all.end(), labels_.of(v).begin(), labels_.of(v).end());
    const std::size_t corners = all.size();
    for (std::size_t i = 0; i < corners; ++i)
      for (std::size_t j = i + 1; j < corners; ++j)
        if (const std::uint32_t between = labels_.rounding_between(all[i], all[j]); between != no_primitive)
          all.push_back(between);
    return all;
  }

  void place(Index v, const Triangle& seeds, bool on_crease, double farthest) {
    if (labels_.of(v).size() > 0) {
      const auto onto = labels_.meeting(labels_.of(v), mesh_.points[v]);
      if (onto && (*onto - mesh_.points[v]).norm() < farthest && !turns_over(v, *onto) &&
          clear_.move_without_fold(v, *onto)) {
        ++done_.result.on_primitives;
        return;
      }
      labels_.set(v, LabelSet());
      done_.in_gap.back() = true;
      ++done_.result.not_lifted;
      return;
    }
    if (on_crease) {
      // The two sides tell two heights, and neither is the crease's.
      ++done_.result.not_lifted;
      return;
    }
    if (options_.place_by) clear_.move_without_fold(v, placed_by_entropy(v));
    lift(v, seeds, mesh_.points[v]);
  }

  bool turns_over(Index v, const Vec3& place) const {
    constexpr double least_cosine = 0.1;
    const Vec3 before = mesh_.points[v];
    bool turned = false;
    mesh_.for_each_outgoing(v, [&](Index h) {
      const Vec3 &a = mesh_.points[mesh_.target(h)], &b = mesh_.points[mesh_.origin(HalfedgeMesh::prev(h))];
      const Vec3 was = (a - before).cross(b - before), is = (a - place).cross(b - place);
      turned = turned || !(was.dot(is) > least_cosine * was.norm() * is.norm());
    });
    return turned;
  }

  // The same point of an edge, seen from the face beyond it.
  SurfacePoint across(Index edge, const SurfacePoint& base) const {
    const Index o = mesh_.opposite(edge);
    SurfacePoint other{HalfedgeMesh::face(o), Vec3::Zero()};
    other.weights[o % 3] = base.weights[HalfedgeMesh::next(edge) % 3];
    other.weights[HalfedgeMesh::next(o) % 3] = base.weights[edge % 3];
    return other;
  }

  Vec3 normal_at(const SurfacePoint& base) const {
    const Triangle t = mesh_.triangle(base.face);
    const Vec3 face = mesh_.area_vector(base.face).normalized();
    Vec3 mean = Vec3::Zero();
    for (std::size_t i = 0; i < 3; ++i)
      mean += base.weights[static_cast<int>(i)] * labels_.normal(t[i], face, normals_.facing(t[i], face));
    mean.normalize();
    // More than 72 degrees off, the mean of the corners' normals gives no tangent plane of this face. It seldom is:
    // with no such test a thinned Horse comes out the same.
    return mean.dot(face) > 0.3 ? mean : face;
  }

  bool has_room(const Triangle& seeds, const Vec3& point, const Vec3& normal, Index except) {
    bool room = true;
    nearest_.search(
        seeds, point, options_.separation * radius_,
        [&](Index w) { return w != except && normals_.mean(w).dot(normal) > smallest_neighbour_cosine; },
        [&](Index, double) { return room = false; });
    return room;
  }

  Vec3 placed_by_entropy(Index v) {
    std::vector<Vec3> link;
    mesh_.for_each_neighbour(v, [&](Index w) { link.push_back(mesh_.points[w]); });
    const PlaceVertexResult placed =
        place_vertex({mesh_.points[v], link}, star_normal(link), {.objective = *options_.place_by});
    const Triangle t = mesh_.triangle(HalfedgeMesh::face(mesh_.outgoing(v)));
    return placed.feasible && has_room(t, placed.position, normals_.mean(v), v) ? placed.position : mesh_.points[v];
  }

  // To the height that the measured points around tell, unless it is not credible or would fold the star.
  void lift(Index v, const Triangle& seeds, const Vec3& base) {
    // Ten samples give thirty equations for six unknowns, or ten without normals. They must lie on all sides, since at
    // the rim of a gap the nearest points all lie on one side of it; sixty bound the cost.
    // Where a thousand points were met, nearly all of them new, the measured ones are too far to tell.
    constexpr std::size_t wanted_samples = 10, most_samples = 60, most_visits = 1000;
    const Vec3 normal = normals_.mean(v);
    FilledSectors sectors(base, normal);
    samples_.clear();
    double farthest = 0, closest = infinity;
    std::size_t visits = 0;
    nearest_.search(
        seeds, base, infinity, [&](Index w) { return normals_.facing(w, normal).dot(normal) > smallest_sample_cosine; },
        [&](Index w, double distance) {
          if (++visits > most_visits) return false;
          if (w >= original_) return true;
          samples_.push_back({mesh_.points[w], normals_.facing(w, normal)});
          sectors.add(mesh_.points[w]);
          farthest = std::sqrt(distance);
          closest = std::min(closest, farthest);
          return samples_.size() < most_samples && (samples_.size() < wanted_samples || !sectors.surrounded());
        });
    // Wendland's weight is 0 at the radius, where the farthest sample would not count; with twice the radius the far
    // ones count so much that the RMS distance of a thinned Horse grows by 3 %.
    const Lifting lifting = options_.lifting == Lifting::triharmonic ? Lifting::hermite : options_.lifting;
    const double height = lifted_height(lifting, samples_, base, normal, 1.2 * farthest);
    // A height of 0.8 of the way to the nearest sample is a slope of 39 degrees: beyond, it is not credible. On thinned
    // scans of the Horse and of fandisk, 0.3 changes the RMS distance by -2 and +1 %, 3 by less than 1 %.
    const Vec3 place = base + height * normal;
    if (!(std::abs(height) <= 0.8 * closest) || folds(v, place) || !has_room(seeds, place, normal, v) ||
        !clear_.move_without_fold(v, place)) {
      // It stays on the triangulation.
      ++done_.result.not_lifted;
    }
  }

  bool folds(Index v, const Vec3& place) const {
    std::vector<Vec3> link;
    mesh_.for_each_neighbour(v, [&](Index w) { link.push_back(mesh_.points[w]); });
    return !is_star_feasible({place, link}, star_normal(link), PlaceVertexOptions{}.smallest_normal_cosine);
  }

  HalfedgeMesh& mesh_;
  SurfaceLabels& labels_;
  ClearSurface& clear_;
  const EnrichOptions& options_;
  NearestOnSurface nearest_;
  SideNormals normals_;  // of the scan at its vertices; of a new one, interpolated where it was put
  Importance importance_;
  Index original_;
  double radius_ = 0;
  std::size_t most_new_vertices_ = 0;  // the option, or twice what packing leaves room for
  DelaunayFlipLimits flip_limits_;
  std::vector<std::uint8_t> requests_;
  std::vector<bool> in_domain_;  // per vertex
  std::vector<Index> domain_;    // the same as a list
  std::vector<SurfaceSample> samples_;
  Insertion done_;
};

}  // namespace

Insertion insert_points(HalfedgeMesh& mesh, SurfaceLabels& labels, ClearSurface& clear, Index original,
                        const EnrichOptions& options, const Progress& progress) {
  return Inserter(mesh, labels, clear, original, options).run(progress);
}

}  // namespace scan2fea
