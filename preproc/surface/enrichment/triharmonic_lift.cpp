#include "preproc/surface/enrichment/triharmonic_lift.hpp"

#include <Eigen/Sparse>
#include <Eigen/SparseCholesky>

#include <algorithm>
#include <cmath>

namespace scan2fea {
namespace {

using Index = HalfedgeMesh::Index;
using Sparse = Eigen::SparseMatrix<double>;
using Entries = std::vector<Eigen::Triplet<double>>;
constexpr int fixed = -1;

class Lifter {
 public:
  Lifter(HalfedgeMesh& mesh, const std::vector<bool>& free, const std::vector<bool>& measured,
         const TriharmonicOptions& options)
      : mesh_(mesh), options_(options), unknown_(mesh.vertex_slots(), fixed), places_(mesh.points) {
    const auto is_free = [&](Index v) {
      return mesh_.is_alive(v) && !mesh_.is_border_vertex(v) && !is_crease(v) &&
             (free[v] || (options.hold > 0 && measured[v]));
    };
    for (Index v = 0; v < mesh_.vertex_slots(); ++v) {
      if (!is_free(v)) continue;
      unknown_[v] = count_++;
      held_.push_back(measured[v] && !free[v]);
    }
  }

  void run() {
    for (int solve = 0; solve < options_.solves && count_ > 0; ++solve) {
      gather_near();
      if (!solve_once()) return;
      pin_the_far();
    }
  }

 private:
  bool is_smooth_at(Index v) const { return !is_crease(v) && !mesh_.is_border_vertex(v); }
  bool is_crease(Index v) const { return !options_.creases.empty() && options_.creases[v]; }

  // What moves so far was not told by its neighbours: it goes back, and the next solve goes through it.
  void pin_the_far() {
    constexpr double farthest = 0.7;  // of the edges around
    std::vector<bool> held;
    count_ = 0;
    for (Index v = 0; v < unknown_.size(); ++v) {
      if (unknown_[v] == fixed) continue;
      double sum = 0;
      int edges = 0;
      mesh_.for_each_neighbour(v, [&](Index w) {
        sum += (places_[w] - places_[v]).norm();
        ++edges;
      });
      const bool was_held = held_[static_cast<std::size_t>(unknown_[v])];
      if ((mesh_.points[v] - places_[v]).norm() * edges > farthest * sum) {
        mesh_.points[v] = places_[v];
        unknown_[v] = fixed;
        continue;
      }
      unknown_[v] = count_++;
      held.push_back(was_held);
    }
    held_ = std::move(held);
  }

  // Vertices within three edges of a free one: all that its equations read.
  void gather_near() {
    row_.assign(mesh_.vertex_slots(), fixed);
    near_.clear();
    std::vector<Index> ring;
    const auto take = [&](Index v) {
      if (row_[v] != fixed) return;
      row_[v] = static_cast<int>(near_.size());
      near_.push_back(v);
      ring.push_back(v);
    };
    for (Index v = 0; v < unknown_.size(); ++v)
      if (unknown_[v] != fixed) take(v);
    double sum = 0;
    std::size_t edges = 0;
    for (const Index v : near_)
      mesh_.for_each_neighbour(v, [&](Index w) {
        sum += (mesh_.points[w] - mesh_.points[v]).norm();
        ++edges;
      });
    edge_ = sum / static_cast<double>(std::max<std::size_t>(1, edges));
    for (int i = 0; i < 3; ++i) {
      const std::vector<Index> last = std::move(ring);
      ring.clear();
      for (const Index v : last) mesh_.for_each_neighbour(v, take);
      if (i == 1) inner_ = near_.size();  // whose Laplacians count: all their neighbours are there
    }
  }

  // Over the near vertices; lengths over the mean edge.
  void build_laplacian(Sparse& stiffness, Eigen::VectorXd& mass) const {
    const auto n = static_cast<Eigen::Index>(near_.size());
    Entries entries;
    mass = Eigen::VectorXd::Zero(n);
    std::vector<bool> seen(mesh_.face_slots(), false);
    for (const Index v : near_)
      mesh_.for_each_outgoing(v, [&](Index h) {
        const Index f = HalfedgeMesh::face(h);
        if (seen[f]) return;
        seen[f] = true;
        add_face(f, entries, mass);
      });
    stiffness.resize(n, n);
    stiffness.setFromTriplets(entries.begin(), entries.end());
  }

