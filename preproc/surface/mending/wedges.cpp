#include "preproc/surface/mending/wedges.hpp"

#include "preproc/mesh/union_find.hpp"
#include "preproc/surface/fit/preserve_volume.hpp"
#include "preproc/surface/kernel/nearest.hpp"
#include "preproc/surface/kernel/rings.hpp"
#include "preproc/surface/mending/defects.hpp"
#include "preproc/surface/mending/local_moves.hpp"
#include "preproc/surface/placement/shape_energy.hpp"
#include "quality/self_intersections.hpp"
#include "quality/triangle_measures.hpp"

#include <Eigen/Cholesky>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <unordered_set>

namespace scan2fea {
namespace {

constexpr double degree = std::numbers::pi / 180;
// What other values of these do was tried on 42 surfaces of 22 scans, 29 of them with wedges or near pairs; near pairs
// were told by the ball of quality/wall_thickness.hpp then, which finds a few more.
constexpr int rings_moved = 2;
// Fifty leave some open that a hundred close; more change nothing.
constexpr int most_sweeps = 200;
// Asked for beyond the limit, since penalties stop short of it: without, a fifth more is left; 1 to 4 degrees are
// alike.
constexpr double margin = 2 * degree;
// Against the shape energy: a radian of missing angle, and an edge length of way. For angles 100 does as well; 25 is
// too soft and 1600 too stiff for these steps. For ways a tenth lets vertices go half as far again and ten half as far,
// at a cost and a gain of a few in a hundred.
constexpr double weight_of_angle = 400, weight_of_way = 1;
// In edges, of the mesh or of the scan where these are longer: how far around its middle the scan is searched, and how
// much of a crease there must be. A single edge of a scan is no crease, however fine the mesh.
constexpr double crease_reach = 2, least_crease = 2;
constexpr double most_near = 0.01;                            // of the vertices; half and double that are alike
constexpr double longest_step = 0.1, negligible_step = 1e-3;  // of the edges around; three times as long are alike

// Interior dihedral angle in radians, (0, 2 pi), at the edge from a to b of the triangle a, b, c whose neighbour has
// the apex d, with its gradients by all four.
struct Dihedral {
  double angle;
  Vec3 by_a, by_b, by_c, by_d;
};

Dihedral dihedral(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
  const Vec3 edge = b - a;
  const double length = edge.norm();
  const Vec3 along = edge / length;
  Vec3 n = edge.cross(c - a), m = (d - a).cross(edge);
  const double height_c = n.norm() / length, height_d = m.norm() / length;
  n /= n.norm();
  m /= m.norm();
  Dihedral result;
  result.angle = interior_angle(n, m, along);
  result.by_c = n / height_c;
  result.by_d = m / height_d;
  const double at_c = (c - a).dot(along) / length, at_d = (d - a).dot(along) / length;
  result.by_a = -(1 - at_c) * result.by_c - (1 - at_d) * result.by_d;
  result.by_b = -at_c * result.by_c - at_d * result.by_d;
  return result;
}

// The corner of a face that is not on its edge to `neighbour`.
std::uint32_t apex_across(const SurfaceMesh& mesh, const std::vector<Triangle>& neighbours, std::uint32_t face,
                          std::uint32_t neighbour) {
  for (std::size_t k = 0; k < 3; ++k)
    if (neighbours[face][k] == neighbour) return mesh.triangles[face][k];
  return mesh.triangles[face][0];
}

Dihedral dihedral_at(const SurfaceMesh& mesh, const std::vector<Triangle>& neighbours, std::uint32_t face,
                     std::size_t side) {
  const Triangle& t = mesh.triangles[face];
  const std::uint32_t d = apex_across(mesh, neighbours, neighbours[face][side], face);
  return dihedral(mesh.vertices[t[(side + 1) % 3]], mesh.vertices[t[(side + 2) % 3]], mesh.vertices[t[side]],
                  mesh.vertices[d]);
}

// The mean angle of the scan's own sharp edges along an edge of the mesh, if they make a crease: noise has some, too.
std::optional<double> scan_crease(const ReferenceSurface& scan, std::uint32_t start, const Vec3& centre,
                                  const Vec3& edge, double limit) {
  const double unit = std::max(edge.norm(), scan.mean_edge(scan.mesh.triangles.size()));
  const double reach = crease_reach * unit;
  std::vector<std::uint32_t> reached{start};
  std::unordered_set<std::uint32_t> known{start};
  double length = 0, sum = 0;
  for (std::size_t i = 0; i < reached.size(); ++i)
    for (const std::uint32_t corner : scan.stars.corners(reached[i])) {
      const std::uint32_t face = corner / 3;
      const std::size_t side = (corner + 2) % 3;  // from reached[i] on
      const Triangle& t = scan.mesh.triangles[face];
      const std::uint32_t ahead = t[(corner + 1) % 3];
      const Vec3 &a = scan.mesh.vertices[reached[i]], &b = scan.mesh.vertices[ahead];
      if ((b - centre).norm() < reach && known.insert(ahead).second) reached.push_back(ahead);
      // Each edge once, from its lower end.
      if (reached[i] > ahead || scan.neighbours[face][side] == no_face) continue;
      const double angle = dihedral_at(scan.mesh, scan.neighbours, face, side).angle;
      if (!(angle < limit)) continue;
      const double along = std::abs((b - a).dot(edge)) / edge.norm();
      length += along;
      sum += along * angle;
    }
  if (length < least_crease * unit) return std::nullopt;
  return sum / length;
}

// Two vertices of a surface with nothing but a thin piece of the body between them.
struct NearPair {
  std::uint32_t vertex, other;
  double distance, wanted;

