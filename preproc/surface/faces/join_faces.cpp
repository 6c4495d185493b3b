#include "preproc/surface/faces/join_faces.hpp"

#include "preproc/mesh/named_sets.hpp"
#include "preproc/surface/kernel/adjacency.hpp"
#include "preproc/surface/primitives/fit_shape.hpp"

#include <algorithm>
#include <cmath>
#include <set>

namespace scan2fea {
namespace {

using Index = std::uint32_t;

// Over sigma: a piece this far from the larger one's shape is not worth a fit, and is one with it when the fit leaves
// no more than this. A fifth more than the noise, since that is not the same everywhere.
constexpr double worth_a_fit = 4, noise_left = 1.2;

class Joiner {
 public:
  Joiner(const SurfaceMesh& mesh, const std::vector<Triangle>& smooth, double sigma, SurfaceFaces& faces)
      : mesh_(mesh), sigma_(sigma), faces_(faces), beside_(faces.list.size()) {
    for (Index f = 0; f < smooth.size(); ++f)
      for (const Index g : smooth[f])
        if (g != no_face && faces.of_triangle[f] != faces.of_triangle[g])
          beside_[faces.of_triangle[f]].insert(faces.of_triangle[g]);
  }

  void run() {
    while (join_one()) {
    }
    std::vector<SurfaceFace> left;
    for (SurfaceFace& face : faces_.list)
      if (!face.triangles.empty()) left.push_back(std::move(face));
    faces_.list = std::move(left);
    for (Index i = 0; i < faces_.list.size(); ++i)
      for (const Index f : faces_.list[i].triangles) faces_.of_triangle[f] = i;
  }

 private:
  bool join_one() {
    std::vector<Index> order;
    for (Index i = 0; i < faces_.list.size(); ++i)
      if (!faces_.list[i].triangles.empty()) order.push_back(i);
    std::stable_sort(order.begin(), order.end(), [&](Index a, Index b) { return size(a) < size(b); });
    for (const Index small : order)
      for (const Index large : beside_[small])
        if (size(large) >= size(small) && !refused_.contains({small, large})) {
          if (join(small, large)) return true;
          refused_.insert({small, large});
        }
    return false;
  }

  std::size_t size(Index i) const { return faces_.list[i].triangles.size(); }

  double rms(const Shape& shape, const std::vector<Index>& vertices) const {
    double squares = 0;
    for (const Index v : vertices) squares += std::pow(shape.signed_distance(mesh_.vertices[v]), 2);
    return std::sqrt(squares / static_cast<double>(vertices.size()));
  }

  bool join(Index small, Index large) {
    SurfaceFace &from = faces_.list[small], &to = faces_.list[large];
    if (!to.shape || !from.shape) return false;
    const std::vector<Index> of_small = vertices_of_faces(mesh_, from.triangles);
    if (rms(*to.shape, of_small) > worth_a_fit * sigma_) return false;
    const std::vector<Index> of_large = vertices_of_faces(mesh_, to.triangles);
    std::vector<Index> all;
    std::set_union(of_small.begin(), of_small.end(), of_large.begin(), of_large.end(), std::back_inserter(all));
    Shape joint = *to.shape;
    if (!fit_shape(joint, full_freedom(joint), mesh_.vertices, all, sigma_).found) return false;
    if (rms(joint, of_small) > noise_left * sigma_ || rms(joint, of_large) > noise_left * sigma_) return false;
    to.shape = joint;
    to.triangles.insert(to.triangles.end(), from.triangles.begin(), from.triangles.end());
    std::sort(to.triangles.begin(), to.triangles.end());
    from.triangles.clear();
    for (const Index other : beside_[small]) {
      beside_[other].erase(small);
      if (other == large) continue;
      beside_[other].insert(large);
      beside_[large].insert(other);
    }
    std::erase_if(refused_, [&](const auto& pair) { return pair.first == large || pair.second == large; });
    return true;
  }

  const SurfaceMesh& mesh_;
  double sigma_;
  SurfaceFaces& faces_;
  std::vector<std::set<Index>> beside_;
  std::set<std::pair<Index, Index>> refused_;
};

}  // namespace

void join_faces(const SurfaceMesh& mesh, const std::vector<Triangle>& smooth, double sigma, SurfaceFaces& faces) {
  Joiner(mesh, smooth, sigma, faces).run();
}

}  // namespace scan2fea
