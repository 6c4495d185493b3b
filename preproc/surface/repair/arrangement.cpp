#include "preproc/surface/repair/arrangement.hpp"

#include "preproc/mesh/sorted_corners.hpp"

#include <CGAL/Constrained_Delaunay_triangulation_2.h>
#include <CGAL/Exact_predicates_exact_constructions_kernel.h>
#include <CGAL/Triangulation_face_base_with_info_2.h>
#include <CGAL/Triangulation_vertex_base_with_info_2.h>
#include <CGAL/intersections.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <optional>
#include <set>

namespace scan2fea {
namespace {

using Kernel = CGAL::Exact_predicates_exact_constructions_kernel;
using Point = Kernel::Point_3;
using Index = std::uint32_t;
using Edge = std::pair<Index, Index>;  // ascending

Edge edge_between(Index a, Index b) {
  return std::minmax(a, b);
}

// What crosses one face: vertices on it, and lines between them.
struct Cuts {
  std::set<Index> points;
  std::set<Edge> lines;
};

class Arranging {
 public:
  Arranging(const SurfaceMesh& mesh, double tolerance)
      : mesh_{mesh}, tolerance_(tolerance), exact_(mesh.vertices.size()) {}

  // Nothing where what crosses a face, once moved by the tolerance, crosses anew.
  std::optional<Arrangement> run(std::span<const FacePair> pairs, const Progress& progress) {
    constexpr std::size_t between_looks = 1024;  // a tenth of a second, or a few where many faces cross
    std::size_t done = 0;
    const auto look = [&] {
      if (done++ % between_looks == 0) progress("remove self-intersections", 0);
    };
    know_corners(pairs);
    for (const FacePair& pair : pairs) {
      look();
      if (pair.face != pair.other) cross(pair.face, pair.other);
    }
    for (auto& [face, cuts] : cuts_) {
      look();
      cross_lines(face, cuts);
    }
    share_points_of_edges();

    Arrangement result;
    for (Index f = 0; f < mesh_.triangles.size(); ++f) {
      const auto cuts = cuts_.find(f);
      if (cuts != cuts_.end()) look();
      if (cuts == cuts_.end())
        result.mesh.triangles.push_back(mesh_.triangles[f]);
      else if (!cut_face(f, cuts->second, result.mesh.triangles))
        return {};
      result.face_of.resize(result.mesh.triangles.size(), f);
    }
    result.mesh.vertices = std::move(mesh_.vertices);
    std::sort(overlapping_.begin(), overlapping_.end());
    result.overlapping = std::move(overlapping_);
    return result;
  }

 private:
  using Cell = std::array<std::int64_t, 3>;
  using Point2 = Kernel::Point_2;
  using Segment2 = Kernel::Segment_2;
  using Triangle2 = Kernel::Triangle_2;

  // Corners of the pairs' faces that lie in one place become the first of them.
  void know_corners(std::span<const FacePair> pairs) {
    std::set<Index> corners;
    for (const FacePair& pair : pairs)
      for (const Index f : {pair.face, pair.other})
        corners.insert(mesh_.triangles[f].begin(), mesh_.triangles[f].end());
    std::map<Index, Index> first;
    for (const Index v : corners) {
      const Vec3& p = mesh_.vertices[v];
      exact_[v] = Point(p.x(), p.y(), p.z());
      if (const std::optional<Index> there = vertex_near(p))
        first[v] = *there;
      else
        in_cell_[cell_of(p)].push_back(v);
    }
    for (Triangle& t : mesh_.triangles)
      for (Index& v : t)
        if (const auto at = first.find(v); at != first.end()) v = at->second;
  }

  Cell cell_of(const Vec3& p) const {
    Cell cell;
    for (int k = 0; k < 3; ++k) cell[static_cast<std::size_t>(k)] = std::llround(p[k] / (2 * tolerance_));
    return cell;
  }

  std::optional<Index> vertex_near(const Vec3& p) const {
    const Cell cell = cell_of(p);
    for (std::int64_t i = -1; i <= 1; ++i)
      for (std::int64_t j = -1; j <= 1; ++j)
        for (std::int64_t k = -1; k <= 1; ++k) {
          const auto at = in_cell_.find({cell[0] + i, cell[1] + j, cell[2] + k});
          if (at == in_cell_.end()) continue;
          for (const Index v : at->second)
            if ((mesh_.vertices[v] - p).norm() <= tolerance_) return v;
        }
    return {};
  }

