#include "preproc/surface/faces/select_sets.hpp"

#include "preproc/mesh/error.hpp"
#include "preproc/mesh/error_text.hpp"
#include "preproc/surface/faces/face_choice.hpp"
#include "preproc/surface/kernel/adjacency.hpp"
#include "preproc/surface/sizing/split_long_edges.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>

namespace scan2fea {
namespace {

using Index = std::uint32_t;
using Kind = Selection::Kind;

// Of an edge: a cut nearer to its end goes through the end.
constexpr double merged_share = 0.05;
// Of the diagonal: longer edges are halved before places are looked for.
constexpr double longest_edge = 1.0 / 60;
constexpr int bisections = 40;
// Rounds in which normals of free-form faces are averaged with those around, against noise.
constexpr int rounds_of_smoothing = 2;

bool asks_for_faces(const Selection& s, std::span<const NamedSet> given) {
  if (s.kind == Kind::name) return find_set(given, s.text) == given.size();
  if (s.kind == Kind::shape || s.kind == Kind::largest || s.kind == Kind::nearest || s.kind == Kind::normal)
    return true;
  return std::any_of(s.operands.begin(), s.operands.end(),
                     [&](const Selection& operand) { return asks_for_faces(operand, given); });
}

bool asks_for_normals(const Selection& s) {
  return s.kind == Kind::normal ||
         (s.kind != Kind::largest && std::any_of(s.operands.begin(), s.operands.end(), asks_for_normals));
}

// Where a point of the scan is.
struct Spot {
  Index triangle;
  Vec3 point;
  Vec3 normal;
};

// The scan with what is known of its triangles, growing finer.
class Scan {
 public:
  Scan(SurfaceMesh scan, SurfaceFaces known_faces, std::span<const NamedSet> given, bool with_normals)
      : mesh(std::move(scan)), faces(std::move(known_faces)), given_(given), origin(mesh.triangles.size()) {
    for (Index f = 0; f < origin.size(); ++f) origin[f] = f;
    if (with_normals) smooth_normals();
  }

  // Splits each of the edges, at most once.
  void split(const std::vector<EdgeSplit>& splits) {
    if (splits.empty()) return;
    std::vector<FeatureEdge> edges;
    for (const EdgeSplit& s : splits) edges.push_back(s.edge);
    std::sort(edges.begin(), edges.end());
    const std::size_t before = mesh.triangles.size();
    for (Index f = 0; f < before; ++f)
      for (std::size_t k = 0; k < 3; ++k)
        if (std::binary_search(edges.begin(), edges.end(),
                               feature_edge(mesh.triangles[f][k], mesh.triangles[f][(k + 1) % 3])))
          origin.push_back(origin[f]);
    for (const EdgeSplit& s : splits)
      if (!normals_.empty())
        normals_.push_back(((1 - s.part) * normals_[s.edge[0]] + s.part * normals_[s.edge[1]]).normalized());
    std::vector<double> no_lengths(mesh.vertices.size(), 0);
    std::vector<FeatureEdge> no_features;
    split_edges(mesh, no_lengths, no_features, splits);
    if (faces.list.empty()) return;
    for (auto f = static_cast<Index>(faces.of_triangle.size()); f < mesh.triangles.size(); ++f) {
      faces.of_triangle.push_back(faces.of_triangle[origin[f]]);
      faces.list[faces.of_triangle[f]].triangles.push_back(f);
    }
  }

  void halve_long_edges() {
    const double longest = longest_edge * bounding_box(mesh.vertices).diagonal();
    constexpr int most_rounds = 12;
    for (int round = 0; round < most_rounds; ++round) {
      std::vector<EdgeSplit> splits;
      for (const Triangle& t : mesh.triangles)
        for (std::size_t k = 0; k < 3; ++k)
          if ((mesh.vertices[t[k]] - mesh.vertices[t[(k + 1) % 3]]).norm() > longest)
            splits.push_back({feature_edge(t[k], t[(k + 1) % 3]), 0.5});
      const auto less = [](const EdgeSplit& a, const EdgeSplit& b) { return a.edge < b.edge; };
      std::sort(splits.begin(), splits.end(), less);
      splits.erase(std::unique(splits.begin(), splits.end(),
                               [](const EdgeSplit& a, const EdgeSplit& b) { return a.edge == b.edge; }),
                   splits.end());
      if (splits.empty()) break;
      split(splits);
    }
  }

