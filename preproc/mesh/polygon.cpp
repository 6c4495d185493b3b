#include "preproc/mesh/polygon.hpp"

#include <limits>
#include <optional>

namespace scan2fea {
namespace {

// Larger polygons are cut as a fan: the time for ears grows with the square of the corners, from 0.06 s for so many to
// 1 s for four times as many, and a file may hold a million.
constexpr std::size_t largest_exact_polygon = 1000;

// Newell's normal: the sum of the area vectors of any fan, whatever the polygon's shape. Not normalised.
Vec3 newell_normal(const SurfaceMesh& mesh, std::span<const std::uint32_t> corners) {
  Vec3 normal = Vec3::Zero();
  for (std::size_t k = 1; k + 1 < corners.size(); ++k)
    normal += area_vector(mesh, {corners[0], corners[k], corners[k + 1]});
  return normal;
}

class EarCutter {
 public:
  EarCutter(SurfaceMesh& mesh, std::span<const std::uint32_t> corners)
      : mesh_(mesh), normal_(newell_normal(mesh, corners)), left_(corners.begin(), corners.end()) {}

  void run() {
    while (left_.size() > 3) {
      const std::size_t tip = best_ear();
      mesh_.triangles.push_back(triangle_at(tip));
      left_.erase(left_.begin() + static_cast<std::ptrdiff_t>(tip));
    }
    mesh_.triangles.push_back(triangle_at(1));
  }

 private:
  std::uint32_t corner(std::size_t k) const { return left_[k % left_.size()]; }

  Triangle triangle_at(std::size_t tip) const { return {corner(tip + left_.size() - 1), corner(tip), corner(tip + 1)}; }

  std::size_t best_ear() const {
    std::optional<std::size_t> best_valid;
    std::size_t best_any = 0;
    double shortest_valid = std::numeric_limits<double>::infinity();
    double shortest_any = shortest_valid;
    for (std::size_t tip = 0; tip < left_.size(); ++tip) {
      const Triangle ear = triangle_at(tip);
      const double diagonal = (mesh_.vertices[ear[2]] - mesh_.vertices[ear[0]]).squaredNorm();
      if (diagonal < shortest_any) {
        shortest_any = diagonal;
        best_any = tip;
      }
      if (diagonal < shortest_valid && is_valid(ear)) {
        shortest_valid = diagonal;
        best_valid = tip;
      }
    }
    return best_valid.value_or(best_any);
  }

  // Turns the polygon's way, leaves a rest that does so too, and holds no other corner.
  bool is_valid(const Triangle& ear) const {
    if (turn(ear[0], ear[1], ear[2]) <= 0) return false;
    if (left_.size() == 4) {
      for (const std::uint32_t opposite : left_)
        if (opposite != ear[0] && opposite != ear[1] && opposite != ear[2] && turn(ear[0], ear[2], opposite) <= 0)
          return false;
      return true;
    }
    for (const std::uint32_t other : left_) {
      if (other == ear[0] || other == ear[1] || other == ear[2]) continue;
      if (turn(ear[0], ear[1], other) >= 0 && turn(ear[1], ear[2], other) >= 0 && turn(ear[2], ear[0], other) >= 0)
        return false;
    }
    return true;
  }

  // Positive where a, b, c turn counter-clockwise about the polygon's normal.
  double turn(std::uint32_t a, std::uint32_t b, std::uint32_t c) const {
    return area_vector(mesh_, {a, b, c}).dot(normal_);
  }

  SurfaceMesh& mesh_;
  Vec3 normal_;
  std::vector<std::uint32_t> left_;
};

}  // namespace

void append_polygon(SurfaceMesh& mesh, std::span<const std::uint32_t> corners) {
  if (corners.size() == 3) {
    mesh.triangles.push_back({corners[0], corners[1], corners[2]});
  } else if (corners.size() <= largest_exact_polygon) {
    EarCutter(mesh, corners).run();
  } else {
    for (std::size_t k = 1; k + 1 < corners.size(); ++k)
      mesh.triangles.push_back({corners[0], corners[k], corners[k + 1]});
  }
}

}  // namespace scan2fea
