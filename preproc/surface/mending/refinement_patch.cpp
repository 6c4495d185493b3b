#include "preproc/surface/mending/refinement_patch.hpp"

#include "preproc/surface/kernel/delaunay_flips.hpp"
#include "preproc/surface/kernel/halfedge_mesh.hpp"
#include "quality/triangle_measures.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <span>
#include <utility>

namespace scan2fea {
namespace {

using Index = HalfedgeMesh::Index;

// A place whose patch is not within the limit after so many gets another, with more rings (see local_refinement.cpp).
constexpr int most_steps = 6;
// What a step must bring the merit down to. The merit is a fourth power of distances: 0.88 is 3 % less of them.
constexpr double least_gain = 0.88;
// A face a quarter of the limit beyond it: so far off a fit may leave what can be pulled.
constexpr double promising = 0.25 * 0.25 * 0.25 * 0.25;
// Where trials halve the merit, no dearer ones are made in that step.
constexpr double good_gain = 0.5;

// The faces around a set of vertices that grows.
class Stars {
 public:
  Stars(const VertexStars& stars, std::span<const std::uint32_t> vertices)
      : stars_(stars), vertices_(vertices.begin(), vertices.end()) {
    close();
  }

  const std::vector<std::uint32_t>& faces() const { return faces_; }  // ascending

  void add(std::uint32_t v) {
    if (std::find(vertices_.begin(), vertices_.end(), v) == vertices_.end()) vertices_.push_back(v);
  }

  // Adds the stars of the vertices that have come since; false where none have.
  bool close() {
    if (closed_ == vertices_.size()) return false;
    for (; closed_ < vertices_.size(); ++closed_)
      for (const std::uint32_t corner : stars_.corners(vertices_[closed_])) faces_.push_back(corner / 3);
    std::sort(faces_.begin(), faces_.end());
    faces_.erase(std::unique(faces_.begin(), faces_.end()), faces_.end());
    return true;
  }