  Index vertex_at(const Point& p) {
    const Vec3 place(CGAL::to_double(p.x()), CGAL::to_double(p.y()), CGAL::to_double(p.z()));
    if (const std::optional<Index> there = vertex_near(place)) return *there;
    const auto v = static_cast<Index>(mesh_.vertices.size());
    exact_.push_back(p);
    mesh_.vertices.push_back(place);
    in_cell_[cell_of(place)].push_back(v);
    return v;
  }

  const Point& exact(Index v) const { return *exact_[v]; }

  Kernel::Triangle_3 triangle(Index face) const {
    const Triangle& t = mesh_.triangles[face];
    return {exact(t[0]), exact(t[1]), exact(t[2])};
  }

  // A face seen along the axis that its normal is nearest to.
  class View {
   public:
    explicit View(const Kernel::Triangle_3& face) : plane_(face.supporting_plane()) {
      const Kernel::Vector_3 normal = plane_.orthogonal_vector();
      for (const int i : {1, 2})
        if (CGAL::abs(normal[i]) > CGAL::abs(normal[axis_])) axis_ = i;
      is_from_below_ = normal[axis_] < 0;
    }
    bool is_from_below() const { return is_from_below_; }
    Point2 flat(const Point& p) const { return {p[(axis_ + 1) % 3], p[(axis_ + 2) % 3]}; }
    Segment2 flat(const Kernel::Segment_3& s) const { return {flat(s.source()), flat(s.target())}; }
    Triangle2 flat(const Kernel::Triangle_3& t) const { return {flat(t[0]), flat(t[1]), flat(t[2])}; }
    Point on_plane(const Point2& p) const {
      const Kernel::FT n[3]{plane_.a(), plane_.b(), plane_.c()};
      const int u = (axis_ + 1) % 3, v = (axis_ + 2) % 3;
      Kernel::FT x[3];
      x[u] = p.x();
      x[v] = p.y();
      x[axis_] = -(n[u] * p.x() + n[v] * p.y() + plane_.d()) / n[axis_];
      return {x[0], x[1], x[2]};
    }

   private:
    Kernel::Plane_3 plane_;
    int axis_ = 0;
    bool is_from_below_ = false;
  };

  void cross(Index f, Index g) {
    const Triangle &of_f = mesh_.triangles[f], &of_g = mesh_.triangles[g];
    if (is_collinear(mesh_.vertices, of_f) || is_collinear(mesh_.vertices, of_g)) return;
    if (sorted(of_f) == sorted(of_g)) {
      overlapping_.insert(overlapping_.end(), {{f, g}, {g, f}});
      return;
    }
    if (lie_in_one_plane(mesh_, f, g, tolerance_)) {
      if (area_vector(mesh_, of_f).squaredNorm() >= area_vector(mesh_, of_g).squaredNorm())
        overlay(f, g);
      else
        overlay(g, f);
      return;
    }
    // Of a surface and its copy nearly all pairs end here: they meet in vertices that are one by now.
    if (!faces_intersect(mesh_.vertices, of_f, of_g)) return;
    const auto common = CGAL::intersection(triangle(f), triangle(g));
    if (!common) return;
    if (const auto* p = boost::get<Point>(&*common)) cut_both(f, g, {*p});
    if (const auto* s = boost::get<Kernel::Segment_3>(&*common)) cut_both(f, g, {s->source(), s->target()});
  }

  // What two faces in one plane, that of the first, have in common.
  void overlay(Index f, Index g) {
    const View view(triangle(f));
    const Triangle2 flat_f = view.flat(triangle(f)), flat_g = view.flat(triangle(g));
    if (flat_g.is_degenerate()) return;
    const auto common = CGAL::intersection(flat_f, flat_g);
    if (!common) return;
    std::vector<Point2> outline;
    if (const auto* p = boost::get<Point2>(&*common)) outline = {*p};
    if (const auto* s = boost::get<Segment2>(&*common)) outline = {s->source(), s->target()};
    if (const auto* t = boost::get<Triangle2>(&*common)) outline = {t->vertex(0), t->vertex(1), t->vertex(2)};
    if (const auto* polygon = boost::get<std::vector<Point2>>(&*common)) outline = *polygon;
    std::vector<Point> corners;
    for (const Point2& p : outline) corners.push_back(view.on_plane(p));
    if (cut_both(f, g, corners) > 2) overlapping_.insert(overlapping_.end(), {{f, g}, {g, f}});
  }

