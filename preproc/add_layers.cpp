#include "preproc/add_layers.hpp"

#include "preproc/layers/column_heights.hpp"
#include "preproc/layers/join_layers.hpp"
#include "preproc/layers/layer_columns.hpp"
#include "preproc/layers/layer_defects.hpp"
#include "preproc/layers/layer_directions.hpp"
#include "preproc/layers/make_room.hpp"
#include "preproc/mesh/error.hpp"
#include "preproc/mesh/error_text.hpp"
#include "preproc/mesh/numbers.hpp"
#include "preproc/surface/fit/preserve_volume.hpp"
#include "preproc/surface/kernel/adjacency.hpp"
#include "preproc/surface/simplification/surface_on_scan.hpp"
#include "preproc/surface/simplification/vertices_beyond.hpp"
#include "preproc/volume/two_sided_elements.hpp"
#include "preproc/ways_on_scan.hpp"
#include "preproc/weak_places.hpp"
#include "quality/deviation_bound.hpp"
#include "quality/tetrahedron_measures.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <utility>

namespace scan2fea {
namespace {

using Vertices = std::vector<std::uint32_t>;

[[noreturn]] void refuse(std::string what, const Vec3& at, std::string value, std::string advice) {
  throw NotMeshable({.what = std::move(what),
                     .where = {},
                     .value = std::move(value),
                     .limit = {},
                     .advice = std::move(advice),
                     .at = at});
}

std::vector<bool> mask_of(const LayeredTriangles& layered) {
  std::vector<bool> mask(layered.of_triangle.size());
  for (std::size_t f = 0; f < mask.size(); ++f) mask[f] = layered.of_triangle[f] != no_layers;
  return mask;
}

class LayerMaker {
 public:
  LayerMaker(const LayeredTriangles& layered, const PlanesOfScan& planes, bool is_to_be_curved,
             const FilledSurface& made)
      : layered_(layered),
        is_to_be_curved_(is_to_be_curved),
        mask_(mask_of(layered)),
        surface_(made.surface),
        min_dihedral_before_deg_(measure_tetrahedra(made.filled.mesh).min_dihedral_deg),
        lines_(made.simplified.line_edges),
        scan_(*made.simplified.on_scan->scan),
        stars_(surface_),
        neighbours_(face_neighbours(surface_, stars_)),
        directions_(layer_directions(surface_, stars_, neighbours_, mask_)),
        heights_(surface_, TriangleTree(surface_), stars_, layered, directions_,
                 is_to_be_curved ? flattest_curved : flattest_straight),
        ways_(ways_on_scan(surface_, made.simplified.on_scan->net, scan_.reference(), planes, infinity)),
        layers_of_(surface_.vertices.size(), no_layers),
        outer_(surface_),
        columns_(surface_.vertices.size()) {
    take_layers();
  }

  // `kept`: a deviation that the straight surface has, and is to keep, or null; then layers are lower where it would be
  // lost for want of room beside them.
  LayeredMesh make(const TetrahedralizeOptions& options, const double* kept, const Progress& progress) {
    constexpr int most_trials = 4;
    for (int trial = 1;; ++trial) {
      TetMesh core = filled(options, progress);
      if (is_to_be_curved_) result_.parted_elements = part_two_sided_elements(core, surface_.vertices.size(), lines_);
      LayeredMesh made = join_layers(outer_, layered_, columns_, core, lines_);
      if (is_to_be_curved_) return made;
      keep_volume(made);
      if (kept == nullptr) return made;
      const DeviationBound bound = bound_deviation(made.surface, scan_.deviation_reference(), {.limit = *kept});
      result_.deviation = bound.upper();
      if (bound.holds(*kept) || trial == most_trials) return made;
      std::vector<Vertices> groups;
      for (const std::uint32_t v : vertices_beyond(made.surface, bound, *kept))
        if (v < surface_.vertices.size()) groups.push_back(with_columns_near({v}));
      if (!heights_.lower_at(groups)) return made;
    }
  }

  LayersResult result() const;

 private:
  static constexpr int most_rounds = 24;