 private:
  const VertexStars& stars_;
  std::vector<std::uint32_t> vertices_;
  std::size_t closed_ = 0;  // so many of them have their stars in faces_
  std::vector<std::uint32_t> faces_;
};

// Per vertex, how many edges of one face only end in it.
std::vector<int> rim_edges_of_vertices(const SurfaceMesh& mesh) {
  const VertexStars stars(mesh);
  const std::vector<Triangle> neighbours = face_neighbours(mesh, stars);
  std::vector<int> rim_edges(mesh.vertices.size(), 0);
  for (std::size_t f = 0; f < neighbours.size(); ++f)
    for (std::size_t k = 0; k < 3; ++k)
      if (neighbours[f][k] == no_face)
        for (const std::size_t other : {(k + 1) % 3, (k + 2) % 3}) ++rim_edges[mesh.triangles[f][other]];
  return rim_edges;
}

// Of `lines`, sorted by edge, those that are edges of the patch, by the patch's vertices. `vertices`: see part_of.
std::vector<LineEdge> lines_within(const SurfaceMesh& patch, const std::vector<std::uint32_t>& vertices,
                                   const std::vector<LineEdge>& lines) {
  std::vector<LineEdge> within;
  for (const Triangle& t : patch.triangles)
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t a = t[k], b = t[(k + 1) % 3];
      const FeatureEdge edge = feature_edge(vertices[a], vertices[b]);
      const auto at = std::lower_bound(lines.begin(), lines.end(), edge,
                                       [](const LineEdge& e, const FeatureEdge& wanted) { return e.edge() < wanted; });
      if (at == lines.end() || at->edge() != edge) continue;
      LineEdge own = *at;
      own.from = at->from == vertices[a] ? a : b;
      own.to = own.from == a ? b : a;
      if (std::none_of(within.begin(), within.end(), [&](const LineEdge& e) { return e.edge() == own.edge(); }))
        within.push_back(own);
    }
  return within;
}

// Edges inside of the patch: of a face, and the three longest others of the faces across them, the longest first.
using EdgesAround = std::array<std::vector<Index>, 2>;

EdgesAround edges_around(const HalfedgeMesh& mesh, Index face) {
  EdgesAround edges;
  const auto add = [&](Index h, std::vector<Index>& group) {
    if (mesh.is_border(h)) return;
    const Index edge = std::min(h, mesh.opposite(h));
    if (std::find(group.begin(), group.end(), edge) == group.end()) group.push_back(edge);
  };
  for (Index h = 3 * face; h < 3 * face + 3; ++h) {
    add(h, edges[0]);
    if (mesh.is_border(h)) continue;
    add(HalfedgeMesh::next(mesh.opposite(h)), edges[1]);
    add(HalfedgeMesh::prev(mesh.opposite(h)), edges[1]);
  }
  const auto squared_length = [&](Index h) {
    return (mesh.points[mesh.target(h)] - mesh.points[mesh.origin(h)]).squaredNorm();
  };
  for (std::vector<Index>& group : edges)
    std::stable_sort(group.begin(), group.end(),
                     [&](Index a, Index b) { return squared_length(a) > squared_length(b); });
  edges[1].resize(std::min<std::size_t>(3, edges[1].size()));
  return edges;
}

bool is_line_edge(const HalfedgeMesh& mesh, Index h, const Trial& trial) {
  const FeatureEdge edge = feature_edge(mesh.origin(h), mesh.target(h));
  return std::any_of(trial.lines.begin(), trial.lines.end(), [&](const LineEdge& e) { return e.edge() == edge; });
}

// New vertices in the middle of edges; where one is on a line, in the middle of the line's piece.
Trial with_split_edges(const HalfedgeMesh& mesh, std::span<const Index> edges, const Trial& now,
                       const FeatureNet& net) {
  Trial trial{.lines = now.lines};
  HalfedgeMesh changed = mesh;
  std::vector<std::uint32_t> inserted;
  for (const Index h : edges) {
    const FeatureEdge edge = feature_edge(changed.origin(h), changed.target(h));
    Vec3 middle = 0.5 * (changed.points[edge[0]] + changed.points[edge[1]]);
    const auto v = static_cast<std::uint32_t>(changed.vertex_slots());
    const auto on_line =
        std::find_if(trial.lines.begin(), trial.lines.end(), [&](const LineEdge& e) { return e.edge() == edge; });
    if (on_line != trial.lines.end()) {
      LineEdge second = *on_line;
      const double place = middle_place(net.lines[second.line], second.from_place, second.to_place);
      on_line->to = second.from = v;
      on_line->to_place = second.from_place = place;
      middle = net.lines[second.line].point_at(place);
      trial.lines.push_back(second);
    }
    inserted.push_back(changed.split_edge(h, middle));
  }
  const std::vector<FeatureEdge> kept = trial.edges_on_lines();
  for (const std::uint32_t v : inserted) restore_delaunay(changed, v, {.crease_deg = 90, .kept = kept});
  trial.patch = changed.to_surface();
  return trial;
}

// Edges within the place split until they are `factor` times as long as they were, and those around it so that lengths
// change gradually; at most `room` vertices more, and as many as the patch has faces: where it has edges of many
// lengths, no end would be near.
Trial with_shorter_edges(Trial now, const PatchOutline& outline, const FeatureNet& net, const ShorterEdges& place,
                         std::size_t room) {
  // Halves of a longer edge are nearer to the wanted length than it is.
  constexpr double too_long = 1.33;
  constexpr double gradation = 0.5;  // of lengths, over the distance
  const auto distance = [&](const Vec3& p) {
    return std::max(0.0, (p - place.where.centre).norm() - place.where.radius);
  };
  const double wanted = place.factor * outline.edge;
  room = std::min(room, outline.faces.size());
  for (std::size_t inserted = 0; inserted < room; ++inserted) {
    const HalfedgeMesh mesh(now.patch);
    double longest = too_long;
    Index split = HalfedgeMesh::none;
    for (Index h = 0; h < 3 * mesh.face_slots(); ++h) {
      if (mesh.is_border(h) || mesh.opposite(h) < h) continue;
      const Vec3 &a = mesh.points[mesh.origin(h)], &b = mesh.points[mesh.target(h)];
      const double length = std::min(outline.edge, wanted + gradation * distance(0.5 * (a + b)));
      if (!((b - a).norm() > longest * length)) continue;
      longest = (b - a).norm() / length;
      split = h;
    }
    if (split == HalfedgeMesh::none) break;
    now = with_split_edges(mesh, {&split, 1}, now, net);
  }
  return now;
}

// Every sound state is better.
void set_tangled(Trial& trial) {
  trial.lack = trial.merit = std::numeric_limits<double>::infinity();
}

// What a patch is to lower; 0 is reached.
double score_of(const Trial& trial, const PatchGoal& goal) {
  return goal.for_shape ? trial.lack : trial.merit;
}

// One step's trials: keeps the best of the sound ones.
class Step {
 public:
  Step(const Trial& now, const Surroundings& surroundings, const PatchGoal& goal)
      : now_(now), surroundings_(surroundings), goal_(goal) {}

