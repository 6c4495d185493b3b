#include "preproc/volume/boundary_relocation.hpp"

#include "preproc/volume/interior_points.hpp"
#include "preproc/volume/max_min_relocation.hpp"
#include "quality/tetrahedron_measures.hpp"

#include <algorithm>
#include <utility>

namespace scan2fea {
namespace {

// A tenth of an edge lifted the bunny's least angle from 22 to 33 degrees; walls of a tenth of an edge want both sides
// to go by a quarter.
constexpr double longest_way = 0.25;
constexpr int most_sweeps = 20, steps = 8;

class BoundaryRelocation {
 public:
  BoundaryRelocation(const TetMesh& mesh, const SurfaceMesh& boundary, const std::vector<bool>& held, double most_off)
      : tetrahedra_(mesh.tetrahedra),
        nodes_(mesh.nodes),
        given_(boundary.vertices),
        edge_(surface_sizes(boundary)),
        normals_(boundary.vertices.size(), Vec3::Zero()),
        held_(held),
        most_off_(most_off),
        around_(mesh.nodes.size()),
        asked_(mesh.nodes.size(), 0),
        moved_(mesh.nodes.size(), 0) {
    for (const Triangle& t : boundary.triangles)
      for (const std::uint32_t v : t) normals_[v] += area_vector(boundary, t);
    for (Vec3& n : normals_) n.normalize();
  }

  std::vector<Vec3> run(double least_dihedral_deg) {
    for (now_ = 1; now_ <= most_sweeps; ++now_) {
      const std::vector<std::uint32_t> around_poor = nodes_of_poor(least_dihedral_deg);
      find_stars(around_poor);
      bool has_moved = false;
      for (const std::uint32_t v : around_poor)
        if (has_changed_around(v)) has_moved |= move(v);
      if (!has_moved) break;
    }
    return {nodes_.begin(), nodes_.begin() + static_cast<std::ptrdiff_t>(given_.size())};
  }

 private:
  // Each once, those of the worst element first.
  std::vector<std::uint32_t> nodes_of_poor(double least_dihedral_deg) const {
    std::vector<std::pair<double, std::size_t>> poor;
    for (std::size_t t = 0; t < tetrahedra_.size(); ++t) {
      const auto& [a, b, c, d] = tetrahedra_[t];
      const double angle = measure_tetrahedron(nodes_[a], nodes_[b], nodes_[c], nodes_[d]).min_dihedral_deg;
      if (angle < least_dihedral_deg) poor.emplace_back(angle, t);
    }
    std::sort(poor.begin(), poor.end());
    std::vector<std::uint32_t> found;
    std::vector<bool> is_found(nodes_.size(), false);
    for (const auto& [angle, t] : poor)
      for (const std::uint32_t v : tetrahedra_[t]) {
        if (is_found[v] || (is_on_boundary(v) && held_[v])) continue;
        is_found[v] = true;
        found.push_back(v);
      }
    return found;
  }

  bool is_on_boundary(std::uint32_t v) const { return v < given_.size(); }

  void find_stars(const std::vector<std::uint32_t>& asked) {
    std::vector<bool> is_asked(nodes_.size(), false);
    for (const std::uint32_t v : asked) {
      is_asked[v] = true;
      around_[v].clear();
    }
    for (std::size_t t = 0; t < tetrahedra_.size(); ++t)
      for (const std::uint32_t v : tetrahedra_[t])
        if (is_asked[v]) around_[v].push_back(t);
  }

  // Since the last time that it was asked to move.
  bool has_changed_around(std::uint32_t v) const {
    return std::any_of(around_[v].begin(), around_[v].end(), [&](std::size_t t) {
      const Tetrahedron& corners = tetrahedra_[t];
      return std::any_of(corners.begin(), corners.end(), [&](std::uint32_t w) { return moved_[w] >= asked_[v]; });
    });
  }

  bool move(std::uint32_t v) {
    asked_[v] = now_;
    StarFaces faces;
    for (const std::size_t t : around_[v]) {
      const Tetrahedron& corners = tetrahedra_[t];
      std::array<Vec3, 3> face;
      std::size_t k = 0, own = 0;
      for (std::size_t i = 0; i < 4; ++i) {
        if (corners[i] == v)
          own = i;
        else
          face[k++] = nodes_[corners[i]];
      }
      // The rest of a positive tetrahedron sees its own corner from the one side or the other by turns.
      if (own % 2 == 0) std::swap(face[0], face[1]);
      faces.push_back(face);
    }
    const double before = star_quality(faces, nodes_[v]);
    double quality = before;
    Vec3 place = nodes_[v];
    if (!is_on_boundary(v)) {
      if (!relocate_max_min(faces, place, quality, steps)) return false;
      return take(v, place);
    }
    for (int step = 0; step < steps; ++step) {
      Vec3 next = place;
      double there = quality;
      if (!relocate_max_min(faces, next, there, 1)) break;
      next = allowed(v, next);
      there = star_quality(faces, next);
      if (!(there > quality)) break;
      place = next;
      quality = there;
    }
    return quality > least_gain * before && take(v, place);
  }

  bool take(std::uint32_t v, const Vec3& place) {
    nodes_[v] = place;
    moved_[v] = now_;
    return true;
  }

  Vec3 allowed(std::uint32_t v, const Vec3& place) const {
    Vec3 way = place - given_[v];
    const double off = way.dot(normals_[v]);
    way += (std::clamp(off, -most_off_, most_off_) - off) * normals_[v];
    const double most = longest_way * edge_[v];
    return given_[v] + (way.norm() > most ? most / way.norm() : 1) * way;
  }

  static constexpr double least_gain = 1.0005;  // as for other moves of the optimisation

  const std::vector<Tetrahedron>& tetrahedra_;
  std::vector<Vec3> nodes_;
  const std::vector<Vec3>& given_;
  std::vector<double> edge_;   // of the boundary, by vertex
  std::vector<Vec3> normals_;  // of the boundary, by vertex
  const std::vector<bool>& held_;
  double most_off_;
  std::vector<std::vector<std::size_t>> around_;  // of nodes that are asked
  // The sweep in which each node was last asked, and moved.
  std::vector<int> asked_, moved_;
  int now_ = 0;
};

}  // namespace

std::vector<Vec3> relocate_boundary(const TetMesh& mesh, const SurfaceMesh& boundary, const std::vector<bool>& held,
                                    double most_off, double least_dihedral_deg) {
  return BoundaryRelocation(mesh, boundary, held, most_off).run(least_dihedral_deg);
}

}  // namespace scan2fea
