#include "preproc/surface/simplification/shape_search.hpp"

#include "preproc/mesh/error.hpp"
#include "preproc/surface/features/feature_selection.hpp"
#include "preproc/surface/kernel/adjacency.hpp"
#include "preproc/surface/mending/defects.hpp"
#include "quality/triangle_measures.hpp"
#include "quality/triangle_tree.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace scan2fea {
namespace {

constexpr double degrees = 180 / std::numbers::pi;

// Triangles with smaller angles are bad, and walls whose elements have smaller ones. Between two creases less will do:
// such an element need not be flat.
constexpr double least_angle_deg = 30, least_across_wall_deg = 25, least_corner_deg = 19;
// Of the wanted edges around a bad triangle, from one surface to the next: by how bad it is.
constexpr double least_shortening = 0.75, most_shortening = 0.5;
constexpr double reach = 1.5;               // around it, over its longest edge
constexpr double gradation_around_bad = 2;  // over the surface's
constexpr int most_renewals = 11;
// In a row, without a gain that is worth it: of few triangles, of many, of very many.
constexpr int most_in_vain = 3, most_in_vain_of_many = 1, most_in_vain_of_very_many = 0;
constexpr double worth_it_deg = 0.5;
constexpr std::size_t many_triangles = 5000, very_many_triangles = 20000;
constexpr double good_of_many_deg = 17;   // what the tetrahedra's optimisation copes with, where time matters
constexpr double room_for_places = 1.05;  // over the triangles wanted
// Of the triangles, that are bad.
constexpr double share_of_many = 0.1;
// Over those wanted; and what a small part may have in any case.
constexpr double few_triangles_of_part = 1000;
constexpr double most_triangles = 3, few_triangles = 8000, most_triangles_of_small = 40;
// A wall is looked for up to this depth, in edges. Its sides face one another within 37 degrees.
constexpr double deepest_wall = 0.5, opposing = -0.8;
// Cosine of what normals beside a place may differ by for it to have one.
constexpr double flat = 0.7;

struct BadPlace {
  Vec3 centre;
  double reach, shortening;
};

struct ShapeDefects {
  double least_angle_deg = 180;  // but for corners between two creases
  std::vector<BadPlace> bad;
  double sharpest_corner_deg = 180;
  std::vector<SharpCorner> sharp_corners;

  bool empty() const { return bad.empty() && sharp_corners.empty(); }
  double sharpest() const { return std::min(least_angle_deg, sharpest_corner_deg); }

  // Corners of the part stay about as they are; what else is bad decides then.
  bool better_than(const ShapeDefects& other) const {
    if (std::abs(sharpest() - other.sharpest()) > worth_it_deg) return sharpest() > other.sharpest();
    return least_angle_deg > other.least_angle_deg;
  }
};

class ShapeCheck {
 public:
  explicit ShapeCheck(const Candidate& candidate)
      : mesh_(candidate.mesh),
        tree_(candidate.mesh),
        neighbours_(face_neighbours(candidate.mesh, VertexStars(candidate.mesh))),
        normals_(vertex_normals(candidate.mesh)),
        creases_(edges_of(candidate.net)) {}

  ShapeDefects defects() const {
    ShapeDefects found;
    for (std::uint32_t f = 0; f < mesh_.triangles.size(); ++f) {
      const auto& [a, b, c] = mesh_.triangles[f];
      const Vec3 &p = mesh_.vertices[a], &q = mesh_.vertices[b], &r = mesh_.vertices[c];
      const double longest = std::max({(q - p).norm(), (r - q).norm(), (p - r).norm()});
      double least = wall_angle(f);
      for (std::uint32_t k = 0; k < 3; ++k)
        least = std::min({least, corner_angle(f, k, longest, found), half_wedge(f, k)});
      found.least_angle_deg = std::min(found.least_angle_deg, least);
      if (least < least_angle_deg)
        found.bad.push_back(
            {(p + q + r) / 3, reach * longest, std::clamp(least / least_angle_deg, most_shortening, least_shortening)});
    }
    return found;
  }

 private:
  bool is_crease(std::uint32_t a, std::uint32_t b) const {
    return std::binary_search(creases_.begin(), creases_.end(), feature_edge(a, b));
  }