  bool lacks() const { return distance < wanted; }
};

// Each vertex with the nearest across the body, where they lie within twice the distance wanted. Not by the ball of
// quality/wall_thickness.hpp: it tells the triangle on the other side and not the vertex that the shape energy can keep
// off. With that triangle's corners two of 97 meshes of libcgal-demo got far worse tetrahedra (26.1 to 0.9
// degrees, 28.6 to 19.1), and one far better.
std::vector<NearPair> find_near_pairs(const SurfaceMesh& mesh, const VertexStars& stars, const WedgeOptions& options) {
  const std::vector<Vec3> normals = vertex_normals(mesh);
  std::vector<Vec3> opposite;
  for (const Vec3& n : normals) opposite.push_back(-n);
  const double edge = equilateral_edge(surface_area(mesh), static_cast<double>(mesh.triangles.size()));
  const std::vector<std::uint32_t> nearest = nearest_vertices(mesh.vertices, opposite, mesh, edge);
  std::vector<NearPair> pairs;
  for (std::uint32_t v = 0; v < mesh.vertices.size(); ++v) {
    const std::uint32_t w = nearest[v];
    const Vec3 across = mesh.vertices[w] - mesh.vertices[v];
    if (!(across.dot(normals[v]) < 0) || !(across.dot(normals[w]) > 0)) continue;
    double sum = 0;
    bool adjacent = false;
    for (const std::uint32_t corner : stars.corners(v)) {
      const std::uint32_t next = mesh.triangles[corner / 3][(corner + 1) % 3];
      sum += (mesh.vertices[next] - mesh.vertices[v]).norm();
      adjacent = adjacent || next == w;
    }
    const double wanted = options.least_wall * sum / static_cast<double>(stars.corners(v).size());
    if (!adjacent && across.norm() < 2 * wanted) pairs.push_back({v, w, across.norm(), wanted});
  }
  return pairs;
}

template <class Defect>
std::size_t lacking(const std::vector<Defect>& defects) {
  return static_cast<std::size_t>(
      std::count_if(defects.begin(), defects.end(), [](const Defect& d) { return d.lacks(); }));
}

class Opening {
 public:
  Opening(SurfaceMesh& mesh, const MeshAdjacency& adjacency, const std::vector<Wedge>& wedges,
          const std::vector<NearPair>& near, const WedgeOptions& options)
      : mesh_(mesh),
        stars_(adjacency.stars),
        neighbours_(adjacency.neighbours),
        wanted_(3 * mesh.triangles.size(), options.least_dihedral_deg * degree) {
    std::vector<std::uint32_t> faces;
    for (const Wedge& w : wedges) {
      faces.insert(faces.end(), {w.face, w.other});
      wanted_[3 * w.face + w.side] = w.wanted_deg * degree;
      for (std::size_t k = 0; k < 3; ++k)
        if (neighbours_[w.other][k] == w.face) wanted_[3 * w.other + k] = w.wanted_deg * degree;
    }
    for (const NearPair& pair : near) {
      for (const std::uint32_t v : {pair.vertex, pair.other})
        if (pair.lacks())
          for (const std::uint32_t corner : stars_.corners(v)) faces.push_back(corner / 3);
      near_.push_back({pair.vertex, pair.other, pair.wanted});
      near_.push_back({pair.other, pair.vertex, pair.wanted});
    }
    std::sort(near_.begin(), near_.end(),
              [](const Keep& a, const Keep& b) { return std::pair(a.vertex, a.other) < std::pair(b.vertex, b.other); });
    const std::vector<bool> movable = vertices_around(mesh, faces, rings_moved);
    for (std::uint32_t v = 0; v < movable.size(); ++v)
      if (movable[v] && (options.constraints.empty() || options.constraints[v] == VertexConstraint::free))
        moved_.push_back(v);
    for (const std::uint32_t v : moved_) given_.push_back(mesh.vertices[v]);
  }