  // Returns how many vertices the outline has.
  std::size_t cut_both(Index f, Index g, const std::vector<Point>& outline) {
    std::vector<Index> vertices;
    for (const Point& p : outline) vertices.push_back(vertex_at(p));
    for (const Index face : {f, g}) {
      cuts_[face].points.insert(vertices.begin(), vertices.end());
      for (std::size_t i = 0; i < vertices.size(); ++i) {
        const Index next = vertices[(i + 1) % vertices.size()];
        if (vertices[i] != next) cuts_[face].lines.insert(edge_between(vertices[i], next));
      }
    }
    return std::set<Index>(vertices.begin(), vertices.end()).size();
  }

  // Vertices where lines on one face cross.
  void cross_lines(Index face, Cuts& cuts) {
    const View view(triangle(face));
    const std::vector<Edge> lines(cuts.lines.begin(), cuts.lines.end());
    std::vector<Segment2> segments;
    std::vector<CGAL::Bbox_2> boxes;
    for (const Edge& line : lines) {
      segments.push_back(view.flat(Kernel::Segment_3(exact(line.first), exact(line.second))));
      boxes.push_back(segments.back().bbox());
    }
    for (std::size_t i = 0; i < lines.size(); ++i)
      for (std::size_t j = i + 1; j < lines.size(); ++j) {
        if (!CGAL::do_overlap(boxes[i], boxes[j])) continue;
        const auto common = CGAL::intersection(segments[i], segments[j]);
        if (!common) continue;
        // Lines that overlap end on one another, and those ends are vertices already.
        if (const auto* p = boost::get<Point2>(&*common)) cuts.points.insert(vertex_at(view.on_plane(*p)));
      }
  }

  bool is_on(Index p, const Edge& edge) const {
    if (p == edge.first || p == edge.second) return false;
    const double at = along(p, edge);
    const Vec3 &a = mesh_.vertices[edge.first], &b = mesh_.vertices[edge.second];
    return at > 0 && at < 1 && (a + at * (b - a) - mesh_.vertices[p]).norm() <= tolerance_;
  }

  double along(Index p, const Edge& edge) const {
    const Vec3& a = mesh_.vertices[edge.first];
    const Vec3 direction = mesh_.vertices[edge.second] - a;
    return (mesh_.vertices[p] - a).dot(direction) / direction.squaredNorm();
  }

  // What ends at an edge of one face ends at that edge of its neighbour.
  void share_points_of_edges() {
    std::map<Edge, std::set<Index>> on_edges;
    for (const auto& [face, cuts] : cuts_)
      for (std::size_t i = 0; i < 3; ++i) {
        const Edge edge = edge_between(mesh_.triangles[face][i], mesh_.triangles[face][(i + 1) % 3]);
        for (const Index p : cuts.points)
          if (is_on(p, edge)) on_edges[edge].insert(p);
      }
    for (Index f = 0; f < mesh_.triangles.size(); ++f)
      for (std::size_t i = 0; i < 3; ++i) {
        const auto at = on_edges.find(edge_between(mesh_.triangles[f][i], mesh_.triangles[f][(i + 1) % 3]));
        if (at == on_edges.end()) continue;
        for (const Index v : mesh_.triangles[f])
          if (!exact_[v]) exact_[v] = Point(mesh_.vertices[v].x(), mesh_.vertices[v].y(), mesh_.vertices[v].z());
        cuts_[f].points.insert(at->second.begin(), at->second.end());
      }
  }

  using VertexBase = CGAL::Triangulation_vertex_base_with_info_2<Index, Kernel>;
  using FaceBase =
      CGAL::Triangulation_face_base_with_info_2<bool, Kernel, CGAL::Constrained_triangulation_face_base_2<Kernel>>;
  using Triangulation =
      CGAL::Constrained_Delaunay_triangulation_2<Kernel, CGAL::Triangulation_data_structure_2<VertexBase, FaceBase>,
                                                 CGAL::No_constraint_intersection_tag>;

