#include "preproc/surface/faces/face_regions.hpp"

#include "preproc/mesh/union_find.hpp"

#include <algorithm>
#include <cmath>
#include <queue>
#include <tuple>

namespace scan2fea {
namespace {

using Index = std::uint32_t;

constexpr Index no_region = ~Index{0};

// A row of triangles is as wide as one of them is high. The edge of a part that a scanner did not hit is cut off by
// such a row; so are strips beside a tangent joint that a plane describes as well.
constexpr double narrowest_of_height = 1.4;
constexpr std::size_t fewest_triangles = 8;
// Of the width: rounding of 32-bit coordinates is all that chamfers of CAD have.
constexpr double exact_of_width = 1e-5, exact_of_diagonal = 1e-6;

struct Piece {
  std::size_t triangles = 0;
  double area = 0, height = 0, perimeter = 0, crease = 0;  // height: the sum of the triangles'
  Vec3 normal = Vec3::Zero();
};

class Regions {
 public:
  Regions(const SurfaceMesh& mesh, const SurfaceMesh& cut, const TriangleLabels& shapes, std::vector<Index> labels)
      : mesh_(mesh),
        shapes_(shapes),
        label_(std::move(labels)),
        neighbours_(face_neighbours(mesh, VertexStars(mesh))),
        smooth_(face_neighbours(cut, VertexStars(cut))),
        region_(mesh.triangles.size(), no_region) {}

  FaceRegions run() {
    connect(smooth_, [&](Index f, Index g) { return label_[f] == label_[g]; });
    std::vector<bool> is_speck = find_specks();
    if (join_within_creases(is_speck)) is_speck = find_specks();
    absorb(is_speck);
    connect(neighbours_, [&](Index f, Index g) {
      return region_[f] == region_[g] || (label_[f] == label_[g] && label_[f] != no_primitive);
    });
    FaceRegions regions{std::move(region_), {}};
    for (Index f = 0; f < regions.of_triangle.size(); ++f)
      if (regions.of_triangle[f] == regions.label.size()) regions.label.push_back(label_[f]);
    return regions;
  }

 private:
  // Regions are numbered in the order of their first triangles.
  template <class Joined>
  void connect(const std::vector<Triangle>& neighbours, const Joined& joined) {
    UnionFind sets(region_.size());
    for (Index f = 0; f < region_.size(); ++f)
      for (const Index g : neighbours[f])
        if (g != no_face && joined(f, g)) sets.unite(f, g);
    std::vector<Index> number(region_.size());
    Index count = 0;
    for (Index f = 0; f < number.size(); ++f) {
      const Index root = sets.find(f);
      number[f] = root == f ? count++ : number[root];
    }
    region_ = std::move(number);
  }

  std::vector<Piece> measure() const {
    std::vector<Piece> pieces;
    for (Index f = 0; f < region_.size(); ++f) {
      if (region_[f] >= pieces.size()) pieces.resize(region_[f] + 1);
      Piece& piece = pieces[region_[f]];
      const Vec3 area = area_vector(mesh_, mesh_.triangles[f]);
      double longest = 0;
      for (std::size_t k = 0; k < 3; ++k) {
        const double length =
            (mesh_.vertices[mesh_.triangles[f][(k + 1) % 3]] - mesh_.vertices[mesh_.triangles[f][(k + 2) % 3]]).norm();
        longest = std::max(longest, length);
        const Index g = neighbours_[f][k];
        if (g != no_face && region_[g] == region_[f]) continue;
        piece.perimeter += length;
        if (smooth_[f][k] == no_face) piece.crease += length;
      }
      ++piece.triangles;
      piece.area += area.norm() / 2;
      piece.normal += area;
      if (longest > 0) piece.height += area.norm() / longest;
    }
    return pieces;
  }

  // How far the corners of each piece are from a plane of its mean normal, at the most.
  std::vector<double> flatness(const std::vector<Piece>& pieces) const {
    std::vector<double> low(pieces.size(), HUGE_VAL), high(pieces.size(), -HUGE_VAL);
    for (Index f = 0; f < region_.size(); ++f)
      for (const Index v : mesh_.triangles[f]) {
        const double height = pieces[region_[f]].normal.normalized().dot(mesh_.vertices[v]);
        low[region_[f]] = std::min(low[region_[f]], height);
        high[region_[f]] = std::max(high[region_[f]], height);
      }
    for (std::size_t p = 0; p < pieces.size(); ++p) high[p] -= low[p];
    return high;
  }