  void run() {
    for (int sweep = 0; sweep < most_sweeps; ++sweep) {
      double largest = 0;
      for (std::size_t i = 0; i < moved_.size(); ++i) largest = std::max(largest, step(moved_[i], given_[i]));
      if (largest < negligible_step) break;
    }
  }

  const std::vector<std::uint32_t>& moved() const { return moved_; }
  const std::vector<Vec3>& given() const { return given_; }
  const VertexStars& stars() const { return stars_; }

 private:
  // Returns how far it went, over the edge length there.
  double step(std::uint32_t v, const Vec3& given) {
    const Vec3 place = mesh_.vertices[v];
    Vec3 gradient = Vec3::Zero();
    Eigen::Matrix3d hessian = Eigen::Matrix3d::Zero();
    double shortest = std::numeric_limits<double>::infinity(), sum = 0;
    const auto add_lack = [&](std::uint32_t face, std::size_t side, Vec3 Dihedral::*by) {
      if (neighbours_[face][side] == no_face) return;
      const Dihedral d = dihedral_at(mesh_, neighbours_, face, side);
      const double lack = wanted_[3 * face + side] + margin - d.angle;
      if (!(lack > 0)) return;
      gradient -= 2 * weight_of_angle * lack * d.*by;
      hessian += 2 * weight_of_angle * d.*by * (d.*by).transpose();
    };
    const auto corners = stars_.corners(v);
    for (const std::uint32_t corner : corners) {
      const std::uint32_t face = corner / 3;
      const std::size_t k = corner % 3;
      const Triangle& t = mesh_.triangles[face];
      const Vec3 &a = mesh_.vertices[t[(k + 1) % 3]], &b = mesh_.vertices[t[(k + 2) % 3]];
      const Derivatives shape = shape_energy({}, place, a, b);
      gradient += shape.gradient;
      hessian += shape.hessian;
      shortest = std::min({shortest, (a - place).norm(), (b - place).norm()});
      sum += (a - place).norm();
      add_lack(face, k, &Dihedral::by_c);
      add_lack(face, (k + 2) % 3, &Dihedral::by_a);  // from v on; the edge towards v is its neighbour's from v on
    }
    const double edge = sum / static_cast<double>(corners.size());
    for (auto pair = std::lower_bound(near_.begin(), near_.end(), v,
                                      [](const Keep&k, std::uint32_t vertex) { return k.vertex < vertex; });
         pair != near_.end() && pair->vertex == v; ++pair) {
      const Vec3 apart = place - mesh_.vertices[pair->other];
      const double lack = (1 + margin) * pair->distance - apart.norm();
      if (!(lack > 0)) continue;
      const Vec3 direction = apart.normalized();
      gradient -= 2 * weight_of_angle / (edge * edge) * lack * direction;
      hessian += 2 * weight_of_angle / (edge * edge) * direction * direction.transpose();
    }
    gradient += 2 * weight_of_way / (edge * edge) * (place - given);
    hessian.diagonal().array() += 2 * weight_of_way / (edge * edge);
    Vec3 way = -hessian.llt().solve(gradient);
    if (!way.allFinite()) return 0;
    if (const double length = way.norm(); length > longest_step * shortest) way *= longest_step * shortest / length;
    mesh_.vertices[v] += way;
    return way.norm() / edge;
  }

