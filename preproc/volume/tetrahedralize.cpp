#include "preproc/volume/tetrahedralize.hpp"

#include "preproc/mesh/error.hpp"
#include "preproc/mesh/face_neighbours.hpp"
#include "preproc/mesh/require_memory.hpp"
#include "preproc/volume/estimate_tetrahedra.hpp"
#include "preproc/volume/fill_regions.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <string>

namespace scan2fea {
namespace {

// TetGen reads no exponents.
std::string plain_number(double x) {
  std::array<char, 512> text;
  const auto end = std::to_chars(text.data(), text.data() + text.size(), x, std::chars_format::fixed).ptr;
  return {text.data(), end};
}

std::string switches(const TetrahedralizeOptions& options, bool own_points) {
  // p: fill a surface; Q: quiet; J: keep unused nodes, so that numbers stay; Y: do not split the boundary; q: TetGen's
  // own points, until the radius-edge ratio holds and the smallest dihedral angle is 10 degrees.
  std::string text = "pQJ";
  if (!options.split_boundary) text += 'Y';
  if (own_points) {
    text += "q" + plain_number(options.grading) + "/10";
    if (options.max_volume) text += "a" + plain_number(*options.max_volume);
  }
  return text;
}

// Above this share of thin walls there is too little room for a lattice to be worth it. Below, it fills what is thick
// and keeps out of the thin walls, where TetGen's refinement has no room for points either and insertion sets the few
// that help.
constexpr double most_thin_walls = 0.6;

// With TetGen and the optimisation, 4 to 10 us on scans.
constexpr double processor_seconds_a_tetrahedron = 8e-6;

// With TetGen's child process; 508 where it was measured, at nine million.
void require_memory_of_tetrahedra(double count) {
  constexpr double bytes_each = 500;
  require_memory(count, bytes_each, "tetrahedra", "a larger --interior-size or --max-volume, or larger triangles");
}

// Of edges as long as this inside, at the least: a cell of the lattice holds 12, its edges are 0.911 of it. Where edges
// are told by those of the surface, the layer beneath its triangles is counted alone.
double least_tetrahedra(const SurfaceMesh& surface, const InteriorSize& size) {
  if (size.unit != InteriorSize::Unit::model)
    return static_cast<double>(surface.triangles.size()) / std::pow(std::min(1.0, size.value), 2);
  return 12 * std::abs(enclosed_volume(surface)) / std::pow(size.value / 0.911, 3);
}

// The lattice's edges in elements of a given volume: a cell of volume a^3 holds 12, and near the surface, where the
// lattice is cut, they may be larger by half.
InteriorSize limited(InteriorSize size, const std::optional<double>& max_volume, const SurfaceMesh& surface) {
  if (!max_volume) return size;
  const double edge = 0.911 * std::cbrt(12 * *max_volume / 1.5);
  if (size.unit == InteriorSize::Unit::model) return {std::min(size.value, edge), size.unit};
  const std::vector<double> sizes = surface_sizes(surface);
  const double largest = *std::max_element(sizes.begin(), sizes.end());
  return size.value * largest <= edge ? size : InteriorSize{edge, InteriorSize::Unit::model};
}

// The pieces of a split boundary, turned as the triangles that they lie on.
struct SplitBoundary {
  std::vector<Triangle> triangles;
  std::vector<std::uint32_t> parent;
};

SplitBoundary split_boundary(const TetgenOutput& output, const SurfaceMesh& surface) {
  SplitBoundary split;
  for (std::size_t i = 0; i < output.faces.size(); ++i) {
    const std::uint32_t parent = output.face_marker[i] - 1;
    Triangle t = output.faces[i];
    const Vec3& a = output.points[t[0]];
    const Vec3 normal = (output.points[t[1]] - a).cross(output.points[t[2]] - a);
    if (normal.dot(area_vector(surface, surface.triangles[parent])) < 0) std::swap(t[1], t[2]);
    split.triangles.push_back(t);
    split.parent.push_back(parent);
  }
  return split;
}

// TetGen would only say that nothing is enclosed.
void require_closed(const SurfaceMesh& surface) {
  if (surface.triangles.empty())
    throw NotMeshable({.what = "the surface has no triangles", .where = {}, .value = {}, .limit = {}, .advice = {}});
  std::size_t open = 0;
  Vec3 place = Vec3::Zero();
  const std::vector<Triangle> neighbours = face_neighbours(surface, VertexStars(surface));
  for (std::size_t f = 0; f < neighbours.size(); ++f)
    for (std::size_t k = 0; k < 3; ++k) {
      if (neighbours[f][k] != no_face) continue;
      const Triangle& t = surface.triangles[f];
      if (open++ == 0) place = (surface.vertices[t[(k + 1) % 3]] + surface.vertices[t[(k + 2) % 3]]) / 2;
    }
  if (open > 0)
    throw NotMeshable({.what = "the surface is not closed and manifold: no volume fits in it",
                       .where = {},
                       .value = std::to_string(open) + " sides of triangles without just one other beside them",
                       .limit = "none",
                       .advice = "scan2fea repair",
                       .at = place});
}

}  // namespace

TetrahedralizeResult tetrahedralize(const SurfaceMesh& surface, const TetrahedralizeOptions& options,
                                    const Progress& progress) {
  require_closed(surface);
  TetrahedralizeResult result;
  result.bound = surface_bound(surface);
  progress("interior points", 0);
  const InsideTest inside(surface);
  result.interior = options.interior;
  if (options.interior == InteriorPoints::automatic)
    result.interior =
        thin_wall_share(surface, inside) > most_thin_walls ? InteriorPoints::tetgen : InteriorPoints::lattice;
  const bool own_points = result.interior == InteriorPoints::tetgen;
  TetgenInput input{switches(options, own_points), surface.vertices, surface.triangles};
  if (own_points) {
    result.estimated_tetrahedra = estimate_with_tetgen(surface, options.max_volume);
  } else {
    const InteriorSize size = limited(options.interior_size, options.max_volume, surface);
    require_memory_of_tetrahedra(least_tetrahedra(surface, size));
    const std::vector<Vec3> points = lattice_points(surface, inside, size);
    input.points.insert(input.points.end(), points.begin(), points.end());
    result.estimated_tetrahedra = estimate_with_lattice(surface, points.size());
  }
  require_memory_of_tetrahedra(static_cast<double>(result.estimated_tetrahedra));
  if (options.most_tetrahedra && result.estimated_tetrahedra > *options.most_tetrahedra)
    throw NotMeshable({.what = "too many tetrahedra would be made",
                       .where = {},
                       .value = "about " + std::to_string(result.estimated_tetrahedra),
                       .limit = std::to_string(*options.most_tetrahedra),
                       .advice = "larger triangles or a larger --interior-size"});
  progress.announce("about " + std::to_string(result.estimated_tetrahedra) + " tetrahedra",
                    processor_seconds_a_tetrahedron * static_cast<double>(result.estimated_tetrahedra));

  TetgenOutput output = run_tetgen(input, options.tetgen, progress);
  std::vector<Triangle> triangles = surface.triangles;
  if (options.split_boundary) {
    SplitBoundary split = split_boundary(output, surface);
    triangles = std::move(split.triangles);
    result.boundary_parent = std::move(split.parent);
  }
  result.mesh =
      fill_regions(std::move(output.points), std::move(output.tetrahedra), triangles, surface.vertices.size());
  progress.tell("tetgen", 1);

  if (options.optimise)
    result.optimised = optimise_tetrahedra(result.mesh, surface.vertices.size(), *options.optimise, progress);
  return result;
}

}  // namespace scan2fea
