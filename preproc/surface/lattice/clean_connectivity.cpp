#include "preproc/surface/lattice/clean_connectivity.hpp"

#include "preproc/surface/kernel/adjacency.hpp"
#include "preproc/surface/kernel/halfedge_mesh.hpp"
#include "quality/triangle_measures.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <numbers>
#include <queue>
#include <set>

namespace scan2fea {
namespace {

using Index = HalfedgeMesh::Index;

constexpr double largest_turn_cosine = 0.5;  // no step turns a triangle by more than 60 degrees
constexpr double largest_eta = 1 / 0.3;      // no step makes a triangle above this, unless it was worse before
constexpr double valence_cost = 0.5;         // one unit of irregularity is worth so many edge lengths
constexpr int flip_passes = 10;              // flips that would go round in a circle end here
// Edges longer than this times the wanted length are not contracted for their valences. It seldom decides: with 1 or 10
// the Horse, igea and fandisk come out the same at 8,000 faces.
constexpr double longest_collapse = 1.3;
// The sine of what the angles opposite an edge may have more than 180 degrees: without it flips between diagonals that
// are as good as equal go to and fro. At ten times as much (12 degrees) Delaunay flips are missing, and the mean edge
// ratio of igea at 8,000 faces is 0.001 higher.
constexpr double cocircular = 0.02;

Vec3 normal(const Vec3& a, const Vec3& b, const Vec3& c) {
  return (b - a).cross(c - a);
}

bool turned_too_far(const Vec3& before, const Vec3& after) {
  return before.dot(after) < largest_turn_cosine * before.norm() * after.norm();
}

class Cleaner {
 public:
  Cleaner(const SurfaceMesh& mesh, std::vector<double>& edge_length, std::span<const std::uint32_t> welded)
      : mesh_(mesh), edge_length_(edge_length), merged_into_(mesh.vertices.size()), welded_(welded) {
    valence_.resize(mesh.vertices.size());
    ideal_valence_.resize(mesh.vertices.size(), 6);
    sixths_.resize(mesh.vertices.size(), 0);
    for (Index v = 0; v < valence_.size(); ++v) {
      valence_[v] = static_cast<int>(mesh_.valence(v));
      merged_into_[v] = v;
      if (!mesh_.is_alive(v) || !mesh_.is_border_vertex(v)) continue;
      sixths_[v] = angle_at(v) * 3 / std::numbers::pi;
      ideal_valence_[v] = 1 + std::max(1, static_cast<int>(std::lround(sixths_[v])));
    }
    for (Index h = 0; h < 3 * mesh_.face_slots(); ++h) {
      const Index a = mesh_.origin(h), b = mesh_.target(h);
      if (is_chord(a, b)) chords_.insert(chord(a, b));
    }
  }

  void flip_until_settled() {
    for (int pass = 0; pass < flip_passes; ++pass) {
      const std::size_t before = result.flips;
      for (Index h = 0; h < 3 * mesh_.face_slots(); ++h)
        if (is_edge(h) && flip_is_better(h)) flip(h);
      if (result.flips == before) break;
    }
  }

  // Collapses that bring the valences around nearer to six by at least two, best first.
  void collapse_for_valence() {
    struct Candidate {
      int gain;
      double length;
      Index h;
    };
    std::vector<Candidate> candidates;
    for (Index h = 0; h < 3 * mesh_.face_slots(); ++h)
      if (is_edge(h) && -collapse_irregularity(h) >= 2 && relative_length(h) < longest_collapse)
        candidates.push_back({-collapse_irregularity(h), relative_length(h), h});
    std::sort(candidates.begin(), candidates.end(), [](const Candidate& a, const Candidate& b) {
      return a.gain != b.gain ? a.gain > b.gain : a.length != b.length ? a.length < b.length : a.h < b.h;
    });
    for (const Candidate& c : candidates)
      if (is_edge(c.h) && -collapse_irregularity(c.h) >= 2 && collapse_is_sound(c.h)) collapse(c.h);
  }

