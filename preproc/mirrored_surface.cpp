#include "preproc/mirrored_surface.hpp"

#include "preproc/mesh/error.hpp"
#include "preproc/mesh/error_text.hpp"
#include "preproc/surface/faces/carry_sets.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace scan2fea {
namespace {

using Index = std::uint32_t;

constexpr Index none = ~Index{0};
constexpr double rounding_of_diagonal = 1e-8;

// The two places that each point of the half goes to; the same, where it is on the plane.
struct TwoPlaces {
  TwoPlaces() = default;
  explicit TwoPlaces(std::size_t points) : original(points, none), copy(points, none) {}
  std::vector<Index> original, copy;
};

template <std::size_t n>
std::array<Index, n> renumbered(std::array<Index, n> of, const std::vector<Index>& numbers) {
  for (Index& v : of) v = numbers[v];
  return of;
}

class Mirroring {
 public:
  Mirroring(FilledSurface half, const MirrorFrame& frame) : half_(std::move(half)), frame_(frame) {}

  MirroredSurface run() {
    find_cut();
    MirroredSurface whole;
    whole.made.simplified = half_.simplified;
    surface_places_ = TwoPlaces(half_.surface.vertices.size());
    add_places(half_.surface.vertices, used_, 0, used_.size(), surface_places_, whole.made.surface.vertices);
    mirror_surface(whole.made.surface);
    mirror_lines(whole.made.surface, whole.made.simplified);
    whole.nodes_on_plane = static_cast<std::size_t>(std::count(on_plane_.begin(), on_plane_.end(), true));
    whole.made.filled = half_.filled;
    if (!half_.filled.mesh.tetrahedra.empty()) mirror_volume(whole);
    return whole;
  }

 private:
  bool is_cut(const std::vector<Vec3>& points, const Triangle& t) const {
    return std::ranges::all_of(t, [&](Index v) { return std::abs(points[v].x()) <= rounding_; });
  }

  void find_cut() {
    std::vector<Vec3>& points = half_.surface.vertices;
    rounding_ = rounding_of_diagonal * bounding_box(points).diagonal();
    on_plane_.assign(points.size(), false);
    used_.assign(points.size(), false);
    for (const Triangle& t : half_.surface.triangles) {
      const bool cut = is_cut(points, t);
      for (const Index v : t) (cut ? on_plane_ : used_)[v] = true;
    }
    for (std::size_t v = 0; v < points.size(); ++v) {
      if (on_plane_[v]) points[v].x() = 0;
      if (on_plane_[v] || points[v].x() > 0) continue;
      throw MeshingFailed({.what = "the mesh of the half does not keep to the mirror plane",
                           .where = {},
                           .value = error_text(points[v].x()) + " from it",
                           .limit = "0 or more",
                           .advice = "smaller triangles, or --symmetry off",
                           .at = frame_.from_frame(points[v])});
    }
  }

  // Puts the points that are `wanted` behind those that there are: first the half's, then their copies.
  void add_places(const std::vector<Vec3>& points, const std::vector<bool>& wanted, std::size_t from, std::size_t end,
                  TwoPlaces& to, std::vector<Vec3>& whole) const {
    for (std::size_t v = from; v < end; ++v) {
      if (!wanted[v]) continue;
      to.original[v] = to.copy[v] = static_cast<Index>(whole.size());
      whole.push_back(frame_.from_frame(points[v]));
    }
    for (std::size_t v = from; v < end; ++v) {
      if (!wanted[v] || points[v].x() == 0) continue;
      to.copy[v] = static_cast<Index>(whole.size());
      whole.push_back(frame_.from_frame(MirrorFrame::mirrored(points[v])));
    }
  }

  void mirror_surface(SurfaceMesh& whole) {
    for (const Triangle& t : half_.surface.triangles)
      if (!is_cut(half_.surface.vertices, t)) whole.triangles.push_back(renumbered(t, surface_places_.original));
    for (const Triangle& t : half_.surface.triangles)
      if (!is_cut(half_.surface.vertices, t)) {
        const Triangle copy = renumbered(t, surface_places_.copy);
        whole.triangles.push_back({copy[0], copy[2], copy[1]});
      }
  }