  // What lies behind the layers, which are made lower where they leave it too little room for good elements.
  TetMesh filled(TetrahedralizeOptions options, const Progress& progress) {
    constexpr int most_trials = 4;
    options.split_boundary = false;
    for (int trial = 1;; ++trial) {
      make_columns();
      TetMesh core = tetrahedralize(inner(), options, progress).mesh;
      if (trial == most_trials) return core;
      const std::vector<Vertices> poor = find_poor(core);
      if (poor.empty() || !progress.may_improve() || !heights_.lower_at(poor)) return core;
    }
  }

  // Those of a vertex are of all of its triangles: a column has one number of nodes.
  void take_layers() {
    for (std::size_t f = 0; f < mask_.size(); ++f) {
      if (!mask_[f]) continue;
      const std::uint32_t layers = layered_.of_triangle[f];
      for (const std::uint32_t v : surface_.triangles[f]) {
        if (layers_of_[v] != no_layers && layers_of_[v] != layers)
          refuse("layers of different heights meet", surface_.vertices[v], {}, "the same layers for both sets");
        layers_of_[v] = layers;
      }
    }
  }

  void make_columns() {
    for (int round = 0;; ++round) {
      place_columns();
      if (columns_.nodes.empty()) refuse_all(surface_.triangles[first_layered()].front());
      const std::vector<Vertices> bad = find_bad();
      const Vertices flat =
          bad.empty() ? find_flat_layers(outer_, layered_, columns_, least_dihedral_deg()) : Vertices();
      if (bad.empty() && flat.empty()) return;
      if (!flat.empty())
        heights_.drop(flat);
      else if (round == most_rounds || !heights_.lower_at(bad))
        refuse_all(bad.front().empty() ? surface_.triangles[first_layered()].front() : bad.front().front());
    }
  }

  std::size_t first_layered() const { return static_cast<std::size_t>(std::ranges::find(mask_, true) - mask_.begin()); }

  // Of straight elements: curved ones may lose half of theirs. Lower layers would have less.
  double least_dihedral_deg() const {
    return unusable_angle_deg * (is_to_be_curved_ ? flattest_curved / flattest_straight : 1);
  }

  [[noreturn]] void refuse_all(std::uint32_t at) const {
    refuse("there is no room for layers", surface_.vertices[at], {},
           "lower layers, or smaller triangles (--faces, --edge-length)");
  }

  void place_columns() {
    std::vector<bool> is_layered(surface_.vertices.size());
    std::vector<Vec3> pushed(surface_.vertices.size(), Vec3::Zero());
    for (std::uint32_t v = 0; v < is_layered.size(); ++v) {
      is_layered[v] = layers_of_[v] != no_layers;
      if (directions_.is_beside[v]) pushed[v] = heights_.at(v) * directions_.inwards[v];
    }
    outer_.vertices = make_room(surface_, stars_, is_layered, pushed, lines_, ways_);
    columns_ = LayerColumns(surface_.vertices.size());
    for (std::uint32_t v = 0; v < is_layered.size(); ++v) {
      if (!is_layered[v] || !heights_.has_layers(v)) continue;
      const LayerHeights& layers = layered_.heights[layers_of_[v]];
      columns_.first[v] = static_cast<std::uint32_t>(columns_.nodes.size());
      columns_.count[v] = static_cast<std::uint32_t>(layers.count);
      for (int k = 1; k <= layers.count; ++k) {
        const Vec3 node = surface_.vertices[v] + layers.share(k) * heights_.at(v) * directions_.inwards[v];
        columns_.nodes.push_back(directions_.is_beside[v] ? on_scan_beside(v, node) : node);
      }
    }
  }

  // On the face or the line that the column of v runs along, by a vertex that is on it.
  Vec3 on_scan_beside(std::uint32_t v, const Vec3& node) const {
    constexpr double most_off_line = 0.5;  // radians
    std::optional<std::uint32_t> on_line, on_face;
    for (const std::uint32_t corner : stars_.corners(v)) {
      if (mask_[corner / 3]) continue;
      for (const std::uint32_t w : surface_.triangles[corner / 3]) {
        if (w == v || layers_of_[w] != no_layers) continue;
        const std::optional<WayPoint> way = ways_(w, surface_.vertices[w]);
        if (!way) continue;
        if (!way->is_on_line) on_face = w;
        const Vec3 to = (surface_.vertices[w] - surface_.vertices[v]).normalized();
        const bool is_along = to.dot(directions_.inwards[v].normalized()) > std::cos(most_off_line);
        if (way->is_on_line && is_along && std::ranges::binary_search(lines_, feature_edge(v, w))) on_line = w;
      }
    }
    const std::optional<std::uint32_t> guide = on_line ? on_line : is_on_crease_beside(v) ? std::nullopt : on_face;
    if (!guide) return node;
    // What bends away from the way is as far from the layered faces a little farther on.
    constexpr int steps = 3;
    const Vec3& from = surface_.vertices[v];
    const Vec3 outwards = outwards_of_layers(v);
    Vec3 place = node, wanted = node;
    for (int step = 0; step < steps; ++step) {
      const std::optional<WayPoint> way = ways_(*guide, wanted);
      if (!way) return place;
      place = way->place;
      const double depth = outwards.dot(from - place);
      if (!(depth > 0)) return place;
      wanted = from + outwards.dot(from - node) / depth * (wanted - from);
    }
    return place;
  }

