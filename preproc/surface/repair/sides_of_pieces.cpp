#include "preproc/surface/repair/sides_of_pieces.hpp"

#include "preproc/mesh/union_find.hpp"
#include "preproc/surface/kernel/solid_angle.hpp"
#include "preproc/surface/kernel/winding_number.hpp"
#include "preproc/surface/repair/face_marks.hpp"
#include "preproc/surface/repair/soup_adjacency.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace scan2fea {
namespace {

class Winding {
 public:
  Winding(const SurfaceMesh& surface, const Arrangement& arrangement)
      : surface_(surface), arrangement_(arrangement), of_all_(surface.vertices, surface.triangles) {}

  Sides beside(std::uint32_t triangle) const {
    const std::uint32_t face = arrangement_.face_of[triangle];
    const Vec3 p = centre_of(arrangement_.mesh, triangle);
    const Vec3 normal = area_vector(surface_, surface_.triangles[face]);
    std::vector<std::uint32_t> here{face};
    const auto& overlapping = arrangement_.overlapping;
    for (auto at = std::lower_bound(overlapping.begin(), overlapping.end(), std::pair(face, 0U));
         at != overlapping.end() && at->first == face; ++at)
      if (covers(at->second, p, normal)) here.push_back(at->second);
    std::sort(here.begin(), here.end());
    here.erase(std::unique(here.begin(), here.end()), here.end());

    // In its own plane a triangle's part is that of rounding, which is the same in the sum.
    double of_others = of_all_(p), step = 0;  // from outside to inside
    for (const std::uint32_t f : here) {
      of_others -= winding_of_triangle(surface_, surface_.triangles[f], p);
      step += normal.dot(area_vector(surface_, surface_.triangles[f])) > 0 ? 1 : -1;
    }
    return {static_cast<int>(std::lround(of_others - step / 2)), static_cast<int>(std::lround(of_others + step / 2)),
            here.front() == face};
  }

 private:
  // Whether a point of the face's plane lies within it.
  bool covers(std::uint32_t face, const Vec3& p, const Vec3& normal) const {
    const Triangle& t = surface_.triangles[face];
    double low = 0, high = 0;
    for (std::size_t i = 0; i < 3; ++i) {
      const Vec3 &a = surface_.vertices[t[i]], &b = surface_.vertices[t[(i + 1) % 3]];
      const double side = (b - a).cross(p - a).dot(normal);
      low = std::min(low, side);
      high = std::max(high, side);
    }
    return low == 0 || high == 0;
  }

  const SurfaceMesh& surface_;
  const Arrangement& arrangement_;
  const WindingNumber of_all_;
};

bool is_sliver(const SurfaceMesh& mesh, std::uint32_t face, double width) {
  const Triangle& t = mesh.triangles[face];
  double longest = 0;
  for (std::size_t i = 0; i < 3; ++i)
    longest = std::max(longest, (mesh.vertices[t[i]] - mesh.vertices[t[(i + 1) % 3]]).norm());
  return 2 * area_of(mesh, face) < width * longest;
}

// The sides of a piece are those of most of these triangles of it: a spike, whose triangles are the largest, may pass
// through its own shell, and slivers are too narrow to tell on which side of others they lie.
std::vector<std::uint32_t> witnesses(const SurfaceMesh& mesh, const std::vector<std::uint32_t>& piece) {
  constexpr std::size_t most = 9;
  std::vector<std::pair<double, std::uint32_t>> by_area;
  for (const std::uint32_t f : piece) by_area.emplace_back(-area_of(mesh, f), f);
  std::sort(by_area.begin(), by_area.end());
  const std::size_t step = piece.size() / (2 * most);
  if (step == 0) return {by_area[0].second};
  std::vector<std::uint32_t> some;
  for (std::size_t i = 0; i < most; ++i) some.push_back(by_area[i * step].second);
  return some;
}

Sides sides_of_piece(const SurfaceMesh& mesh, const std::vector<std::uint32_t>& piece, const Winding& winding) {
  std::vector<Sides> seen;
  for (const std::uint32_t f : witnesses(mesh, piece)) seen.push_back(winding.beside(f));
  const auto votes = [&](const Sides& sides) { return std::count(seen.begin(), seen.end(), sides); };
  return *std::max_element(seen.begin(), seen.end(),
                           [&](const Sides& a, const Sides& b) { return votes(a) < votes(b); });
}

}  // namespace

double rounding_of(const SurfaceMesh& mesh) {
  return 1e-10 * bounding_box(mesh.vertices).diagonal();
}

std::vector<Sides> find_sides(const SurfaceMesh& surface, const Arrangement& arrangement) {
  const SurfaceMesh& mesh = arrangement.mesh;
  const Winding winding(surface, arrangement);
  UnionFind joined(mesh.triangles.size());
  EdgeGroups(mesh).for_each([&](const std::uint32_t* first, const std::uint32_t* last) {
    if (last - first == 2) joined.unite(first[0] / 3, first[1] / 3);
  });
  std::vector<std::vector<std::uint32_t>> pieces(mesh.triangles.size());  // by their first
  for (std::uint32_t f = 0; f < mesh.triangles.size(); ++f) pieces[joined.find(f)].push_back(f);
  std::vector<Sides> sides(mesh.triangles.size());
  const double width = rounding_of(mesh);
  for (const auto& piece : pieces) {
    const bool is_wide =
        std::any_of(piece.begin(), piece.end(), [&](std::uint32_t f) { return !is_sliver(mesh, f, width); });
    if (!is_wide) continue;
    const Sides of_piece = sides_of_piece(mesh, piece, winding);
    for (const std::uint32_t f : piece) sides[f] = of_piece;
  }
  return sides;
}

}  // namespace scan2fea