  Spot corner(Index f, Index vertex) const { return {f, mesh.vertices[vertex], normal(vertex)}; }
  Spot between(const Spot& a, const Spot& b, double part) const {
    return {a.triangle, (1 - part) * a.point + part * b.point, (1 - part) * a.normal + part * b.normal};
  }
  Spot centre(Index f) const {
    const Triangle& t = mesh.triangles[f];
    return {f, centroid(mesh, t), (normal(t[0]) + normal(t[1]) + normal(t[2])) / 3};
  }
  // What the surface faces there: on a face of known shape, its shape's normal.
  Vec3 facing(const Spot& spot) const {
    const SurfaceFace& face = faces.list[faces.of_triangle[spot.triangle]];
    return face.shape ? face.shape->normal(spot.point) : Vec3(spot.normal.normalized());
  }
  std::span<const NamedSet> given() const { return given_; }

  SurfaceMesh mesh;
  SurfaceFaces faces;

 private:
  Vec3 normal(Index vertex) const { return normals_.empty() ? Vec3::Zero() : normals_[vertex]; }

  void smooth_normals() {
    normals_ = vertex_normals(mesh);
    for (int round = 0; round < rounds_of_smoothing; ++round) {
      std::vector<Vec3> sum = normals_;
      for (const Triangle& t : mesh.triangles)
        for (const Index v : t)
          for (const Index w : t) sum[v] += normals_[w];
      for (std::size_t v = 0; v < sum.size(); ++v) normals_[v] = sum[v].normalized();
    }
  }

  std::span<const NamedSet> given_;
  std::vector<Vec3> normals_;

 public:
  std::vector<Index> origin;  // per triangle that of the scan that it is a part of
};

// An expression made ready to be asked of places.
class Selector {
 public:
  Selector(const Selection& selection, const Scan& scan) : selection_(selection), scan_(scan) {
    switch (selection.kind) {
      case Kind::name:
        if (const std::size_t set = find_set(scan.given(), selection.text); set < scan.given().size()) {
          of_triangle_ = &scan.given()[set].members;
          break;
        }
        [[fallthrough]];
      case Kind::shape:
      case Kind::largest:
      case Kind::nearest:
        chosen_ = chosen_faces(scan.mesh, scan.faces, selection);
        break;
      default:
        for (const Selection& operand : selection.operands) operands_.emplace_back(operand, scan);
    }
  }

  bool holds(const Spot& spot) const {
    const Selection& s = selection_;
    const Vec3& p = spot.point;
    switch (s.kind) {
      case Kind::half_space: {
        const Limit& limit = s.limits.front();
        const double value = p[limit.of == Limit::Of::x ? 0 : limit.of == Limit::Of::y ? 1 : 2];
        return limit.above ? value >= limit.value : value <= limit.value;
      }
      case Kind::box:
        return (p.array() >= s.low.array()).all() && (p.array() <= s.high.array()).all();
      case Kind::ball:
        return (p - s.low).squaredNorm() <= s.radius * s.radius;
      case Kind::normal:
        return scan_.facing(spot).dot(s.facing->vector) >= std::cos(s.facing->within_deg * std::numbers::pi / 180);
      case Kind::both:
        return std::all_of(operands_.begin(), operands_.end(), [&](const Selector& o) { return o.holds(spot); });
      case Kind::either:
        return std::any_of(operands_.begin(), operands_.end(), [&](const Selector& o) { return o.holds(spot); });
      case Kind::inverse:
        return !operands_.front().holds(spot);
      default:
        if (of_triangle_ != nullptr)
          return std::binary_search(of_triangle_->begin(), of_triangle_->end(), scan_.origin[spot.triangle]);
        return chosen_[scan_.faces.of_triangle[spot.triangle]];
    }
  }

  const std::vector<Selector>& operands() const { return operands_; }
  const Selection& selection() const { return selection_; }