  void add_face(Index f, Entries& entries, Eigen::VectorXd& mass) const {
    // Of angles below 3 degrees; a needle must not rule its neighbours.
    constexpr double most_cotangent = 20;
    const Triangle t = mesh_.triangle(f);
    const double area = std::max(mesh_.area_vector(f).norm() / (edge_ * edge_), 1e-6);
    for (std::size_t i = 0; i < 3; ++i)
      if (row_[t[i]] != fixed) mass[row_[t[i]]] += area / 6;
    for (std::size_t i = 0; i < 3; ++i) {
      const int a = row_[t[(i + 1) % 3]], b = row_[t[(i + 2) % 3]];
      if (a == fixed || b == fixed) continue;
      const Vec3 u = mesh_.points[t[(i + 1) % 3]] - mesh_.points[t[i]],
                 w = mesh_.points[t[(i + 2) % 3]] - mesh_.points[t[i]];
      const double cotangent = std::clamp(u.dot(w) / std::max(u.cross(w).norm(), 1e-300), 0.0, most_cotangent);
      const double weight = 0.5 * std::max(cotangent, 0.01);
      entries.emplace_back(a, a, weight);
      entries.emplace_back(b, b, weight);
      entries.emplace_back(a, b, -weight);
      entries.emplace_back(b, a, -weight);
    }
  }

  bool solve_once() {
    constexpr double bending = 0.1;
    Sparse stiffness;
    Eigen::VectorXd mass;
    build_laplacian(stiffness, mass);
    // Laplacians of vertices at the rim of what is looked at are not whole, and do not
    // count; nor do those on creases and borders.
    const auto n = static_cast<Eigen::Index>(near_.size());
    Eigen::VectorXd inverse = Eigen::VectorXd::Zero(n), kept = Eigen::VectorXd::Zero(n);
    for (Eigen::Index i = 0; i < n; ++i)
      if (i < static_cast<Eigen::Index>(inner_) && is_smooth_at(near_[static_cast<std::size_t>(i)])) {
        kept[i] = 1;
        inverse[i] = 1 / mass[i];
      }
    const Sparse laplacian = inverse.asDiagonal() * stiffness;
    Sparse middle = kept.asDiagonal() * stiffness * kept.asDiagonal();
    const Eigen::VectorXd lumped = bending * mass.cwiseProduct(kept);
    middle += Sparse(lumped.asDiagonal());
    // Columns of the unknown alone; the others make the right side.
    Sparse pick(n, count_);
    Entries ones;
    for (Eigen::Index i = 0; i < n; ++i)
      if (const int u = unknown_[near_[static_cast<std::size_t>(i)]]; u != fixed) ones.emplace_back(i, u, 1.0);
    pick.setFromTriplets(ones.begin(), ones.end());
    Eigen::Matrix<double, Eigen::Dynamic, 3> known = Eigen::Matrix<double, Eigen::Dynamic, 3>::Zero(n, 3);
    for (Eigen::Index i = 0; i < n; ++i)
      if (const Index v = near_[static_cast<std::size_t>(i)]; unknown_[v] == fixed)
        known.row(i) = mesh_.points[v].transpose();
    const Sparse columns = laplacian * pick;
    const Sparse weighted = middle * columns;
    Sparse normal = Sparse(columns.transpose()) * weighted;
    Eigen::Matrix<double, Eigen::Dynamic, 3> right =
        -(Sparse(weighted.transpose()) * Eigen::Matrix<double, Eigen::Dynamic, 3>(laplacian * known));
    for (Eigen::Index i = 0; i < n; ++i) {
      const Index v = near_[static_cast<std::size_t>(i)];
      const int u = unknown_[v];
      if (u == fixed || !held_[static_cast<std::size_t>(u)]) continue;
      normal.coeffRef(u, u) += options_.hold;
      right.row(u) += options_.hold * places_[v].transpose();
    }
    Eigen::SimplicialLDLT<Sparse> solver(normal);
    if (solver.info() != Eigen::Success) return false;
    const Eigen::Matrix<double, Eigen::Dynamic, 3> solution = solver.solve(right);
    if (!solution.allFinite()) return false;
    for (Index v = 0; v < unknown_.size(); ++v)
      if (unknown_[v] != fixed) mesh_.points[v] = solution.row(unknown_[v]).transpose();
    return true;
  }

  HalfedgeMesh& mesh_;
  const TriharmonicOptions& options_;
  std::vector<int> unknown_;  // per vertex
  const std::vector<Vec3> places_;
  std::vector<bool> held_;  // per unknown
  int count_ = 0;
  std::vector<Index> near_;
  std::vector<int> row_;  // per vertex, in near_
  std::size_t inner_ = 0;
  double edge_ = 1;
};

}  // namespace

void triharmonic_lift(HalfedgeMesh& mesh, const std::vector<bool>& free, const std::vector<bool>& measured,
                      const TriharmonicOptions& options) {
  Lifter(mesh, free, measured, options).run();
}

}  // namespace scan2fea