  // Tries a state: fitted, and where that leaves a little to be done, pulled. True where it has reached the goal, so
  // that nothing else need be tried.
  bool reaches(Trial trial) {
    if (surroundings_.is_folded(trial, now_)) return false;
    surroundings_.fit(trial, goal_.fidelity);
    if (!may_gain(trial) && !goal_.for_shape) return false;
    return has_reached() || reaches_pulled(std::move(trial));
  }

  // The same by the least moves alone.
  bool reaches_pulled(Trial trial) {
    surroundings_.pull(trial);
    return may_gain(trial) && has_reached();
  }

  // As it is.
  bool keeps(Trial trial) { return may_gain(trial) && has_reached(); }

  double gain() const { return best_ ? score(*best_) / score(now_) : 1; }
  std::optional<Trial> take() { return std::move(best_); }

 private:
  double score(const Trial& trial) const { return score_of(trial, goal_); }
  bool has_reached() const { return best_ && score(*best_) == 0; }

  // Whether a state is sound and not much farther; the best of those that gain is kept.
  bool may_gain(Trial& trial) {
    if (!surroundings_.keeps_shape(trial, now_)) return false;
    const double useful = std::max(now_.merit, promising);
    surroundings_.sample_deviation(trial, useful);
    if (trial.merit > useful) return false;
    if (trial.merit > now_.merit) return true;
    const auto gains_over = [&](const Trial& other) { return score(trial) <= least_gain * score(other); };
    if (!gains_over(best_ ? *best_ : now_) || !surroundings_.is_clear(trial)) return true;
    if (trial.merit == 0 && !goal_.for_shape) surroundings_.certify(trial);
    if (gains_over(now_) && (!best_ || score(trial) < score(*best_))) best_ = trial;
    return true;
  }

  const Trial& now_;
  const Surroundings& surroundings_;
  const PatchGoal& goal_;
  std::optional<Trial> best_;
};

// The best of a group of trials, or the first that reaches the goal: the cheaper groups first, and no other where one
// gains well.
std::optional<Trial> next_state(const Trial& now, const Surroundings& surroundings, const FeatureNet& net,
                                const PatchGoal& goal, std::size_t room) {
  Step step(now, surroundings, goal);
  if (!std::isfinite(now.lack)) {  // tangled
    Trial relaxed = now;
    surroundings.relax(relaxed);
    if (step.reaches(relaxed) || step.reaches_pulled(relaxed) || step.keeps(relaxed) || step.gain() < 1)
      return step.take();
  }
  if (step.reaches_pulled(now) || step.reaches(now) || step.gain() <= good_gain) return step.take();
  const HalfedgeMesh mesh(now.patch);
  const EdgesAround edges = edges_around(mesh, now.worst);
  for (const std::vector<Index>& group : edges) {
    for (const Index h : group) {
      if (!mesh.can_flip(h) || is_line_edge(mesh, h, now)) continue;
      HalfedgeMesh changed = mesh;
      changed.flip(h);
      if (step.reaches({.patch = changed.to_surface(), .lines = now.lines})) return step.take();
    }
    if (step.gain() <= good_gain) return step.take();
  }
  if (room == 0) return step.take();
  for (const std::vector<Index>& group : edges) {
    for (const Index h : group)
      if (step.reaches(with_split_edges(mesh, {&h, 1}, now, net))) return step.take();
    if (step.gain() <= good_gain) return step.take();
  }
  if (room >= edges[0].size() && step.reaches(with_split_edges(mesh, edges[0], now, net))) return step.take();
  // Around a thorn fits go astray, and new vertices that are pulled to its tip lead them.
  if (step.gain() < 1) return step.take();
  for (const Index h : edges[0])
    if (step.reaches_pulled(with_split_edges(mesh, {&h, 1}, now, net))) return step.take();
  return step.take();
}

}  // namespace