  // Takes the cheapest steps until the number of faces is met; costs are renewed when an edge comes to the front.
  void reach(std::size_t faces) {
    while (mesh_.face_count() > faces) {
      const std::size_t before = mesh_.face_count();
      change_count(
          faces, [this](Index h) { return relative_length(h) + valence_cost * collapse_irregularity(h); },
          [this](Index h) { return collapse_is_sound(h); }, [this](Index h) { collapse(h); });
      flip_until_settled();
      if (mesh_.face_count() == before) break;
    }
    while (mesh_.face_count() + 1 < faces) {
      const std::size_t before = mesh_.face_count();
      change_count(
          faces, [this](Index h) { return -relative_length(h) + valence_cost * split_irregularity(h); },
          [](Index) { return true; }, [this](Index h) { split(h); });
      flip_until_settled();
      if (mesh_.face_count() == before) break;
    }
  }

  std::size_t face_count() const { return mesh_.face_count(); }

  void write(SurfaceMesh& mesh, std::size_t old_vertices) {
    std::vector<std::uint32_t> number(mesh_.vertex_slots());
    std::uint32_t alive = 0;
    for (Index v = 0; v < number.size(); ++v)
      if (mesh_.is_alive(v)) {
        edge_length_[alive] = edge_length_[v];
        number[v] = alive++;
      }
    edge_length_.resize(alive);
    result.vertex_of_old.resize(old_vertices);
    for (Index v = 0; v < old_vertices; ++v) {
      Index into = v;
      while (merged_into_[into] != into) into = merged_into_[into];
      result.vertex_of_old[v] = number[into];
    }
    mesh = mesh_.to_surface();
  }

  ConnectivityResult result;

 private:
  struct Quad {
    Index a, b, c, d;  // the edge runs from a to b; c is on its left, d on its right
  };
  Quad quad(Index h) const {
    const Index o = mesh_.opposite(h);
    return {mesh_.origin(h), mesh_.target(h), mesh_.origin(HalfedgeMesh::prev(h)), mesh_.origin(HalfedgeMesh::prev(o))};
  }

  // For an edge from the inside to the border, the side that starts at the border: that vertex is kept.
  Index border_first(Index h) const { return mesh_.is_border_vertex(mesh_.target(h)) ? mesh_.opposite(h) : h; }

  // Interior edges, from one of their sides.
  bool is_edge(Index h) const {
    return mesh_.is_face_alive(HalfedgeMesh::face(h)) && !mesh_.is_border(h) && h < mesh_.opposite(h);
  }

  // The sum of the angles of all faces around it.
  double angle_at(Index v) const {
    double angle = 0;
    mesh_.for_each_outgoing(v, [&](Index h) {
      const Vec3 a = mesh_.points[mesh_.target(h)] - mesh_.points[v];
      const Vec3 b = mesh_.points[mesh_.origin(HalfedgeMesh::prev(h))] - mesh_.points[v];
      angle += angle_between(a, b);
    });
    return angle;
  }
  int irregularity(Index v, int change) const { return std::abs(valence_[v] + change - ideal_valence_[v]); }

  // What flips weigh: squared irregularity, and more where a corner has too many faces for its angle, which no moving
  // of vertices mends.
  int misfit(Index v, int change) const {
    constexpr double narrowest_face = 0.6;  // over 60 degrees
    constexpr int crowded = 3;              // as much as the vertices around lose by the flip that helps
    const int of_valence = irregularity(v, change) * irregularity(v, change);
    const int faces = valence_[v] + change - 1;
    return of_valence + (sixths_[v] > 0 && faces > 1 && sixths_[v] < narrowest_face * faces ? crowded : 0);
  }

  // An edge between two border vertices of a cut surface. Another patch may have the same one: welded again, the
  // surface would have it twice.
  bool is_chord(Index a, Index b) const {
    return !welded_.empty() && mesh_.is_border_vertex(a) && mesh_.is_border_vertex(b);
  }
  FeatureEdge chord(Index a, Index b) const { return feature_edge(welded_[a], welded_[b]); }

