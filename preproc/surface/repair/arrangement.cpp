#include "preproc/surface/repair/arrangement.hpp"

#include <CGAL/Constrained_Delaunay_triangulation_2.h>
#include <CGAL/Exact_predicates_exact_constructions_kernel.h>
#include <CGAL/Triangulation_vertex_base_with_info_2.h>
#include <CGAL/intersections.h>

#include <algorithm>
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

Triangle sorted(Triangle t) {
  std::sort(t.begin(), t.end());
  return t;
}

// What crosses one face: vertices on it, and lines between them.
struct Cuts {
  std::set<Index> points;
  std::set<Edge> lines;
};

class Arranging {
 public:
  explicit Arranging(const SurfaceMesh& mesh) : mesh_{mesh}, exact_(mesh.vertices.size()) {}

  Arrangement run(std::span<const FacePair> pairs) {
    for (const FacePair& pair : pairs)
      for (const Index f : {pair.face, pair.other}) know_corners(f);
    for (Triangle& t : mesh_.triangles)
      for (Index& v : t) v = known(v);
    for (const FacePair& pair : pairs)
      if (pair.face != pair.other) cross(pair.face, pair.other);
    for (auto& [face, cuts] : cuts_) cross_lines(cuts);
    share_points_of_edges();

    Arrangement result;
    for (Index f = 0; f < mesh_.triangles.size(); ++f) {
      const auto cuts = cuts_.find(f);
      if (cuts == cuts_.end())
        result.mesh.triangles.push_back(mesh_.triangles[f]);
      else
        cut_face(f, cuts->second, result.mesh.triangles);
      result.face_of.resize(result.mesh.triangles.size(), f);
    }
    result.mesh.vertices = std::move(mesh_.vertices);
    std::sort(overlapping_.begin(), overlapping_.end());
    result.overlapping = std::move(overlapping_);
    return result;
  }

 private:
  void know_corners(Index face) {
    for (const Index v : mesh_.triangles[face]) {
      if (exact_[v]) continue;
      const Vec3& p = mesh_.vertices[v];
      exact_[v] = Point(p.x(), p.y(), p.z());
      const auto [at, is_new] = index_of_.try_emplace(*exact_[v], v);
      if (is_new) continue;
      const Index first = std::min(v, at->second);
      first_[std::max(v, at->second)] = first;
      at->second = first;
    }
  }

  // The first vertex in the same place.
  Index known(Index v) const {
    for (auto at = first_.find(v); at != first_.end(); at = first_.find(v)) v = at->second;
    return v;
  }

  Index vertex_at(const Point& p) {
    const auto [at, is_new] = index_of_.try_emplace(p, static_cast<Index>(mesh_.vertices.size()));
    if (is_new) {
      exact_.push_back(p);
      mesh_.vertices.push_back({CGAL::to_double(p.x()), CGAL::to_double(p.y()), CGAL::to_double(p.z())});
    }
    return at->second;
  }

  const Point& exact(Index v) const { return *exact_[v]; }

  Kernel::Triangle_3 triangle(Index face) const {
    const Triangle& t = mesh_.triangles[face];
    return {exact(t[0]), exact(t[1]), exact(t[2])};
  }

  void cross(Index f, Index g) {
    const Triangle &of_f = mesh_.triangles[f], &of_g = mesh_.triangles[g];
    if (is_collinear(mesh_.vertices, of_f) || is_collinear(mesh_.vertices, of_g)) return;
    if (sorted(of_f) == sorted(of_g)) overlapping_.insert(overlapping_.end(), {{f, g}, {g, f}});
    // Of a surface and its copy nearly all pairs end here: they meet in vertices that are one by now.
    if (sorted(of_f) == sorted(of_g) || !faces_intersect(mesh_.vertices, of_f, of_g)) return;
    const auto common = CGAL::intersection(triangle(f), triangle(g));
    if (!common) return;
    std::vector<Point> outline;
    if (const auto* p = boost::get<Point>(&*common)) outline = {*p};
    if (const auto* s = boost::get<Kernel::Segment_3>(&*common)) outline = {s->source(), s->target()};
    if (const auto* t = boost::get<Kernel::Triangle_3>(&*common)) outline = {t->vertex(0), t->vertex(1), t->vertex(2)};
    if (const auto* polygon = boost::get<std::vector<Point>>(&*common)) outline = *polygon;
    std::vector<Index> vertices;
    for (const Point& p : outline) vertices.push_back(vertex_at(p));
    for (const Index face : {f, g}) {
      cuts_[face].points.insert(vertices.begin(), vertices.end());
      for (std::size_t i = 0; i < vertices.size(); ++i) {
        const Index next = vertices[(i + 1) % vertices.size()];
        if (vertices[i] != next) cuts_[face].lines.insert(edge_between(vertices[i], next));
      }
    }
    if (outline.size() > 2) overlapping_.insert(overlapping_.end(), {{f, g}, {g, f}});
  }

