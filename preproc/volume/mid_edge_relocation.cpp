#include "preproc/volume/mid_edge_relocation.hpp"

#include "quality/tetrahedron_measures.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

namespace scan2fea {
namespace {

constexpr int most_mid_edge_sweeps = 6;
constexpr double farthest_of_curved_edge = 0.25, first_step = 0.1, last_step = 0.005, least_gain = 1e-4;

class MidEdgeRelocation {
 public:
  MidEdgeRelocation(TetMesh& mesh, const std::vector<bool>& held)
      : mesh_(mesh), held_(held), around_(mesh.nodes.size()) {
    for (std::uint32_t t = 0; t < mesh.tetrahedra.size(); ++t)
      for (const std::uint32_t v : mesh.mid_edge_nodes[t])
        if (!held[v]) around_[v].push_back(t);
  }

  void run(const std::vector<std::uint32_t>& poor, double wanted, const Progress& progress) {
    for (int sweep = 0; sweep < most_mid_edge_sweeps; ++sweep) {
      std::vector<std::pair<double, std::uint32_t>> worst_first;
      for (const std::uint32_t t : poor) {
        const double quality = curved_quality(mesh_, t);
        if (quality < wanted) worst_first.emplace_back(quality, t);
      }
      std::sort(worst_first.begin(), worst_first.end());
      bool has_moved = false;
      for (std::size_t i = 0; i < worst_first.size(); ++i) {
        if (i % 16 == 0) progress.tell("curved elements", sweep / static_cast<double>(most_mid_edge_sweeps));
        if (!progress.may_improve()) return;
        for (std::size_t e = 0; e < 6; ++e) has_moved |= move(worst_first[i].second, e, wanted);
      }
      if (!has_moved) return;
    }
  }

 private:
  // At most `enough`; exact only above `floor`.
  double quality_around(std::uint32_t node, double enough,
                        double floor = -std::numeric_limits<double>::infinity()) const {
    double least = enough;
    for (const std::uint32_t t : around_[node]) {
      least = std::min(least, curved_quality(mesh_, t));
      if (least <= floor) break;
    }
    return least;
  }

  // More than what is wanted is not asked for: what is good enough stays about straight.
  bool move(std::uint32_t t, std::size_t e, double wanted) {
    const std::uint32_t node = mesh_.mid_edge_nodes[t][e];
    if (held_[node]) return false;
    const Vec3& a = mesh_.nodes[mesh_.tetrahedra[t][static_cast<std::size_t>(tetrahedron_edges[e][0])]];
    const Vec3& b = mesh_.nodes[mesh_.tetrahedra[t][static_cast<std::size_t>(tetrahedron_edges[e][1])]];
    const Vec3 middle = (a + b) / 2;
    const double length = (b - a).norm();
    Vec3& place = mesh_.nodes[node];
    double quality = quality_around(node, wanted);
    bool has_moved = false;
    for (double step = first_step; step >= last_step && quality < wanted;) {
      bool gained = false;
      for (int axis = 0; axis < 3; ++axis)
        for (const double way : {step, -step}) {
          const Vec3 before = place;
          place[axis] += way * length;
          const bool is_near = (place - middle).norm() <= farthest_of_curved_edge * length;
          const double there = is_near ? quality_around(node, wanted, quality) : quality;
          if (there > quality + least_gain) {
            quality = there;
            gained = has_moved = true;
          } else {
            place = before;
          }
        }
      if (!gained) step /= 2;
    }
    return has_moved;
  }

  TetMesh& mesh_;
  const std::vector<bool>& held_;
  std::vector<std::vector<std::uint32_t>> around_;  // of nodes that may move
};

}  // namespace

double curved_quality(const TetMesh& mesh, std::size_t tetrahedron) {
  constexpr double wanted_jacobian = 0.25, smallest_deg = 15, largest_deg = 155, degree = std::numbers::pi / 180;
  const TetShape shape = measure_tetrahedron(mesh, tetrahedron);
  return std::min({shape.scaled_jacobian / wanted_jacobian,
                   std::sin(degree * shape.min_dihedral_deg) / std::sin(degree * smallest_deg),
                   (1 + std::cos(degree * shape.max_dihedral_deg)) / (1 + std::cos(degree * largest_deg))});
}

void relocate_mid_edge_nodes(TetMesh& mesh, const std::vector<std::uint32_t>& poor, const std::vector<bool>& held,
                             double wanted, const Progress& progress) {
  MidEdgeRelocation(mesh, held).run(poor, wanted, progress);
}

}  // namespace scan2fea