  std::vector<bool> find_specks() const {
    const std::vector<Piece> pieces = measure();
    const std::vector<double> flat = flatness(pieces);
    const double rounding = exact_of_diagonal * bounding_box(mesh_.vertices).diagonal();
    std::vector<bool> is_speck(pieces.size());
    for (std::size_t p = 0; p < pieces.size(); ++p) {
      const Piece& piece = pieces[p];
      const double width = piece.perimeter > 0 ? 2 * piece.area / piece.perimeter : HUGE_VAL;
      const bool narrow = width * static_cast<double>(piece.triangles) < narrowest_of_height * piece.height;
      const bool exact = flat[p] <= rounding + exact_of_width * width && 2 * piece.crease > piece.perimeter;
      is_speck[p] = (narrow || piece.triangles < fewest_triangles) && piece.perimeter > 0 && !exact;
    }
    return is_speck;
  }

  // Where all that creases enclose is specks, it is one face in pieces, as a cone is for which no shape was found but
  // strips of planes. Returns whether there was any.
  bool join_within_creases(const std::vector<bool>& is_speck) {
    const std::vector<Index> pieces = region_, labels = label_;
    connect(smooth_, [](Index, Index) { return true; });
    const std::vector<Index> enclosed = region_;
    std::vector<bool> all_specks(enclosed.size(), true);
    std::vector<Index> first(enclosed.size(), no_region);
    std::vector<bool> in_pieces(enclosed.size(), false);
    for (Index f = 0; f < enclosed.size(); ++f) {
      if (!is_speck[pieces[f]]) all_specks[enclosed[f]] = false;
      Index& known = first[enclosed[f]];
      if (known == no_region) known = pieces[f];
      if (known != pieces[f]) in_pieces[enclosed[f]] = true;
    }
    const auto is_joined = [&](Index f) { return all_specks[enclosed[f]] && in_pieces[enclosed[f]]; };
    region_ = pieces;
    connect(smooth_, [&](Index f, Index g) { return pieces[f] == pieces[g] || is_joined(f); });
    bool any = false;
    for (Index f = 0; f < enclosed.size(); ++f)
      if (is_joined(f)) label_[f] = no_primitive, any = true;
    return any;
  }

  // From the borders of the other regions inwards, the best described triangle first. What no region reaches stays.
  void absorb(const std::vector<bool>& is_speck) {
    using Step = std::tuple<bool, double, Index, Index>;  // across a crease, cost, triangle, from
    std::priority_queue<Step, std::vector<Step>, std::greater<>> queue;
    std::vector<bool> open(region_.size());
    for (Index f = 0; f < open.size(); ++f) open[f] = is_speck[region_[f]];
    const auto offer = [&](Index from) {
      for (std::size_t k = 0; k < 3; ++k) {
        const Index g = neighbours_[from][k];
        if (g == no_face || !open[g]) continue;
        queue.emplace(smooth_[from][k] == no_face, shapes_.cost(g, label_[from]), g, from);
      }
    };
    for (Index f = 0; f < open.size(); ++f)
      if (!open[f]) offer(f);
    while (!queue.empty()) {
      const auto [across, cost, f, from] = queue.top();
      queue.pop();
      if (!open[f]) continue;
      open[f] = false;
      region_[f] = region_[from];
      label_[f] = label_[from];
      offer(f);
    }
  }

  const SurfaceMesh& mesh_;
  const TriangleLabels& shapes_;
  std::vector<Index> label_;
  std::vector<Triangle> neighbours_, smooth_;  // smooth: no_face across creases
  std::vector<Index> region_;
};

}  // namespace

FaceRegions find_regions(const SurfaceMesh& mesh, const SurfaceMesh& cut, const TriangleLabels& shapes,
                         std::vector<Index> labels) {
  return Regions(mesh, cut, shapes, std::move(labels)).run();
}

}  // namespace scan2fea