  SurfaceMesh& mesh_;
  const VertexStars& stars_;
  const std::vector<Triangle>& neighbours_;
  std::vector<double> wanted_;  // by face and side, radians
  struct Keep {
    std::uint32_t vertex, other;
    double distance;
  };
  std::vector<Keep> near_;  // both ways, by vertex
  std::vector<std::uint32_t> moved_;
  std::vector<Vec3> given_;
};

double smallest_angle_around(const SurfaceMesh& mesh, std::uint32_t v, const VertexStars& stars) {
  double least = 180;
  for (const std::uint32_t corner : stars.corners(v)) {
    const Triangle& t = mesh.triangles[corner / 3];
    least = std::min(least, smallest_angle_deg(mesh.vertices[t[0]], mesh.vertices[t[1]], mesh.vertices[t[2]]));
  }
  return least;
}

// The moved vertices in groups that share no triangle, so that one that comes to harm goes back without the others.
class MovedGroups {
 public:
  MovedGroups(SurfaceMesh& mesh, const Opening& opening)
      : mesh_(mesh), opening_(opening), group_(mesh.vertices.size()), undone_(mesh.vertices.size(), false) {
    std::vector<bool> is_moved(mesh.vertices.size(), false);
    for (const std::uint32_t v : opening.moved()) is_moved[v] = true;
    UnionFind groups(mesh.vertices.size());
    for (const Triangle& t : mesh.triangles)
      for (std::size_t k = 0; k < 3; ++k)
        if (is_moved[t[k]] && is_moved[t[(k + 1) % 3]]) groups.unite(t[k], t[(k + 1) % 3]);
    for (std::uint32_t v = 0; v < group_.size(); ++v) group_[v] = groups.find(v);
  }

  // Of the triangles around each group.
  std::vector<double> least_angles_deg() const {
    std::vector<double> least(mesh_.vertices.size(), 180);
    for (const std::uint32_t v : opening_.moved())
      least[group_[v]] = std::min(least[group_[v]], smallest_angle_around(mesh_, v, opening_.stars()));
    return least;
  }

  // Those whose least angle fell below the limit, or was below it and fell.
  void undo_narrowed(const std::vector<double>& before, double limit_deg) {
    const std::vector<double> after = least_angles_deg();
    for (const std::uint32_t v : opening_.moved())
      if (const std::uint32_t g = group_[v]; after[g] < std::min(limit_deg, before[g])) undone_[g] = true;
    put_back();
  }

  void undo_crossing() {
    std::vector<std::uint32_t> touched;
    for (const std::uint32_t v : opening_.moved())
      for (const std::uint32_t corner : opening_.stars().corners(v)) touched.push_back(corner / 3);
    std::sort(touched.begin(), touched.end());
    touched.erase(std::unique(touched.begin(), touched.end()), touched.end());
    for (bool clear = false; !clear;) {
      clear = true;
      for (const FacePair& pair : find_self_intersections(mesh_, touched))
        for (const std::uint32_t f : {pair.face, pair.other})
          for (const std::uint32_t v : mesh_.triangles[f]) {
            if (undone_[group_[v]]) continue;
            undone_[group_[v]] = true;
            clear = false;
          }
      put_back();
    }
  }

 private:
  void put_back() {
    for (std::size_t i = 0; i < opening_.moved().size(); ++i)
      if (const std::uint32_t v = opening_.moved()[i]; undone_[group_[v]]) mesh_.vertices[v] = opening_.given()[i];
  }

