#include "preproc/volume/tetrahedralize.hpp"

#include "preproc/mesh/error.hpp"
#include "preproc/volume/fill_regions.hpp"

#include <array>
#include <charconv>
#include <string>

namespace scan2fea {
namespace {

// TetGen reads no exponents.
std::string plain_number(double x) {
  std::array<char, 512> text;
  const auto end = std::to_chars(text.data(), text.data() + text.size(), x, std::chars_format::fixed).ptr;
  return {text.data(), end};
}

std::string switches(const TetrahedralizeOptions& options) {
  // p: fill a surface; Q: quiet; J: keep unused nodes, so that numbers stay; Y: do not split the boundary;
  // q: shape, with a smallest dihedral angle of 10 degrees.
  std::string text = "pQJ";
  if (!options.split_boundary) text += 'Y';
  text += "q" + plain_number(options.grading) + "/10";
  if (options.max_volume) text += "a" + plain_number(*options.max_volume);
  return text;
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

}  // namespace

TetrahedralizeResult tetrahedralize(const SurfaceMesh& surface, const TetrahedralizeOptions& options,
                                    const Progress& progress) {
  TetgenInput input{switches(options), surface.vertices, surface.triangles};
  TetgenOutput output = run_tetgen(input, options.limits, progress);

  TetrahedralizeResult result;
  if (options.split_boundary) {
    SplitBoundary split = split_boundary(output, surface);
    result.mesh =
        fill_regions(std::move(output.points), std::move(output.tetrahedra), split.triangles, surface.vertices.size());
    result.boundary_parent = std::move(split.parent);
  } else {
    result.mesh = fill_regions(std::move(output.points), std::move(output.tetrahedra), surface.triangles,
                               surface.vertices.size());
  }
  progress("tetgen", 1);
  return result;
}

}  // namespace scan2fea