  Vec3 outwards_of_layers(std::uint32_t v) const {
    Vec3 sum = Vec3::Zero();
    for (const std::uint32_t corner : stars_.corners(v))
      if (mask_[corner / 3]) sum += area_vector(surface_, surface_.triangles[corner / 3]);
    return sum.normalized();
  }

  // Whether two faces beside the layers meet at v, so that the column runs along their edge.
  bool is_on_crease_beside(std::uint32_t v) const {
    return std::ranges::any_of(stars_.corners(v), [&](std::uint32_t corner) {
      const std::uint32_t f = corner / 3;
      if (mask_[f]) return false;
      return std::ranges::any_of(std::array{1U, 2U}, [&](std::uint32_t k) {
        const std::uint32_t w = surface_.triangles[f][(corner % 3 + k) % 3];
        const std::uint32_t g = neighbours_[f][(corner % 3 + 3 - k) % 3];
        return g != no_face && !mask_[g] && std::ranges::binary_search(lines_, feature_edge(v, w));
      });
    });
  }

  // What the layers leave.
  SurfaceMesh inner() const {
    SurfaceMesh mesh = outer_;
    for (std::uint32_t v = 0; v < mesh.vertices.size(); ++v)
      if (columns_.count[v] > 0) mesh.vertices[v] = columns_.nodes[columns_.first[v] + columns_.count[v] - 1];
    return mesh;
  }

  std::vector<Vertices> find_bad() const;
  std::vector<Vertices> find_poor(const TetMesh& core) const;
  Vertices with_columns_near(const Vertices& vertices) const;
  void keep_volume(LayeredMesh& made);
  void shift_to_volume(LayeredMesh& made) const;