  double relative_length(Index h) const {
    const Index a = mesh_.origin(h), b = mesh_.target(h);
    return (mesh_.points[a] - mesh_.points[b]).norm() * 2 / (edge_length_[a] + edge_length_[b]);
  }

  // How the sum of |valence - 6| changes.
  int collapse_irregularity(Index h) const {
    const auto [a, b, c, d] = quad(border_first(h));
    return irregularity(a, valence_[b] - 4) + irregularity(c, -1) + irregularity(d, -1) - irregularity(a, 0) -
           irregularity(b, 0) - irregularity(c, 0) - irregularity(d, 0);
  }
  int split_irregularity(Index h) const {
    const auto [a, b, c, d] = quad(h);
    return 2 + irregularity(c, 1) + irregularity(d, 1) - irregularity(c, 0) - irregularity(d, 0);
  }

  bool flip_is_better(Index h) const {
    const auto [a, b, c, d] = quad(h);
    if (is_chord(c, d) && chords_.contains(chord(c, d))) return false;
    int change = 0;
    for (const Index v : {a, b}) change += misfit(v, -1) - misfit(v, 0);
    for (const Index v : {c, d}) change += misfit(v, 1) - misfit(v, 0);
    if (change > 0) return false;
    const Vec3 &pa = mesh_.points[a], &pb = mesh_.points[b], &pc = mesh_.points[c], &pd = mesh_.points[d];
    if (change == 0) {
      // Delaunay: the angles opposite the edge add up to more than 180 degrees.
      const Vec3 ca = pa - pc, cb = pb - pc, da = pa - pd, db = pb - pd;
      const double sine_of_sum = ca.cross(cb).norm() * da.dot(db) + ca.dot(cb) * da.cross(db).norm();
      if (sine_of_sum >=
          -cocircular * std::sqrt(ca.squaredNorm() * cb.squaredNorm() * da.squaredNorm() * db.squaredNorm()))
        return false;
    }
    const Vec3 old_normal = normal(pa, pb, pc).normalized() + normal(pb, pa, pd).normalized();
    if (turned_too_far(old_normal, normal(pd, pc, pa)) || turned_too_far(old_normal, normal(pc, pd, pb))) return false;
    const double worst = std::max(eta(pd, pc, pa), eta(pc, pd, pb));
    if (worst > largest_eta && worst > std::max(eta(pa, pb, pc), eta(pb, pa, pd))) return false;
    return mesh_.can_flip(h);
  }

  void flip(Index h) {
    const auto [a, b, c, d] = quad(h);
    if (is_chord(a, b)) chords_.erase(chord(a, b));
    if (is_chord(c, d)) chords_.insert(chord(c, d));
    mesh_.flip(h);
    --valence_[a];
    --valence_[b];
    ++valence_[c];
    ++valence_[d];
    ++result.flips;
  }

  Vec3 merged_point(Index h) const {
    const Index a = mesh_.origin(h), b = mesh_.target(h);
    if (mesh_.is_border_vertex(a)) return mesh_.points[a];
    if (mesh_.is_border_vertex(b)) return mesh_.points[b];
    return 0.5 * (mesh_.points[a] + mesh_.points[b]);
  }

  bool collapse_is_sound(Index h) const {
    const Index a = mesh_.origin(h), b = mesh_.target(h);
    if (mesh_.is_border_vertex(a) && mesh_.is_border_vertex(b)) return false;
    const auto [qa, qb, c, d] = quad(h);
    for (const Index v : {c, d})
      if (valence_[v] <= (mesh_.is_border_vertex(v) ? 3 : 4)) return false;
    if (!mesh_.can_collapse(h) || makes_chord(a, b)) return false;
    const Vec3 to = merged_point(h);
    for (const auto& [v, other] : {std::pair{a, b}, std::pair{b, a}}) {
      bool sound = true;
      mesh_.for_each_outgoing(v, [&](Index out) {
        const Index p = mesh_.target(out), q = mesh_.origin(HalfedgeMesh::prev(out));
        if (p == other || q == other) return;
        const Vec3 &x = mesh_.points[v], &y = mesh_.points[p], &z = mesh_.points[q];
        const double after = eta(to, y, z);
        if (turned_too_far(normal(x, y, z), normal(to, y, z)) || (after > largest_eta && after > eta(x, y, z)))
          sound = false;
      });
      if (!sound) return false;
    }
    return true;
  }

