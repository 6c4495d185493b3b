#include "preproc/volume/patch_relocation.hpp"

#include "preproc/volume/descent.hpp"
#include "preproc/volume/tet_complex.hpp"
#include "preproc/volume/tet_quality.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <vector>

namespace scan2fea {
namespace {

constexpr std::array<double, 2> sharpness{16, 64};
constexpr int steps_with_each = 40;

class Patch {
 public:
  Patch(const TetComplex& complex, std::uint32_t bad, const BoundaryWays& ways, double jacobian_counts)
      : ways_(ways), jacobian_counts_(jacobian_counts) {
    take_nodes(complex, bad);
    if (!empty()) take_elements(complex);
  }

  bool empty() const { return nodes_.empty(); }

  double least_quality() const {
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t e = 0; e < elements_.size(); ++e) {
      const GoalTerms of_element = terms(e);
      least = std::min(least, *std::ranges::min_element(of_element));
    }
    return least;
  }

  void optimise() {
    Eigen::VectorXd x = Eigen::VectorXd::Zero(3 * static_cast<Eigen::Index>(nodes_.size()));
    for (const double b : sharpness)
      descend([&](const Eigen::VectorXd& at, Eigen::VectorXd& gradient) { return energy(b, at, gradient); }, x,
              steps_with_each);
    put(x);
  }

  void give_to(TetComplex& complex) const {
    std::vector<std::uint32_t> around;
    for (std::size_t i = 0; i < nodes_.size(); ++i) {
      complex.star(nodes_[i].number, around);
      complex.move_node(nodes_[i].number, places_[i], around);
    }
  }

 private:
  struct Node {
    std::uint32_t number;
    Vec3 start;
    std::optional<WayPoint> way;          // of the boundary
    std::vector<std::uint32_t> elements;  // around it
  };

  void take_nodes(const TetComplex& complex, std::uint32_t bad) {
    std::vector<std::uint32_t> around, numbers;
    for (const std::uint32_t corner : complex.element(bad).corners) {
      complex.star(corner, around);
      for (const std::uint32_t t : around) {
        const Tetrahedron& corners = complex.element(t).corners;
        numbers.insert(numbers.end(), corners.begin(), corners.end());
      }
    }
    std::ranges::sort(numbers);
    const auto [first, last] = std::ranges::unique(numbers);
    numbers.erase(first, last);
    for (const std::uint32_t v : numbers) {
      Node node{v, complex.node(v), {}, {}};
      if (complex.fixed(v) && !(ways_ && (node.way = ways_(v, node.start)))) continue;
      nodes_.push_back(std::move(node));
    }
  }

  void take_elements(const TetComplex& complex) {
    std::vector<std::uint32_t> numbers, around;
    for (const Node& node : nodes_) {
      complex.star(node.number, around);
      numbers.insert(numbers.end(), around.begin(), around.end());
    }
    std::ranges::sort(numbers);
    const auto [first, last] = std::ranges::unique(numbers);
    numbers.erase(first, last);
    std::vector<std::uint32_t> vertices;
    for (const Node& node : nodes_) {
      vertices.push_back(node.number);
      places_.push_back(node.start);
    }
    for (const std::uint32_t t : numbers) {
      Tetrahedron element;
      for (std::size_t k = 0; k < 4; ++k) {
        const std::uint32_t v = complex.element(t).corners[k];
        const auto at = std::ranges::find(vertices, v);
        element[k] = static_cast<std::uint32_t>(at - vertices.begin());
        if (at == vertices.end()) {
          vertices.push_back(v);
          places_.push_back(complex.node(v));
        }
        if (element[k] < nodes_.size())
          nodes_[element[k]].elements.push_back(static_cast<std::uint32_t>(elements_.size()));
      }
      elements_.push_back(element);
    }
    const Tetrahedron& one = elements_.front();
    length_ = (places_[one[0]] - places_[one[1]]).norm();
  }

  // False where a node has no way.
  bool put(const Eigen::VectorXd& x) {
    for (std::size_t i = 0; i < nodes_.size(); ++i) {
      const Vec3 wanted = nodes_[i].start + length_ * x.segment<3>(3 * static_cast<Eigen::Index>(i));
      if (nodes_[i].way) {
        const std::optional<WayPoint> way = ways_(nodes_[i].number, wanted);
        if (!way) return false;
        nodes_[i].way = way;
        places_[i] = way->place;
      } else {
        places_[i] = wanted;
      }
    }
    return true;
  }

  GoalTerms terms(std::size_t e) const {
    const Tetrahedron& c = elements_[e];
    return goal_terms(places_[c[0]], places_[c[1]], places_[c[2]], places_[c[3]], jacobian_counts_);
  }

  double energy(double b, const Eigen::VectorXd& x, Eigen::VectorXd& gradient) {
    constexpr double outside = std::numeric_limits<double>::infinity();
    if (!put(x)) return outside;
    terms_.resize(elements_.size());
    weights_.resize(elements_.size());
    double least = outside;
    for (std::size_t e = 0; e < elements_.size(); ++e) {
      terms_[e] = terms(e);
      least = std::min(least, *std::ranges::min_element(terms_[e]));
    }
    if (!(least > 0)) return outside;  // an element is flat or turned over
    double sum = 0;
    for (std::size_t e = 0; e < elements_.size(); ++e) {
      weights_[e] = (b * (least - Eigen::Map<const TermArray>(terms_[e].data()))).exp();
      sum += weights_[e].sum();
    }
    gradient.setZero(x.size());
    for (std::size_t i = 0; i < nodes_.size(); ++i) {
      const Vec3 of_node = gradient_of(i) / sum;
      gradient.segment<3>(3 * static_cast<Eigen::Index>(i)) = nodes_[i].way ? nodes_[i].way->allowed(of_node) : of_node;
    }
    return std::log(sum) / b - least;
  }

  // By differences: terms have no handy derivatives.
  Vec3 gradient_of(std::size_t node) {
    constexpr double negligible = 1e-3, difference = 1e-6;
    Vec3 sum = Vec3::Zero();
    for (const std::uint32_t e : nodes_[node].elements) {
      if (weights_[e].maxCoeff() < negligible) continue;
      for (int k = 0; k < 3; ++k) {
        double& coordinate = places_[node][k];
        const double before = coordinate;
        coordinate += difference * length_;
        const GoalTerms moved = terms(e);
        coordinate = before;
        for (std::size_t j = 0; j < moved.size(); ++j)
          sum[k] -= weights_[e][static_cast<Eigen::Index>(j)] * (moved[j] - terms_[e][j]) / difference;
      }
    }
    return sum;
  }

  using TermArray = Eigen::Array<double, std::tuple_size_v<GoalTerms>, 1>;

  const BoundaryWays& ways_;
  double jacobian_counts_;
  std::vector<Node> nodes_;            // that move
  std::vector<Vec3> places_;           // theirs, then those of the others
  std::vector<Tetrahedron> elements_;  // of numbers in places_
  double length_ = 0;                  // of an edge
  std::vector<GoalTerms> terms_;       // by element
  std::vector<TermArray> weights_;
};

}  // namespace

bool relocate_patch(TetComplex& complex, std::uint32_t bad, const BoundaryWays& ways, const PatchOptions& options) {
  Patch patch(complex, bad, ways, options.jacobian_counts);
  if (patch.empty()) return false;
  const double before = patch.least_quality();
  patch.optimise();
  if (!(patch.least_quality() > options.gain * before)) return false;
  patch.give_to(complex);
  return true;
}

}  // namespace scan2fea