  double corner_angle(std::uint32_t f, std::uint32_t k, double longest, ShapeDefects& found) const {
    const Triangle& t = mesh_.triangles[f];
    const std::uint32_t v = t[k], next = t[(k + 1) % 3], last = t[(k + 2) % 3];
    const double angle = angle_deg(mesh_.vertices[v], mesh_.vertices[next], mesh_.vertices[last]);
    if (!(angle < least_angle_deg) || !is_crease(v, next) || !is_crease(v, last)) return angle;
    if (angle < least_corner_deg) {
      found.sharp_corners.push_back({mesh_.vertices[v], longest});
      found.sharpest_corner_deg = std::min(found.sharpest_corner_deg, angle);
    }
    return 180;
  }

  // Of the interior dihedral angle at an edge that is no crease: a fold of the triangles, not of the part. At a crease
  // the whole of it, which one element can fill, where that is too sharp.
  double half_wedge(std::uint32_t f, std::uint32_t k) const {
    const std::uint32_t g = neighbours_[f][k];
    const Triangle& t = mesh_.triangles[f];
    const std::uint32_t a = t[(k + 1) % 3], b = t[(k + 2) % 3];
    if (g == no_face) return 180;
    const Vec3 n = area_vector(mesh_, t), m = area_vector(mesh_, mesh_.triangles[g]);
    if (n.dot(m) > 0) return 180;
    const Vec3 along = (mesh_.vertices[b] - mesh_.vertices[a]).normalized();
    const double half = interior_angle(n, m, along) / 2 * degrees;
    if (half < least_angle_deg && is_crease(a, b)) return 2 * half >= least_corner_deg ? 180 : 2 * half;
    return half;
  }

  // Where the other side of the body is so near that elements across it are flat: the angle at the base of the element
  // over a triangle of this size that ends there.
  double wall_angle(const Vec3& place, const Vec3& outward, double edge, std::uint32_t f) const {
    const double depth = deepest_wall / 2 * edge;
    const Vec3 inside = place - depth * outward;
    const ClosestPoint nearest = tree_.closest(inside, f);
    const double distance = std::sqrt(nearest.squared_distance);
    const Triangle& other = mesh_.triangles[nearest.triangle];
    const Vec3 opposite = area_vector(mesh_, other);
    if (distance > 0.999 * depth || opposite.dot(outward) > opposing * opposite.norm()) return 180;
    const Triangle& t = mesh_.triangles[f];
    for (const std::uint32_t v : other)
      if (v == t[0] || v == t[1] || v == t[2]) return 180;  // a wedge, not a wall
    const bool beyond = (inside - nearest.point).dot(opposite) > 0;
    const double thickness = beyond ? depth - distance : depth + distance;
    const double angle = std::atan(thickness / (std::sqrt(0.75) * edge)) * degrees;
    return angle < least_across_wall_deg ? angle : 180;
  }

  // Behind its centre, its corners and the middles of its sides, where these are not on edges of the part.
  double wall_angle(std::uint32_t f) const {
    const Triangle& t = mesh_.triangles[f];
    const Vec3 normal = area_vector(mesh_, t);
    const double edge = equilateral_edge(normal.norm() / 2, 1);
    const auto& p = mesh_.vertices;
    double least = wall_angle((p[t[0]] + p[t[1]] + p[t[2]]) / 3, normal.normalized(), edge, f);
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t g = neighbours_[f][k];
      if (normals_[t[k]].dot(normal) > flat * normal.norm())
        least = std::min(least, wall_angle(p[t[k]], normals_[t[k]], edge, f));
      if (g == no_face || g < f) continue;
      const Vec3 other = area_vector(mesh_, mesh_.triangles[g]);
      if (other.dot(normal) > flat * other.norm() * normal.norm())
        least = std::min(
            least, wall_angle((p[t[(k + 1) % 3]] + p[t[(k + 2) % 3]]) / 2, (normal + other).normalized(), edge, f));
    }
    return least;
  }