  bool makes_chord(Index a, Index b) const {
    if (welded_.empty() || mesh_.is_border_vertex(a) == mesh_.is_border_vertex(b)) return false;
    const Index on_border = mesh_.is_border_vertex(a) ? a : b, inner = on_border == a ? b : a;
    bool made = false;
    mesh_.for_each_neighbour(inner, [&](Index v) {
      made = made || (v != on_border && mesh_.is_border_vertex(v) && !mesh_.are_neighbours(v, on_border));
    });
    return made;
  }

  void collapse(Index h) {
    h = border_first(h);
    const auto [a, b, c, d] = quad(h);
    const Vec3 to = merged_point(h);
    if (!mesh_.is_border_vertex(a)) edge_length_[a] = 0.5 * (edge_length_[a] + edge_length_[b]);
    valence_[a] += valence_[b] - 4;
    --valence_[c];
    --valence_[d];
    mesh_.collapse(h);
    mesh_.points[a] = to;
    merged_into_[b] = a;
    ++result.collapses;
  }

  void split(Index h) {
    const auto [a, b, c, d] = quad(h);
    edge_length_.push_back(0.5 * (edge_length_[a] + edge_length_[b]));
    valence_.push_back(4);
    ideal_valence_.push_back(6);
    sixths_.push_back(0);
    ++valence_[c];
    ++valence_[d];
    merged_into_.push_back(mesh_.split_edge(h, 0.5 * (mesh_.points[a] + mesh_.points[b])));
    ++result.splits;
  }

  template <class Cost, class IsSound, class Step>
  void change_count(std::size_t faces, const Cost& cost, const IsSound& is_sound, const Step& step) {
    using Entry = std::pair<double, Index>;
    std::vector<Entry> entries;
    for (Index h = 0; h < 3 * mesh_.face_slots(); ++h)
      if (is_edge(h)) entries.emplace_back(cost(h), h);
    std::priority_queue<Entry, std::vector<Entry>, std::greater<>> queue(std::greater<>(), std::move(entries));
    const auto difference = [&] { return static_cast<long>(mesh_.face_count()) - static_cast<long>(faces); };
    const bool down = difference() > 0;
    while (!queue.empty() && (down ? difference() > 0 : difference() < -1)) {
      const auto [promised, h] = queue.top();
      queue.pop();
      if (!is_edge(h)) continue;
      const double now = cost(h);
      if (now > promised + 1e-12) {
        queue.emplace(now, h);
      } else if (is_sound(h)) {
        step(h);
      }
    }
  }

  HalfedgeMesh mesh_;
  std::vector<double>& edge_length_;
  std::vector<int> valence_, ideal_valence_;
  std::vector<double> sixths_;  // of a border vertex, its angle over 60 degrees; else 0
  std::vector<Index> merged_into_;
  std::span<const std::uint32_t> welded_;
  std::set<FeatureEdge> chords_;  // see is_chord
};

}  // namespace

ConnectivityResult improve_connectivity(SurfaceMesh& mesh, std::vector<double>& edge_length,
                                        const ConnectivityOptions& options) {
  const std::size_t old_vertices = mesh.vertices.size();
  Cleaner cleaner(mesh, edge_length, options.welded);
  for (int round = 0; round < options.rounds; ++round) {
    cleaner.flip_until_settled();
    cleaner.collapse_for_valence();
  }
  cleaner.flip_until_settled();
  if (options.triangles) cleaner.reach(*options.triangles);
  cleaner.write(mesh, old_vertices);
  return std::move(cleaner.result);
}

}  // namespace scan2fea