RefinementPatch::RefinementPatch(const SurfaceMesh& mesh, const VertexStars& stars,
                                 std::span<const std::uint32_t> seeds, int rings, double deviation,
                                 const std::vector<LineEdge>& lines) {
  Stars inside(stars, seeds);
  for (int ring = 0; ring < rings; ++ring) {
    for (const std::uint32_t f : inside.faces())
      for (const std::uint32_t v : mesh.triangles[f]) inside.add(v);
    inside.close();
  }
  do {
    outline_.faces = inside.faces();
    outline_.vertices.clear();
    patch_ = part_of(mesh, outline_.faces, outline_.vertices);
    const std::vector<int> rim_edges = rim_edges_of_vertices(patch_);
    outline_.rim.assign(rim_edges.size(), false);
    for (std::size_t v = 0; v < rim_edges.size(); ++v) {
      outline_.rim[v] = rim_edges[v] > 0;
      // Where the rim touches itself in a vertex, the vertex becomes an inner one.
      if (rim_edges[v] > 2) inside.add(outline_.vertices[v]);
    }
  } while (inside.close());
  lines_ = lines_within(patch_, outline_.vertices, lines);
  outline_.edge = equilateral_edge(surface_area(patch_), static_cast<double>(outline_.faces.size()));
  // The scan is as far away as the place deviates, so the box must reach that far; a tenth more and 0.3 of an edge
  // leave the vertices room to move outwards. A larger box makes the search for what is in it slower and lets fewer
  // patches be improved at once; from 0 to 1 edge the Horse's mean edge ratio and RMS distance stay within half a per
  // cent.
  const double reach = 1.1 * deviation + 0.3 * outline_.edge;
  outline_.box = bounding_box(patch_.vertices);
  outline_.box.low.array() -= reach;
  outline_.box.high.array() += reach;
}

Trial RefinementPatch::after_steps(Trial now, const Surroundings& surroundings, const FeatureNet& net,
                                   const PatchGoal& goal) const {
  for (int step = 0; step < most_steps && score_of(now, goal) > 0; ++step) {
    const std::size_t inserted = now.vertices() - outline_.vertices.size();
    const std::size_t room = goal.most_vertices - std::min(goal.most_vertices, inserted);
    std::optional<Trial> next = next_state(now, surroundings, net, goal, room);
    if (!next) break;
    now = std::move(*next);
  }
  return now;
}

// As it is, whatever it is.
Trial RefinementPatch::first_state(const Surroundings& surroundings, const PatchGoal& goal) const {
  Trial first{.patch = patch_, .lines = lines_};
  surroundings.keeps_shape(first, first);
  surroundings.sample_deviation(first, std::numeric_limits<double>::infinity());
  if (goal.may_be_tangled) {
    set_tangled(first);
    first.certified = true;
    first.sharpest_deg = first.sharpest_on_line_deg = 0;
  }
  return first;
}

