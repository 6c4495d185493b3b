#include "preproc/layers/layer_directions.hpp"

#include "preproc/mesh/numbers.hpp"
#include "preproc/mesh/union_find.hpp"
#include "quality/triangle_measures.hpp"

#include <Eigen/Dense>

#include <algorithm>
#include <cmath>
#include <optional>

namespace scan2fea {
namespace {

constexpr double face_turn_deg = 30;
// A way along a face that is at 30 degrees to the layered one is twice as long as one across it.
constexpr double longest_way = 2;
// How much nearer or farther than one the way may be from the planes of the faces at a corner of many.
constexpr double most_off = 0.2;

struct Faces {
  std::vector<Vec3> layered, beside;  // unit normals
};

class DirectionFinder {
 public:
  DirectionFinder(const SurfaceMesh& surface, const VertexStars& stars, const std::vector<Triangle>& neighbours,
                  const std::vector<bool>& layered)
      : surface_(surface), stars_(stars), neighbours_(neighbours), layered_(layered) {}

  // Of all vertices of layered triangles.
  LayerDirections find() {
    LayerDirections result{std::vector<Vec3>(surface_.vertices.size(), Vec3::Zero()),
                           std::vector<bool>(surface_.vertices.size(), false)};
    std::vector<OnFace> on_faces;
    for (std::uint32_t v = 0; v < surface_.vertices.size(); ++v) {
      const Faces faces = faces_around(v);
      const std::optional<Vec3> way = at(v, faces);
      if (!way) continue;
      result.inwards[v] = *way;
      result.is_beside[v] = !faces.beside.empty();
      if (faces.layered.size() == 1 && faces.beside.empty()) on_faces.push_back({v, faces.layered.front()});
    }
    lean(on_faces, result.inwards);
    return result;
  }

 private:
  struct OnFace {
    std::uint32_t vertex;
    Vec3 normal;
  };

  // Where the ways from an edge lean inwards those beside lean with them, the less the farther they are: so triangles
  // there keep their shape.
  void lean(const std::vector<OnFace>& on_faces, std::vector<Vec3>& ways) const {
    constexpr int rounds = 40;
    for (int round = 0; round < rounds; ++round)
      for (const auto& [v, normal] : on_faces) {
        Vec3 sum = Vec3::Zero();
        double count = 0;
        for (const std::uint32_t corner : stars_.corners(v))
          for (const std::size_t k : {1U, 2U}) {
            sum += ways[surface_.triangles[corner / 3][(corner + k) % 3]];
            ++count;
          }
        const Vec3 mean = sum / count;
        ways[v] = mean - normal * (normal.dot(mean) + 1);
      }
  }

  std::optional<Vec3> at(std::uint32_t v, const Faces& faces) const {
    if (faces.layered.empty() || faces.beside.size() > 2) return {};
    const Eigen::MatrixXd directions = allowed_directions(faces.beside);
    if (directions.cols() == 0) return {};
    const Vec3 way = away_by_one(faces.layered, directions);
    if (way.norm() > longest_way * most_apart(faces.layered)) return {};
    for (const Vec3& normal : faces.layered)
      if (std::abs(normal.dot(way) + 1) > most_off) return {};
    if (!faces.beside.empty() && !leads_along(v, way)) return {};
    return way;
  }

  Faces faces_around(std::uint32_t v) const {
    const auto corners = stars_.corners(v);
    UnionFind sets(corners.size());
    const double most_turn = std::cos(face_turn_deg / degrees);
    for (std::uint32_t i = 0; i < corners.size(); ++i) {
      const std::uint32_t f = corners[i] / 3, k = corners[i] % 3;
      for (std::uint32_t j = 0; j < i; ++j) {
        const std::uint32_t g = corners[j] / 3;
        const bool share_edge = neighbours_[f][(k + 1) % 3] == g || neighbours_[f][(k + 2) % 3] == g;
        if (share_edge && layered_[f] == layered_[g] && normal_of(f).dot(normal_of(g)) > most_turn) sets.unite(i, j);
      }
    }
    std::vector<Vec3> sums(corners.size(), Vec3::Zero());
    for (std::uint32_t i = 0; i < corners.size(); ++i) {
      const std::uint32_t f = corners[i] / 3;
      const Triangle& t = surface_.triangles[f];
      const std::size_t k = corners[i] % 3;
      sums[sets.find(i)] +=
          angle_deg(surface_.vertices[v], surface_.vertices[t[(k + 1) % 3]], surface_.vertices[t[(k + 2) % 3]]) *
          normal_of(f);
    }
    Faces faces;
    for (std::uint32_t i = 0; i < corners.size(); ++i)
      if (sums[i].norm() > 0) (layered_[corners[i] / 3] ? faces.layered : faces.beside).push_back(sums[i].normalized());
    return faces;
  }