  const SurfaceMesh& mesh_;
  TriangleTree tree_;
  std::vector<Triangle> neighbours_;
  std::vector<Vec3> normals_;
  std::vector<FeatureEdge> creases_;
};

void shorten_around(const std::vector<BadPlace>& bad, const SurfaceMesh& scan, std::vector<double>& length) {
  for (std::size_t v = 0; v < length.size(); ++v) {
    double factor = 1;
    for (const BadPlace& place : bad)
      if ((scan.vertices[v] - place.centre).squaredNorm() < place.reach * place.reach)
        factor = std::min(factor, place.shortening);
    length[v] *= factor;
  }
}

int patience(std::size_t triangles) {
  return triangles < many_triangles        ? most_in_vain
         : triangles < very_many_triangles ? most_in_vain_of_many
                                           : most_in_vain_of_very_many;
}

}  // namespace

Candidate make_shaped_surface(PreparedScan& scan, const SizingOptions& sizing, const SimplifyOptions& options,
                              SimplifyResult& result, const Progress& progress) {
  const double most =
      std::max(most_triangles * sizing.triangles, std::min(few_triangles, most_triangles_of_small * sizing.triangles));
  std::vector<FeatureEdge> creases = scan.features().sharp;
  SizingOptions renewed = sizing;
  std::vector<double> length;
  Candidate best;
  ShapeDefects best_defects;
  bool best_is_other_part = false;
  SimplifyResult best_result;
  for (int renewal = 0, in_vain = 0;; ++renewal) {
    SimplifyResult made = result;
    Candidate candidate;
    try {
      candidate = make_surface(scan, renewed, options, options.effort, made, progress);
    } catch (const NotMeshable&) {
      if (renewal == 0) throw;
      break;
    }
    if (made.method == SimplifyMethod::lattice) lower_worst(candidate, scan, options.effort, made, progress);
    open_wedges(candidate, scan, options);
    const ShapeDefects defects = ShapeCheck(candidate).defects();
    const std::size_t triangles = candidate.mesh.triangles.size();
    const bool lattice_failed = !made.fallback_reason.empty();
    const bool lost_creases = !creases.empty() && made.feature_edges_kept == 0;
    // A small part without its edges is another part.
    const bool is_other_part = lost_creases && sizing.triangles < few_triangles_of_part;
    const bool is_best =
        renewal == 0 || (best_is_other_part == is_other_part ? defects.better_than(best_defects) : best_is_other_part);
    const bool gained = renewal == 0 || (best_is_other_part && !is_other_part) ||
                        defects.sharpest() > best_defects.sharpest() + worth_it_deg;
    in_vain = gained ? 0 : in_vain + 1;
    if (is_best) {
      best_is_other_part = is_other_part;
      best = std::move(candidate);
      best_defects = defects;
      best_result = std::move(made);
    }
    if (options.method != SimplifyMethod::lattice || (defects.empty() && !is_other_part) || renewal == most_renewals)
      break;
    if (triangles >= many_triangles && !lattice_failed && defects.sharpest() >= good_of_many_deg) break;
    if (in_vain > patience(triangles)) break;

    if (length.empty()) length = scan.wanted_lengths(sizing);
    // What cannot be kept but by smaller triangles everywhere is not asked for again where few are bad without it.
    const bool many_bad = static_cast<double>(defects.bad.size()) > share_of_many * static_cast<double>(triangles);
    if (lost_creases && !lattice_failed && !many_bad && !is_other_part) creases.clear();
    creases = without_narrow_corners(scan.mesh, creases, defects.sharp_corners);
    scan.keep_creases(creases);
    if (lattice_failed || (lost_creases && many_bad) || is_other_part)
      for (double& l : length) l *= least_shortening;
    else
      shorten_around(defects.bad, scan.mesh, length);
    limit_gradation(scan.mesh, gradation_around_bad * sizing.gradation, length);
    ask_for_lengths(scan.mesh, length, renewed);
    // A few places cost the others little.
    if (renewed.triangles < room_for_places * sizing.triangles) renewed.triangles = sizing.triangles;
    if (renewed.triangles > most) break;
  }
  result = std::move(best_result);
  result.faces_after = best.mesh.triangles.size();
  return best;
}

}  // namespace scan2fea