 private:
  const Selection& selection_;
  const Scan& scan_;
  const std::vector<Index>* of_triangle_ = nullptr;
  std::vector<bool> chosen_;
  std::vector<Selector> operands_;
};

// Where the border of what is selected crosses edges.
std::vector<EdgeSplit> crossings(const Scan& scan, const Selector& selector) {
  std::map<FeatureEdge, double> found;
  for (Index f = 0; f < scan.mesh.triangles.size(); ++f) {
    const Triangle& t = scan.mesh.triangles[f];
    for (std::size_t k = 0; k < 3; ++k) {
      const FeatureEdge edge = feature_edge(t[k], t[(k + 1) % 3]);
      const Spot a = scan.corner(f, edge[0]), b = scan.corner(f, edge[1]);
      const bool at_a = selector.holds(a);
      if (at_a == selector.holds(b)) continue;
      double low = 0, high = 1;
      for (int i = 0; i < bisections; ++i) {
        const double middle = (low + high) / 2;
        (selector.holds(scan.between(a, b, middle)) == at_a ? low : high) = middle;
      }
      if (low < merged_share || low > 1 - merged_share) continue;
      found.try_emplace(edge, low);
    }
  }
  std::vector<EdgeSplit> splits;
  for (const auto& [edge, part] : found) splits.push_back({edge, part});
  return splits;
}

NamedSet members(const Scan& scan, const Selector& selector, std::string name) {
  NamedSet set{std::move(name), {}};
  for (Index f = 0; f < scan.mesh.triangles.size(); ++f)
    if (selector.holds(scan.centre(f))) set.members.push_back(f);
  return set;
}

// Noise makes a surface larger: on a face of known shape it is the area of facets with their corners on the shape.
double area_of(const Scan& scan, const NamedSet& set) {
  double area = 0;
  for (const Index f : set.members) {
    const auto& [a, b, c] = scan.mesh.triangles[f];
    std::array<Vec3, 3> p{scan.mesh.vertices[a], scan.mesh.vertices[b], scan.mesh.vertices[c]};
    if (!scan.faces.list.empty())
      if (const auto& shape = scan.faces.list[scan.faces.of_triangle[f]].shape)
        for (Vec3& x : p) x = shape->foot(x);
    area += (p[1] - p[0]).cross(p[2] - p[0]).norm() / 2;
  }
  return area;
}

std::string nearest_to(const Scan& scan, const Selection& selection) {
  const BoundingBox box = bounding_box(scan.mesh.vertices);
  std::string text = "the scan lies in " + error_text(box.low) + " to " + error_text(box.high);
  if (selection.kind != Kind::box && selection.kind != Kind::ball) return text;
  const Vec3 middle = selection.kind == Kind::box ? Vec3((selection.low + selection.high) / 2) : selection.low;
  Vec3 nearest = scan.mesh.vertices[scan.mesh.triangles[0][0]];
  for (const Triangle& t : scan.mesh.triangles)
    for (const Index v : t)
      if ((scan.mesh.vertices[v] - middle).norm() < (nearest - middle).norm()) nearest = scan.mesh.vertices[v];
  return text + ", nearest at " + error_text(nearest);
}

// What a part of an expression that selects nothing is near to; where all parts select something, how much each does.
void explain(const Scan& scan, const Selector& selector, std::string& text) {
  const Selection& s = selector.selection();
  if (!selector.operands().empty()) {
    for (const Selector& operand : selector.operands()) explain(scan, operand, text);
    return;
  }
  const double area = area_of(scan, members(scan, selector, {}));
  text += (text.empty() ? "" : "; ") + s.text + " alone is of area " + error_text(area, 4);
  if (area == 0) text += " (" + nearest_to(scan, s) + ")";
}

void require_some(const Scan& scan, const Selector& selector, const NamedSet& set) {
  if (!set.members.empty()) return;
  std::string near;
  explain(scan, selector, near);
  throw WrongUsage({.what = "the selection is of nothing",
                    .where = "--set " + set.name + "=" + selector.selection().text,
                    .value = {},
                    .limit = {},
                    .advice = near});
}

}  // namespace

SelectedScan select_sets(SurfaceMesh mesh, std::span<const NamedSelection> selections, std::span<const NamedSet> given,
                         const FeatureOptions& features, const Progress& progress,
                         std::optional<SurfaceFaces> known_faces) {
  const auto any = [&](const auto& asks) {
    return std::any_of(selections.begin(), selections.end(),
                       [&](const NamedSelection& s) { return asks(s.selection); });
  };
  SurfaceFaces faces;
  if (known_faces)
    faces = std::move(*known_faces);
  else if (any([&](const Selection& s) { return asks_for_faces(s, given); }))
    faces = find_faces(mesh, features, progress);
  Scan scan(std::move(mesh), std::move(faces), given, any(asks_for_normals));
  const auto is_of_places = [](const Selection& s) { return !s.is_of_whole_faces(); };
  if (any(is_of_places)) scan.halve_long_edges();
  std::vector<Selector> selectors;
  for (const auto& [name, selection] : selections) {
    selectors.emplace_back(selection, scan);
    if (is_of_places(selection)) scan.split(crossings(scan, selectors.back()));
  }
  SelectedScan result;
  std::vector<std::vector<Index>> in_sets(scan.mesh.triangles.size());
  for (Index s = 0; s < selections.size(); ++s) {
    NamedSet set = members(scan, selectors[s], selections[s].name);
    require_some(scan, selectors[s], set);
    for (const Index f : set.members) in_sets[f].push_back(s);
    result.areas.push_back(area_of(scan, set));
    result.sets.push_back(std::move(set));
  }
  std::map<std::vector<Index>, Index> numbers;
  for (const std::vector<Index>& sets : in_sets)
    result.of_triangle.push_back(numbers.try_emplace(sets, static_cast<Index>(numbers.size())).first->second);
  result.mesh = std::move(scan.mesh);
  result.faces = std::move(scan.faces);
  return result;
}

}  // namespace scan2fea