  Vec3 normal_of(std::uint32_t f) const { return area_vector(surface_, surface_.triangles[f]).normalized(); }

  // An orthonormal basis of what is in the planes of the faces beside, as columns.
  static Eigen::MatrixXd allowed_directions(const std::vector<Vec3>& beside) {
    if (beside.empty()) return Eigen::Matrix3d::Identity();
    if (beside.size() == 2) {
      const Vec3 along = beside[0].cross(beside[1]);
      return along.norm() > std::sin(face_turn_deg / degrees) ? Eigen::MatrixXd(along.normalized())
                                                              : Eigen::MatrixXd(3, 0);
    }
    const Vec3 first = beside[0].unitOrthogonal();
    Eigen::MatrixXd basis(3, 2);
    basis.col(0) = first;
    basis.col(1) = beside[0].cross(first);
    return basis;
  }

  // Least squares, and of what these leave open the way along the mean of the normals.
  static Vec3 away_by_one(const std::vector<Vec3>& layered, const Eigen::MatrixXd& directions) {
    constexpr double weight_of_mean = 1e-3;
    Vec3 sum = Vec3::Zero();
    for (const Vec3& normal : layered) sum += normal;
    const Eigen::VectorXd mean = directions.transpose() * sum;
    double along = 0, squared = 0;
    Eigen::MatrixXd matrix = weight_of_mean * Eigen::MatrixXd::Identity(directions.cols(), directions.cols());
    Eigen::VectorXd right = Eigen::VectorXd::Zero(directions.cols());
    for (const Vec3& normal : layered) {
      const Eigen::VectorXd row = directions.transpose() * normal;
      matrix += row * row.transpose();
      right -= row;
      along += row.dot(mean);
      squared += row.dot(mean) * row.dot(mean);
    }
    if (squared > 0) right -= weight_of_mean * along / squared * mean;
    return directions * matrix.ldlt().solve(right);
  }

  // At an edge or a corner of layered faces the way is longer than one for a good reason: 1.73 at a cube's.
  static double most_apart(const std::vector<Vec3>& layered) {
    Vec3 sum = Vec3::Zero();
    for (const Vec3& normal : layered) sum += normal;
    return static_cast<double>(layered.size()) / std::max(sum.norm(), 1e-3);
  }

  // Whether there is a triangle without layers where it goes.
  bool leads_along(std::uint32_t v, const Vec3& way) const {
    constexpr double most_beyond = 0.05, most_above = 0.2;
    return std::ranges::any_of(stars_.corners(v), [&](std::uint32_t corner) {
      const std::uint32_t f = corner / 3;
      if (layered_[f]) return false;
      const Triangle& t = surface_.triangles[f];
      Eigen::Matrix<double, 3, 2> sides;
      sides.col(0) = (surface_.vertices[t[(corner % 3 + 1) % 3]] - surface_.vertices[v]).normalized();
      sides.col(1) = (surface_.vertices[t[(corner % 3 + 2) % 3]] - surface_.vertices[v]).normalized();
      const Vec3 unit = way.normalized();
      const Eigen::Vector2d parts = (sides.transpose() * sides).ldlt().solve(sides.transpose() * unit);
      return parts.minCoeff() > -most_beyond && (sides * parts - unit).norm() < most_above;
    });
  }

  const SurfaceMesh& surface_;
  const VertexStars& stars_;
  const std::vector<Triangle>& neighbours_;
  const std::vector<bool>& layered_;
};

}  // namespace

LayerDirections layer_directions(const SurfaceMesh& surface, const VertexStars& stars,
                                 const std::vector<Triangle>& neighbours, const std::vector<bool>& layered) {
  return DirectionFinder(surface, stars, neighbours, layered).find();
}

}  // namespace scan2fea