  // Where both sides meet smoothly the cut's border is no line of the whole.
  std::vector<FeatureEdge> smooth_edges_of_cut() const {
    constexpr double smooth_sine = 0.26;  // 15 degrees on each side
    std::vector<FeatureEdge> smooth;
    for (const Triangle& t : half_.surface.triangles) {
      if (is_cut(half_.surface.vertices, t)) continue;
      if (std::abs(area_vector(half_.surface, t).normalized().x()) > smooth_sine) continue;
      for (std::size_t k = 0; k < 3; ++k)
        if (on_plane_[t[k]] && on_plane_[t[(k + 1) % 3]]) smooth.push_back(feature_edge(t[k], t[(k + 1) % 3]));
    }
    std::sort(smooth.begin(), smooth.end());
    return smooth;
  }

  void mirror_lines(const SurfaceMesh& whole, SimplifyResult& simplified) {
    const std::vector<FeatureEdge> dropped = smooth_edges_of_cut();
    std::vector<FeatureEdge> lines;
    for (const FeatureEdge& e : half_.simplified.line_edges) {
      if (std::binary_search(dropped.begin(), dropped.end(), e) || !used_[e[0]] || !used_[e[1]]) continue;
      for (const auto* to : {&surface_places_.original, &surface_places_.copy})
        lines.push_back(feature_edge((*to)[e[0]], (*to)[e[1]]));
    }
    std::sort(lines.begin(), lines.end());
    lines.erase(std::unique(lines.begin(), lines.end()), lines.end());
    simplified.line_edges = std::move(lines);
    simplified.faces_after = whole.triangles.size();
    simplified.features = whole_lines(half_.simplified.features);
    simplified.on_scan.reset();
  }

  // But for those along the plane, which are the cut's.
  FeatureLines whole_lines(const FeatureLines& half) const {
    FeatureLines whole;
    for (const bool copy : {false, true}) {
      const auto first = static_cast<Index>(whole.points.size());
      for (const Vec3& p : half.points) whole.points.push_back(frame_.from_frame(copy ? MirrorFrame::mirrored(p) : p));
      for (const auto& [a, b] : half.segments)
        if (std::max(half.points[a].x(), half.points[b].x()) > rounding_)
          whole.segments.push_back({first + a, first + b});
    }
    return whole;
  }

  void mirror_volume(MirroredSurface& whole) {
    TetMesh& half = half_.filled.mesh;
    TetMesh& mesh = whole.made.filled.mesh;
    std::vector<bool> is_cut_face(half.boundary.size());
    std::vector<bool> on_plane(half.nodes.size(), false);
    for (std::size_t f = 0; f < half.boundary.size(); ++f) {
      is_cut_face[f] = is_cut(half.nodes, boundary_triangle(half, half.boundary[f]));
      if (!is_cut_face[f]) continue;
      for (const Index v : boundary_triangle(half, half.boundary[f])) on_plane[v] = true;
      if (half.order() == 2)
        for (const Index v : boundary_mid_edge_nodes(half, half.boundary[f])) on_plane[v] = true;
    }
    for (std::size_t v = 0; v < on_plane.size(); ++v)
      if (on_plane[v]) half.nodes[v].x() = 0;
    const std::size_t on_surface = half_.surface.vertices.size();
    std::size_t corners = half.nodes.size();
    for (const MidEdgeNodes& edges : half.mid_edge_nodes)
      corners = std::min<std::size_t>(corners, *std::ranges::min_element(edges));
    std::vector<bool> on_outside = used_, others(half.nodes.size(), true);
    on_outside.resize(half.nodes.size(), false);
    for (std::size_t v = 0; v < on_surface; ++v) others[v] = !used_[v];
    mesh.nodes.clear();
    TwoPlaces to(half.nodes.size());
    add_places(half.nodes, on_outside, 0, on_surface, to, mesh.nodes);
    add_places(half.nodes, others, 0, corners, to, mesh.nodes);
    add_places(half.nodes, others, corners, half.nodes.size(), to, mesh.nodes);
    whole.nodes_on_plane = static_cast<std::size_t>(std::count(on_plane.begin(), on_plane.end(), true));
    mirror_elements(half, to, mesh);
    mirror_boundary(half, is_cut_face, whole.made.filled);
  }