  const LayeredTriangles& layered_;
  const bool is_to_be_curved_;
  const std::vector<bool> mask_;
  const SurfaceMesh& surface_;
  const double min_dihedral_before_deg_;
  const std::vector<FeatureEdge>& lines_;
  const PreparedScan& scan_;
  const VertexStars stars_;
  const std::vector<Triangle> neighbours_;
  const LayerDirections directions_;
  ColumnHeights heights_;
  const BoundaryWays ways_;
  std::vector<std::uint32_t> layers_of_;  // each vertex
  SurfaceMesh outer_;                     // the surface with what has made room
  LayerColumns columns_;
  LayersResult result_;
};

// The vertices of each triangle behind or beside which layers are too high; of those without columns, others near by.
std::vector<Vertices> LayerMaker::find_bad() const {
  const std::vector<bool> bad = find_high_columns(surface_, outer_, inner(), layered_, columns_);
  std::vector<Vertices> groups;
  for (std::size_t f = 0; f < bad.size(); ++f)
    if (const Triangle& t = surface_.triangles[f]; bad[f]) groups.push_back(with_columns_near({t.begin(), t.end()}));
  return groups;
}

// Around elements that are poorer than those that were there without layers.
std::vector<Vertices> LayerMaker::find_poor(const TetMesh& core) const {
  const double least = std::min(small_angle_deg, min_dihedral_before_deg_ / 2);
  std::vector<Vertices> groups;
  for (std::size_t e = 0; e < core.tetrahedra.size(); ++e) {
    if (measure_tetrahedron(core, e).min_dihedral_deg >= least) continue;
    Vertices of_surface;
    for (const std::uint32_t v : core.tetrahedra[e])
      if (v < surface_.vertices.size()) of_surface.push_back(v);
    groups.push_back(with_columns_near(of_surface));
  }
  return groups;
}

// Rings around them, until some have columns.
Vertices LayerMaker::with_columns_near(const Vertices& vertices) const {
  std::vector<bool> seen(surface_.vertices.size(), false);
  Vertices front = vertices;
  while (!front.empty()) {
    Vertices found, next;
    for (const std::uint32_t v : front) seen[v] = true;
    for (const std::uint32_t v : front)
      if (heights_.has_layers(v)) found.push_back(v);
    if (!found.empty()) return found;
    for (const std::uint32_t v : front)
      for (const std::uint32_t corner : stars_.corners(v))
        for (const std::uint32_t w : surface_.triangles[corner / 3])
          if (!seen[w]) {
            seen[w] = true;
            next.push_back(w);
          }
    front = std::move(next);
  }
  return {};
}

void LayerMaker::keep_volume(LayeredMesh& made) {
  constexpr double is_equal = 1e-9, is_lost = 1e-6;
  const double wanted = enclosed_volume(scan_.mesh);
  const auto off = [&] { return std::abs(enclosed_volume(made.surface) / wanted - 1); };
  if (off() > is_equal) shift_to_volume(made);
  result_.lost_volume_pct = off() > is_lost ? 100 * off() : 0;
}

// By what is beside the layers, and round: layers and planes stay where they are. Where that cannot be, nothing moves.
void LayerMaker::shift_to_volume(LayeredMesh& made) const {
  VertexConstraints constraints(made.surface.vertices.size(), VertexConstraint::fixed);
  for (std::size_t v = 0; v < surface_.vertices.size(); ++v)
    if (layers_of_[v] == no_layers) constraints[v] = VertexConstraint::free;
  SurfaceMesh shifted = made.surface;
  try {
    if (!preserve_volume_clear(shifted, scan_.mesh, constraints)) return;
  } catch (const NotMeshable&) {
    return;
  }
  TetMesh mesh = made.mesh;
  std::ranges::copy(shifted.vertices, mesh.nodes.begin());
  for (std::size_t e = 0; e < mesh.tetrahedra.size(); ++e)
    if (volume_of(mesh, e) <= 0) return;
  made.mesh.nodes = std::move(mesh.nodes);
  made.surface = std::move(shifted);
}

LayersResult LayerMaker::result() const {
  constexpr double as_asked = 0.99;
  LayersResult result = result_;
  for (const bool is_layered : mask_) result.triangles += is_layered ? 1 : 0;
  for (std::uint32_t v = 0; v < layers_of_.size(); ++v) {
    result.largest_move = std::max(result.largest_move, (outer_.vertices[v] - surface_.vertices[v]).norm());
    if (layers_of_[v] == no_layers) continue;
    ++result.vertices;
    const double share = heights_.at(v) / heights_.asked(v);
    if (share == 0) ++result.tapered_vertices;
    if (heights_.room(v) >= as_asked * heights_.asked(v)) continue;
    ++result.lower_vertices;
    if (share >= result.least_share) continue;
    result.least_share = share;
    result.least_at = surface_.vertices[v];
  }
  return result;
}

}  // namespace

LayersResult add_layers(const LayeredTriangles& layered, const PlanesOfScan& planes,
                        const TetrahedralizeOptions& options, bool is_to_be_curved, FilledSurface& made,
                        const Progress& progress) {
  SimplifyResult& simplified = made.simplified;
  const bool was_kept = !is_to_be_curved && simplified.keeps_deviation();
  LayerMaker maker(layered, planes, is_to_be_curved, made);
  LayeredMesh mesh = maker.make(options, was_kept ? &simplified.aimed_deviation : nullptr, progress);
  LayersResult result = maker.result();
  result.parallel = std::move(mesh.parallel);
  result.tetrahedra = mesh.layer_tetrahedra;
  result.all_tetrahedra = mesh.mesh.tetrahedra.size();
  result.nodes = mesh.mesh.nodes.size();
  if (was_kept) {
    simplified.largest_deviation = result.deviation;
    if (!simplified.keeps_deviation()) result.lost_deviation = result.deviation;
  }
  simplified.line_edges = std::move(mesh.lines);
  made.surface = std::move(mesh.surface);
  made.filled.mesh = std::move(mesh.mesh);
  made.filled.boundary_parent.clear();
  made.flat_tetrahedra = result.tetrahedra;
  return result;
}

}  // namespace scan2fea