  // Vertices where lines on one face cross.
  void cross_lines(Cuts& cuts) {
    const std::vector<Edge> lines(cuts.lines.begin(), cuts.lines.end());
    std::vector<Kernel::Segment_3> segments;
    std::vector<CGAL::Bbox_3> boxes;
    for (const Edge& line : lines) {
      segments.emplace_back(exact(line.first), exact(line.second));
      boxes.push_back(segments.back().bbox());
    }
    for (std::size_t i = 0; i < lines.size(); ++i)
      for (std::size_t j = i + 1; j < lines.size(); ++j) {
        if (!CGAL::do_overlap(boxes[i], boxes[j])) continue;
        const auto common = CGAL::intersection(segments[i], segments[j]);
        if (!common) continue;
        // Lines that overlap end on one another, and those ends are vertices already.
        if (const auto* p = boost::get<Point>(&*common)) cuts.points.insert(vertex_at(*p));
      }
  }

  bool is_between(Index p, const Edge& edge) const {
    return p != edge.first && p != edge.second &&
           CGAL::collinear_are_strictly_ordered_along_line(exact(edge.first), exact(p), exact(edge.second));
  }

  bool is_on(Index p, const Edge& edge) const {
    const Point &a = exact(edge.first), &b = exact(edge.second);
    return p != edge.first && p != edge.second && CGAL::do_overlap(exact(p).bbox(), Kernel::Segment_3(a, b).bbox()) &&
           CGAL::collinear(a, exact(p), b) && is_between(p, edge);
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

  // By a constrained Delaunay triangulation of the face, seen along the axis that its normal is nearest to.
  void cut_face(Index f, const Cuts& cuts, std::vector<Triangle>& into) const {
    using VertexBase = CGAL::Triangulation_vertex_base_with_info_2<Index, Kernel>;
    using Structure =
        CGAL::Triangulation_data_structure_2<VertexBase, CGAL::Constrained_triangulation_face_base_2<Kernel>>;
    using Triangulation =
        CGAL::Constrained_Delaunay_triangulation_2<Kernel, Structure, CGAL::No_constraint_intersection_tag>;
    const Triangle& t = mesh_.triangles[f];
    const Kernel::Vector_3 normal = CGAL::normal(exact(t[0]), exact(t[1]), exact(t[2]));
    int axis = 0;
    for (const int i : {1, 2})
      if (CGAL::abs(normal[i]) > CGAL::abs(normal[axis])) axis = i;
    const int u = (axis + 1) % 3, v = (axis + 2) % 3;

    Triangulation triangulation;
    std::map<Index, Triangulation::Vertex_handle> handle;
    std::set<Index> points(cuts.points);
    points.insert(t.begin(), t.end());
    for (const Index p : points) {
      handle[p] = triangulation.insert(Kernel::Point_2(exact(p)[u], exact(p)[v]));
      handle[p]->info() = p;
    }
    std::set<Edge> lines(cuts.lines);
    for (std::size_t i = 0; i < 3; ++i) lines.insert(edge_between(t[i], t[(i + 1) % 3]));
    std::set<Edge> constraints;  // each once, where lines overlap
    for (const Edge& line : lines) {
      std::vector<Index> row{line.first};
      for (const Index p : points)
        if (is_on(p, line)) row.push_back(p);
      row.push_back(line.second);
      const Point& start = exact(line.first);
      std::sort(row.begin(), row.end(),
                [&](Index a, Index b) { return CGAL::has_smaller_distance_to_point(start, exact(a), exact(b)); });
      for (std::size_t i = 0; i + 1 < row.size(); ++i) constraints.insert(edge_between(row[i], row[i + 1]));
    }
    for (const Edge& edge : constraints) triangulation.insert_constraint(handle[edge.first], handle[edge.second]);
    for (const auto face : triangulation.finite_face_handles()) {
      Triangle part{face->vertex(0)->info(), face->vertex(1)->info(), face->vertex(2)->info()};
      if (normal[axis] < 0) std::swap(part[1], part[2]);
      into.push_back(part);
    }
  }

  SurfaceMesh mesh_;
  std::vector<std::optional<Point>> exact_;  // of the vertices of the pairs' faces, and of new ones
  std::map<Point, Index> index_of_;          // of those
  std::map<Index, Index> first_;             // of vertices in the same place as an earlier one
  std::map<Index, Cuts> cuts_;               // by face
  std::vector<std::pair<Index, Index>> overlapping_;
};

}  // namespace

Arrangement arrange(const SurfaceMesh& mesh, std::span<const FacePair> pairs) {
  return Arranging(mesh).run(pairs);
}

}  // namespace scan2fea