  static void mirror_elements(const TetMesh& half, const TwoPlaces& to, TetMesh& mesh) {
    mesh.tetrahedra.clear();
    mesh.mid_edge_nodes.clear();
    for (const Tetrahedron& t : half.tetrahedra) mesh.tetrahedra.push_back(renumbered(t, to.original));
    for (const MidEdgeNodes& m : half.mid_edge_nodes) mesh.mid_edge_nodes.push_back(renumbered(m, to.original));
    // With the first two corners exchanged a mirrored element is positive again: edges 12 23 13 14 24 34 are those of
    // 21 13 23 24 14 34.
    for (const Tetrahedron& t : half.tetrahedra) {
      const Tetrahedron copy = renumbered(t, to.copy);
      mesh.tetrahedra.push_back({copy[1], copy[0], copy[2], copy[3]});
    }
    for (const MidEdgeNodes& m : half.mid_edge_nodes) {
      const MidEdgeNodes copy = renumbered(m, to.copy);
      mesh.mid_edge_nodes.push_back({copy[0], copy[2], copy[1], copy[4], copy[3], copy[5]});
    }
  }

  // Faces 1-2-3, 1-4-2, 2-4-3, 3-4-1: with the first two corners exchanged the last two change places.
  void mirror_boundary(const TetMesh& half, const std::vector<bool>& is_cut_face, TetrahedralizeResult& filled) const {
    constexpr std::array<std::uint8_t, 4> exchanged{0, 1, 3, 2};
    const auto tetrahedra = static_cast<Index>(half.tetrahedra.size());
    std::vector<Index> triangle(half_.surface.triangles.size(), none);
    Index kept = 0;
    for (std::size_t f = 0; f < triangle.size(); ++f)
      if (!is_cut(half_.surface.vertices, half_.surface.triangles[f])) triangle[f] = kept++;
    filled.mesh.boundary.clear();
    filled.boundary_parent.clear();
    for (const bool copy : {false, true})
      for (std::size_t f = 0; f < half.boundary.size(); ++f) {
        if (is_cut_face[f]) continue;
        const BoundaryFace& face = half.boundary[f];
        filled.mesh.boundary.push_back(copy ? BoundaryFace{face.tetrahedron + tetrahedra, exchanged[face.face]} : face);
        if (half_.filled.boundary_parent.empty()) continue;
        filled.boundary_parent.push_back(triangle[half_.filled.boundary_parent[f]] + (copy ? kept : 0));
      }
  }

  FilledSurface half_;
  const MirrorFrame& frame_;
  double rounding_ = 0;
  std::vector<bool> on_plane_, used_;  // per vertex of the half's surface; used: by what is not the cut
  TwoPlaces surface_places_;
};

}  // namespace

std::vector<bool> vertices_of_cut(const SurfaceMesh& surface, const HalfScan& half,
                                  const std::vector<FeatureEdge>& lines) {
  std::vector<std::uint32_t> is_cut(half.mesh.triangles.size(), 0);
  std::fill(is_cut.end() - static_cast<std::ptrdiff_t>(half.cut_faces), is_cut.end(), 1);
  const std::vector<std::uint32_t> carried = carry_labels(half.mesh, is_cut, surface, lines);
  std::vector<bool> of_cut(surface.vertices.size(), false);
  for (std::size_t f = 0; f < carried.size(); ++f)
    if (carried[f] == 1)
      for (const Index v : surface.triangles[f]) of_cut[v] = true;
  return of_cut;
}

MirroredSurface mirrored(FilledSurface half, const MirrorFrame& frame) {
  return Mirroring(std::move(half), frame).run();
}

}  // namespace scan2fea