  // The lines of a face, its sides included, between neighbouring vertices on them.
  std::set<Edge> constraints(const Triangle& t, const Cuts& cuts) const {
    std::set<Edge> lines(cuts.lines), parts;
    for (std::size_t i = 0; i < 3; ++i) lines.insert(edge_between(t[i], t[(i + 1) % 3]));
    for (const Edge& line : lines) {
      std::vector<Index> row{line.first};
      for (const Index p : cuts.points)
        if (is_on(p, line)) row.push_back(p);
      for (const Index p : t)
        if (is_on(p, line) && !cuts.points.contains(p)) row.push_back(p);
      std::sort(row.begin() + 1, row.end(), [&](Index p, Index q) { return along(p, line) < along(q, line); });
      row.push_back(line.second);
      for (std::size_t i = 0; i + 1 < row.size(); ++i) parts.insert(edge_between(row[i], row[i + 1]));
    }
    return parts;
  }

  // Faces beyond the constraints about the whole, where a side bends inwards by the tolerance.
  static void mark_outside(Triangulation& triangulation) {
    for (const auto face : triangulation.all_face_handles()) face->info() = false;
    std::vector<Triangulation::Face_handle> outside{triangulation.infinite_face()};
    outside[0]->info() = true;
    while (!outside.empty()) {
      const auto face = outside.back();
      outside.pop_back();
      for (int i = 0; i < 3; ++i) {
        const auto next = face->neighbor(i);
        if (next->info() || face->is_constrained(i)) continue;
        next->info() = true;
        outside.push_back(next);
      }
    }
  }

  // By a constrained Delaunay triangulation. A face of no area, beside which others may be cut, stays as it is.
  bool cut_face(Index f, const Cuts& cuts, std::vector<Triangle>& into) const {
    const Triangle& t = mesh_.triangles[f];
    if (is_collinear(mesh_.vertices, t)) {
      into.push_back(t);
      return true;
    }
    const View view(triangle(f));
    Triangulation triangulation;
    std::map<Index, Triangulation::Vertex_handle> handle;
    std::set<Index> points(cuts.points);
    points.insert(t.begin(), t.end());
    for (const Index p : points) {
      handle[p] = triangulation.insert(view.flat(exact(p)));
      handle[p]->info() = p;
    }
    if (triangulation.number_of_vertices() != points.size() || triangulation.dimension() < 2) return false;
    try {
      for (const Edge& edge : constraints(t, cuts))
        triangulation.insert_constraint(handle[edge.first], handle[edge.second]);
    } catch (const Triangulation::Intersection_of_constraints_exception&) {
      return false;
    }
    mark_outside(triangulation);
    for (const auto face : triangulation.finite_face_handles()) {
      if (face->info()) continue;
      Triangle part{face->vertex(0)->info(), face->vertex(1)->info(), face->vertex(2)->info()};
      if (view.is_from_below()) std::swap(part[1], part[2]);
      into.push_back(part);
    }
    return true;
  }

  SurfaceMesh mesh_;
  double tolerance_;
  std::vector<std::optional<Point>> exact_;     // of the vertices of the pairs' faces, and of new ones
  std::map<Cell, std::vector<Index>> in_cell_;  // of those
  std::map<Index, Cuts> cuts_;                  // by face
  std::vector<std::pair<Index, Index>> overlapping_;
};

}  // namespace

bool lie_in_one_plane(const SurfaceMesh& mesh, std::uint32_t face, std::uint32_t other, double tolerance) {
  const auto lies_in_plane_of = [&](const Triangle& s, const Triangle& t) {
    const Vec3 normal = area_vector(mesh, t).normalized();
    return std::all_of(s.begin(), s.end(), [&](std::uint32_t v) {
      return std::abs(normal.dot(mesh.vertices[v] - mesh.vertices[t[0]])) <= tolerance;
    });
  };
  const Triangle &s = mesh.triangles[face], &t = mesh.triangles[other];
  return lies_in_plane_of(s, t) || lies_in_plane_of(t, s);
}

std::optional<Arrangement> arrange(const SurfaceMesh& mesh, std::span<const FacePair> pairs, double tolerance,
                                   const Progress& progress) {
  return Arranging(mesh, tolerance).run(pairs, progress);
}

}  // namespace scan2fea