PatchOutcome RefinementPatch::improve(const SurfaceMesh& mesh, const std::vector<std::uint32_t>& around,
                                      const SurfaceMesh& scan, const std::vector<std::uint32_t>& scan_faces,
                                      const FeatureNet& net, const PatchGoal& goal) {
  const Surroundings surroundings(mesh, outline_, patch_, around, scan, scan_faces, goal);
  if (!surroundings.may_help(patch_)) return {};
  Trial first = first_state(surroundings, goal);
  if (!goal.for_shape) surroundings.certify(first);
  if (score_of(first, goal) == 0) return {.improved = false, .reached = true};
  Trial now = after_steps(first, surroundings, net, goal);
  const bool no_farther = holds(first, now, surroundings);  // which certifies
  const bool improved =
      no_farther && std::isfinite(now.lack) && score_of(now, goal) <= least_gain * score_of(first, goal);
  const Trial& last = improved ? now : first;
  const bool reached = goal.may_be_tangled ? improved
                       : goal.for_shape    ? last.lack == 0
                                           : last.deviation[last.worst] <= goal.allowed;
  if (improved) take(std::move(now));
  return {.improved = improved, .reached = reached};
}

PatchOutcome RefinementPatch::shorten(const SurfaceMesh& mesh, const std::vector<std::uint32_t>& around,
                                      const SurfaceMesh& scan, const std::vector<std::uint32_t>& scan_faces,
                                      const FeatureNet& net, const PatchGoal& goal, const ShorterEdges& place) {
  const Surroundings surroundings(mesh, outline_, patch_, around, scan, scan_faces, goal);
  if (!surroundings.may_help(patch_)) return {};
  Trial first = first_state(surroundings, goal);
  Trial now = with_shorter_edges(first, outline_, net, place, goal.most_vertices);
  if (now.vertices() == first.vertices()) return {};
  Trial fitted = now;
  surroundings.fit(fitted, goal.fidelity);
  if (surroundings.keeps_shape(fitted, first)) now = std::move(fitted);
  // Long edges beside short ones make angles that flips and fits can mend.
  surroundings.keeps_shape(now, now);
  surroundings.sample_deviation(now, std::numeric_limits<double>::infinity());
  if (goal.may_be_tangled && !surroundings.is_clear(now)) set_tangled(now);
  now = after_steps(std::move(now), surroundings, net, goal);
  // What is a little too far can be mended by the next patches.
  const bool is_near = holds(first, now, surroundings) || (!goal.for_shape && now.merit < promising);
  if (!is_near || now.lack > first.lack || !surroundings.keeps_shape(now, first) || !surroundings.is_clear(now))
    return {};
  take(std::move(now));
  return {.improved = true, .reached = true};
}

// Whether the one state is no farther from the scan than the other, or within the limit.
bool RefinementPatch::holds(Trial& first, Trial& now, const Surroundings& surroundings) const {
  for (Trial* trial : {&first, &now})
    if (!trial->certified) surroundings.certify(*trial);
  return now.merit <= first.merit;
}

void RefinementPatch::take(Trial trial) {
  patch_ = std::move(trial.patch);
  lines_ = std::move(trial.lines);
}

void RefinementPatch::write(SurfaceMesh& mesh, FeatureNet& net) const {
  std::vector<std::uint32_t> number = outline_.vertices;
  for (std::size_t v = 0; v < patch_.vertices.size(); ++v) {
    if (v < outline_.vertices.size()) {
      mesh.vertices[outline_.vertices[v]] = patch_.vertices[v];
    } else {
      number.push_back(static_cast<std::uint32_t>(mesh.vertices.size()));
      mesh.vertices.push_back(patch_.vertices[v]);
    }
  }
  for (const LineEdge& e : lines_) {
    if (e.from < outline_.vertices.size()) continue;
    std::vector<VertexOnLine>& on_line = net.lines[e.line].vertices;
    const auto at = std::upper_bound(on_line.begin(), on_line.end(), e.from_place,
                                     [](double place, const VertexOnLine& other) { return place < other.place; });
    on_line.insert(at, {number[e.from], e.from_place});
  }
  for (std::size_t f = 0; f < patch_.triangles.size(); ++f) {
    const Triangle& t = patch_.triangles[f];
    const Triangle global{number[t[0]], number[t[1]], number[t[2]]};
    if (f < outline_.faces.size())
      mesh.triangles[outline_.faces[f]] = global;
    else
      mesh.triangles.push_back(global);
  }
}

}  // namespace scan2fea
