#include "preproc/layers/join_layers.hpp"

#include "preproc/mesh/element_faces.hpp"
#include "preproc/mesh/error.hpp"
#include "preproc/mesh/sorted_corners.hpp"

#include <algorithm>
#include <map>
#include <set>
#include <utility>

namespace scan2fea {
namespace {

class LayerJoiner {
 public:
  LayerJoiner(const SurfaceMesh& surface, const LayeredTriangles& layered, const LayerColumns& columns,
              const TetMesh& core)
      : surface_(surface), layered_(layered), columns_(columns), core_(core) {}

  LayeredMesh join(const std::vector<FeatureEdge>& lines) {
    result_.mesh.tetrahedra = layer_elements(surface_, layered_, columns_).tetrahedra;
    result_.layer_tetrahedra = result_.mesh.tetrahedra.size();
    add_core();
    find_faces();
    put_boundary_first();
    take_surface();
    take_lines(lines);
    take_parallel();
    return std::move(result_);
  }

 private:
  void add_core() {
    const auto vertices = static_cast<std::uint32_t>(surface_.vertices.size());
    const auto before_inner = static_cast<std::uint32_t>(vertices + columns_.nodes.size());
    for (const Tetrahedron& t : core_.tetrahedra) {
      Tetrahedron& added = result_.mesh.tetrahedra.emplace_back();
      for (std::size_t k = 0; k < 4; ++k)
        added[k] = t[k] < vertices ? columns_.last(t[k]) : before_inner + t[k] - vertices;
    }
    result_.mesh.nodes = surface_.vertices;
    result_.mesh.nodes.insert(result_.mesh.nodes.end(), columns_.nodes.begin(), columns_.nodes.end());
    result_.mesh.nodes.insert(result_.mesh.nodes.end(), core_.nodes.begin() + vertices, core_.nodes.end());
  }

  // The surface's triangles in their order, then the others by element.
  void find_faces() {
    const std::vector<BoundaryFace> found = find_boundary(result_.mesh.tetrahedra);
    std::map<Triangle, std::size_t> place;
    for (std::size_t f = 0; f < surface_.triangles.size(); ++f) {
      Triangle t = surface_.triangles[f];
      if (layered_.of_triangle[f] == no_layers)
        for (std::uint32_t& v : t) v = columns_.last(v);
      place.emplace(sorted(t), f);
    }
    result_.mesh.boundary.resize(surface_.triangles.size());
    std::size_t of_surface = 0;
    for (const BoundaryFace& face : found) {
      const auto at = place.find(sorted(boundary_triangle(result_.mesh, face)));
      if (at == place.end()) {
        result_.mesh.boundary.push_back(face);
        continue;
      }
      result_.mesh.boundary[at->second] = face;
      ++of_surface;
    }
    if (of_surface == surface_.triangles.size()) return;
    throw MeshingFailed({.what = "layers and the elements behind them do not fit",
                         .where = {},
                         .value = std::to_string(surface_.triangles.size() - of_surface) + " triangles are inside",
                         .limit = {},
                         .advice = "no --layers"});
  }

  void put_boundary_first() {
    TetMesh& mesh = result_.mesh;
    std::vector<bool> is_outside(mesh.nodes.size(), false);
    std::fill_n(is_outside.begin(), surface_.vertices.size(), true);
    for (const BoundaryFace& face : mesh.boundary)
      for (const std::uint32_t v : boundary_triangle(mesh, face)) is_outside[v] = true;
    number_.resize(mesh.nodes.size());
    std::vector<Vec3> nodes;
    for (const bool outside : {true, false})
      for (std::size_t v = 0; v < number_.size(); ++v) {
        if (is_outside[v] != outside) continue;
        number_[v] = static_cast<std::uint32_t>(nodes.size());
        nodes.push_back(mesh.nodes[v]);
        outside_ += outside ? 1 : 0;
      }
    mesh.nodes = std::move(nodes);
    for (Tetrahedron& t : mesh.tetrahedra)
      for (std::uint32_t& v : t) v = number_[v];
  }

  void take_surface() {
    result_.surface.vertices.assign(result_.mesh.nodes.begin(),
                                    result_.mesh.nodes.begin() + static_cast<std::ptrdiff_t>(outside_));
    for (const BoundaryFace& face : result_.mesh.boundary)
      result_.surface.triangles.push_back(boundary_triangle(result_.mesh, face));
  }

  // Edges of layered triangles stay; others begin and end where columns do.
  void take_lines(const std::vector<FeatureEdge>& lines) {
    std::set<FeatureEdge> of_layers, all;
    for (std::size_t f = 0; f < surface_.triangles.size(); ++f)
      for (std::size_t k = 0; k < 3 && layered_.of_triangle[f] != no_layers; ++k)
        of_layers.insert(feature_edge(surface_.triangles[f][k], surface_.triangles[f][(k + 1) % 3]));
    for (const FeatureEdge& edge : lines) {
      if (of_layers.contains(edge)) {
        all.insert(edge);
        continue;
      }
      all.insert(feature_edge(number_[columns_.last(edge[0])], number_[columns_.last(edge[1])]));
      for (const std::uint32_t v : edge)
        for (std::uint32_t k = 0; k < columns_.count[v]; ++k)
          all.insert(feature_edge(number_[columns_.node(v, k)], number_[columns_.node(v, k + 1)]));
    }
    result_.lines.assign(all.begin(), all.end());
  }

  void take_parallel() {
    for (std::size_t f = 0; f < surface_.triangles.size(); ++f)
      for (std::size_t k = 0; k < 3; ++k) {
        const auto [a, b] = feature_edge(surface_.triangles[f][k], surface_.triangles[f][(k + 1) % 3]);
        const auto add = [&](std::uint32_t from, std::uint32_t to) {
          result_.parallel.push_back({feature_edge(number_[from], number_[to]), {a, b}});
        };
        if (layered_.of_triangle[f] == no_layers) {
          add(columns_.last(a), columns_.last(b));
          continue;
        }
        const std::uint32_t layers = std::max(columns_.count[a], columns_.count[b]);
        for (std::uint32_t l = 0; l <= layers; ++l) add(columns_.node(a, l), columns_.node(b, l));
        for (std::uint32_t l = 0; l < layers && columns_.count[b] > 0; ++l)
          add(columns_.node(a, l), columns_.node(b, l + 1));
      }
    std::ranges::sort(result_.parallel);
    result_.parallel.erase(std::ranges::unique(result_.parallel).begin(), result_.parallel.end());
  }

  const SurfaceMesh& surface_;
  const LayeredTriangles& layered_;
  const LayerColumns& columns_;
  const TetMesh& core_;
  std::vector<std::uint32_t> number_;  // of each node, at last
  std::size_t outside_ = 0;
  LayeredMesh result_;
};

}  // namespace

LayeredMesh join_layers(const SurfaceMesh& surface, const LayeredTriangles& layered, const LayerColumns& columns,
                        const TetMesh& core, const std::vector<FeatureEdge>& lines) {
  return LayerJoiner(surface, layered, columns, core).join(lines);
}

}  // namespace scan2fea