  SurfaceMesh& mesh_;
  const Opening& opening_;
  std::vector<std::uint32_t> group_;  // of each vertex, known by one of its vertices
  std::vector<bool> undone_;          // by group
};

// An edge whose ends are held is as sharp as it is meant to be.
std::vector<Wedge> find_free_wedges(const SurfaceMesh& mesh, const std::vector<Triangle>& neighbours,
                                    const ReferenceSurface& scan, const WedgeOptions& options) {
  std::vector<Wedge> wedges = find_wedges(mesh, neighbours, scan, options.least_dihedral_deg);
  if (options.constraints.empty()) return wedges;
  const auto is_fixed = [&](const Wedge& w, std::uint32_t k) {
    return options.constraints[mesh.triangles[w.face][(w.side + k) % 3]] == VertexConstraint::fixed;
  };
  std::erase_if(wedges, [&](const Wedge& w) { return is_fixed(w, 1) && is_fixed(w, 2); });
  return wedges;
}

void count_left(const SurfaceMesh& mesh, const std::vector<Triangle>& neighbours, const ReferenceSurface& scan,
                const std::vector<NearPair>& near, const WedgeOptions& options, WedgeResult& result) {
  const std::vector<Wedge> left = find_wedges(mesh, neighbours, scan, options.least_dihedral_deg);
  result.after = lacking(left);
  for (const NearPair& pair : near)
    if ((mesh.vertices[pair.vertex] - mesh.vertices[pair.other]).norm() < pair.wanted) ++result.after;
  for (const Wedge& w : left)
    if (w.lacks()) result.sharpest_deg = std::min(result.sharpest_deg, w.angle_deg);
}

}  // namespace

std::vector<Wedge> find_wedges(const SurfaceMesh& mesh, const std::vector<Triangle>& neighbours,
                               const ReferenceSurface& scan, double least_dihedral_deg) {
  const double limit = least_dihedral_deg * degree;
  std::vector<Wedge> wedges;
  std::vector<Vec3> middles, edges, normals;
  for (std::uint32_t f = 0; f < mesh.triangles.size(); ++f)
    for (std::uint32_t side = 0; side < 3; ++side) {
      const std::uint32_t g = neighbours[f][side];
      if (g == no_face || g < f) continue;
      const double angle = dihedral_at(mesh, neighbours, f, side).angle;
      if (!(angle < limit)) continue;
      wedges.push_back({f, g, side, angle / degree, least_dihedral_deg});
      const Triangle& t = mesh.triangles[f];
      const Vec3 &a = mesh.vertices[t[(side + 1) % 3]], &b = mesh.vertices[t[(side + 2) % 3]];
      middles.push_back((a + b) / 2);
      edges.push_back(b - a);
      normals.push_back(area_vector(mesh, mesh.triangles[f]).normalized() +
                        area_vector(mesh, mesh.triangles[g]).normalized());
    }
  if (wedges.empty()) return wedges;
  const double spacing = std::sqrt(scan.area / static_cast<double>(mesh.triangles.size()));
  const std::vector<std::uint32_t> nearest = nearest_vertices(middles, normals, scan.mesh, spacing);
  for (std::size_t i = 0; i < wedges.size(); ++i)
    if (const auto own = scan_crease(scan, nearest[i], middles[i], edges[i], limit))
      wedges[i].wanted_deg = *own / degree;
  return wedges;
}

WedgeResult open_wedges(SurfaceMesh& mesh, const ReferenceSurface& scan, const WedgeOptions& options) {
  const MeshAdjacency adjacency(mesh);  // vertices move, triangles stay
  const std::vector<Wedge> wedges = find_free_wedges(mesh, adjacency.neighbours, scan, options);
  std::vector<NearPair> near = find_near_pairs(mesh, adjacency.stars, options);
  // Where many are near, the body is a thin wall, and must be.
  if (static_cast<double>(lacking(near)) > most_near * static_cast<double>(mesh.vertices.size())) near.clear();
  WedgeResult result;
  result.before = result.after = lacking(wedges) + lacking(near);
  if (result.before == 0) return result;

  const SurfaceMesh whole = mesh;
  Opening opening(mesh, adjacency, wedges, near, options);
  MovedGroups groups(mesh, opening);
  const std::vector<double> least_before = groups.least_angles_deg();
  opening.run();
  groups.undo_narrowed(least_before, options.least_angle_deg);
  groups.undo_crossing();
  if (mesh.vertices != whole.vertices && options.keep_volume) {
    preserve_volume(mesh, scan.whole, options.constraints);
    if (!find_self_intersections(mesh).empty()) mesh = whole;
  }
  count_left(mesh, adjacency.neighbours, scan, near, options, result);
  return result;
}

}  // namespace scan2fea
