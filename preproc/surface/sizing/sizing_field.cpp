#include "preproc/surface/sizing/sizing_field.hpp"

#include "preproc/mesh/error.hpp"
#include "preproc/mesh/median.hpp"
#include "preproc/surface/kernel/adjacency.hpp"
#include "preproc/surface/kernel/components.hpp"
#include "preproc/surface/kernel/parallel_blocks.hpp"
#include "preproc/surface/kernel/tangent_frame.hpp"
#include "quality/triangle_measures.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <queue>
#include <string>

namespace scan2fea {
namespace {

// Radii above so many edge lengths count as flat.
constexpr double flat_radius = 20;

// For a deviation d: h^2 = 7.6 d / curvature, within 3 to 36 d. A chord of length h leaves a circle of radius r by
// h^2 / 8 r; a fitted triangle, whose vertices lie beyond the surface, by less. Details narrower than 4 d count as
// rough, not as bent.
constexpr double squared_length_over_deviation = 7.6, shortest_over_deviation = 3;
constexpr double smoothing_over_deviation = 4;

// What all steps read of the scan.
struct Scan {
  explicit Scan(const SurfaceMesh& surface) : mesh(surface), areas(surface.vertices.size(), 0.0) {
    for (const Triangle& t : mesh.triangles) {
      const double third = area_vector(mesh, t).norm() / 6;
      area += 3 * third;
      for (const std::uint32_t v : t) areas[v] += third;
    }
    // One neighbour per corner: on a closed surface each edge is there from both ends; at a border one end is missing,
    // which averages do not mind.
    first.assign(mesh.vertices.size() + 1, 0);
    for (const Triangle& t : mesh.triangles)
      for (const std::uint32_t v : t) ++first[v + 1];
    std::partial_sum(first.begin(), first.end(), first.begin());
    neighbours.resize(3 * mesh.triangles.size());
    std::vector<std::uint32_t> next(first.begin(), first.end() - 1);
    for (const Triangle& t : mesh.triangles)
      for (std::size_t k = 0; k < 3; ++k) neighbours[next[t[k]]++] = t[(k + 1) % 3];
  }

  template <class Visit>
  void for_each_neighbour(std::size_t vertex, const Visit& visit) const {
    for (std::uint32_t i = first[vertex]; i < first[vertex + 1]; ++i) visit(neighbours[i]);
  }

  const SurfaceMesh& mesh;
  std::vector<std::uint32_t> first, neighbours;
  std::vector<double> areas;  // a third of the triangles around each vertex
  double area = 0;
};

void check(const SizingOptions& options, const SurfaceMesh& mesh) {
  const auto require = [](bool good, const char* what, double value, const char* limit) {
    if (!good)
      throw WrongUsage({.what = what, .where = "sizing", .value = std::to_string(value), .limit = limit, .advice = {}});
  };
  require(options.triangles > 0, "number of triangles out of range", options.triangles, "above 0");
  require(options.strength >= 0 && options.strength <= 1, "strength out of range", options.strength, "0 to 1");
  require(options.smallest > 0 && options.smallest <= 1, "smallest edge length out of range", options.smallest,
          "0 to 1");
  require(options.largest >= 1, "largest edge length out of range", options.largest, "1 or more");
  require(options.gradation >= 0.02 && options.gradation <= 1, "gradation out of range", options.gradation,
          "0.02 to 1");
  require(options.factors.empty() || options.factors.size() == mesh.vertices.size(), "one factor per vertex needed",
          static_cast<double>(options.factors.size()), "the number of vertices");
}

// values[v] = of(v) for all v, on all cores.
template <class Value>
void set_each(std::vector<Value>& values, const auto& of) {
  for_each_block(values.size(), [&](std::size_t first, std::size_t last) {
    for (std::size_t v = first; v < last; ++v) values[v] = of(v);
  });
}

// One sweep of averaging: half of the old value, half of the neighbours' mean.
template <class Value>
void average_with_neighbours(const Scan& scan, std::vector<Value>& values, int sweeps) {
  std::vector<Value> next(values.size());
  for (int sweep = 0; sweep < sweeps; ++sweep) {
    for_each_block(values.size(), [&](std::size_t first, std::size_t last) {
      for (std::size_t v = first; v < last; ++v) {
        Value sum = values[v] * 0;
        double count = 0;
        scan.for_each_neighbour(v, [&](std::uint32_t w) {
          sum += values[w];
          ++count;
        });
        next[v] = count > 0 ? Value((values[v] + sum * (1 / count)) * 0.5) : values[v];
      }
    });
    values.swap(next);
  }
}

// Squared Frobenius norm of the shape operator, k1^2 + k2^2, per vertex: the symmetric 2 x 2 matrix S with S d = dn in
// the least-squares sense over the star's edges d and the changes dn of the normal along them.
std::vector<double> squared_curvature(const Scan& scan, const std::vector<Vec3>& normals) {
  std::vector<double> result(normals.size(), 0.0);
  for_each_block(normals.size(), [&](std::size_t first, std::size_t last) {
    for (std::size_t v = first; v < last; ++v) {
      const TangentFrame frame(normals[v]);
      double xx = 0, xy = 0, yy = 0, bp = 0, bq = 0, br = 0;
      scan.for_each_neighbour(v, [&](std::uint32_t w) {
        const Vec3 edge = scan.mesh.vertices[w] - scan.mesh.vertices[v];
        const double length2 = edge.squaredNorm();
        if (!(length2 > 0)) return;
        const Vec3 turn = normals[w] - normals[v];
        const double x = edge.dot(frame.x), y = edge.dot(frame.y);
        const double nx = turn.dot(frame.x), ny = turn.dot(frame.y);
        xx += x * x / length2;
        xy += x * y / length2;
        yy += y * y / length2;
        bp += x * nx / length2;
        bq += (y * nx + x * ny) / length2;
        br += y * ny / length2;
      });
      Eigen::Matrix3d m;
      m << xx, xy, 0, xy, xx + yy, xy, 0, xy, yy;
      // A star whose edges all run in one direction says nothing about the other: a little damping picks no curvature.
      m.diagonal().array() += 1e-3 * (xx + yy);
      if (!(xx + yy > 0)) continue;
      const Vec3 s = m.ldlt().solve(Vec3(bp, bq, br));
      result[v] = s[0] * s[0] + 2 * s[1] * s[1] + s[2] * s[2];
    }
  });
  return result;
}

// Natural logarithm of the edge length up to a constant, from curvature.
std::vector<double> log_length_from_curvature(const Scan& scan, double uniform_length, int sweeps_factor,
                                              double strength) {
  std::vector<Vec3> normals = vertex_normals(scan.mesh);
  average_with_neighbours(scan, normals, 4 * sweeps_factor);
  set_each(normals, [&](std::size_t v) { return Vec3(normals[v].normalized()); });
  std::vector<double> curvature2 = squared_curvature(scan, normals);
  average_with_neighbours(scan, curvature2, 5 * sweeps_factor);

  // On a part that is mostly flat the median is zero.
  const double offset = std::max(median(curvature2), 1 / std::pow(flat_radius * uniform_length, 2));
  std::vector<double> phi(curvature2.size());
  set_each(phi, [&](std::size_t v) { return -0.5 * strength * std::log(curvature2[v] + offset); });
  return phi;
}

// Squared curvature of what is left of the surface when details narrower than `width` are smoothed away.
std::vector<double> squared_curvature_over(const Scan& scan, double width) {
  constexpr long most_sweeps = 30;  // what is smoother than that has long edges anyway
  const double edge = equilateral_edge(scan.area, static_cast<double>(scan.mesh.triangles.size()));
  // Averaging over k rings reaches about sqrt(k) edges.
  const double rings = std::min(width / edge, std::sqrt(static_cast<double>(most_sweeps)));
  const int sweeps = static_cast<int>(std::clamp(std::lround(rings * rings), 1L, most_sweeps));
  std::vector<Vec3> normals = vertex_normals(scan.mesh);
  average_with_neighbours(scan, normals, sweeps);
  set_each(normals, [&](std::size_t v) { return Vec3(normals[v].normalized()); });
  std::vector<double> curvature2 = squared_curvature(scan, normals);
  average_with_neighbours(scan, curvature2, sweeps);
  return curvature2;
}

// h_i <= h_j + gradation |x_i - x_j| along the scan's edges; lengths only fall. Dijkstra from the vertices that bind.
void limit_gradation(const Scan& scan, double gradation, std::vector<double>& length) {
  using Entry = std::pair<double, std::uint32_t>;
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> queue;
  const auto relax = [&](std::uint32_t v) {
    scan.for_each_neighbour(v, [&](std::uint32_t w) {
      const double limit = length[v] + gradation * (scan.mesh.vertices[w] - scan.mesh.vertices[v]).norm();
      if (limit < length[w] * (1 - 1e-9)) {
        length[w] = limit;
        queue.emplace(limit, w);
      }
    });
  };
  std::vector<char> binds(length.size(), 0);
  for_each_block(length.size(), [&](std::size_t first, std::size_t last) {
    for (std::size_t v = first; v < last; ++v) {
      scan.for_each_neighbour(v, [&](std::uint32_t w) {
        const double limit = length[v] + gradation * (scan.mesh.vertices[w] - scan.mesh.vertices[v]).norm();
        if (limit < length[w] * (1 - 1e-9)) binds[v] = 1;
      });
    }
  });
  for (std::uint32_t v = 0; v < length.size(); ++v)
    if (binds[v]) queue.emplace(length[v], v);
  while (!queue.empty()) {
    const auto [at, v] = queue.top();
    queue.pop();
    if (at <= length[v]) relax(v);
  }
}

// The same on a scan that is cut along its features: of the copies of a vertex the shortest length counts.
std::vector<double> log_length_from_curvature(const CutSurface& cut, std::size_t vertices, double uniform_length,
                                              int sweeps_factor, double strength) {
  const std::vector<double> of_copy =
      log_length_from_curvature(Scan(cut.mesh), uniform_length, sweeps_factor, strength);
  std::vector<double> phi(vertices, std::numeric_limits<double>::infinity());
  for (std::size_t c = 0; c < of_copy.size(); ++c)
    phi[cut.vertex_of_copy[c]] = std::min(phi[cut.vertex_of_copy[c]], of_copy[c]);
  return phi;
}

// Scales to the wanted number of triangles, after giving small components theirs.
void scale_to_count(const Scan& scan, const SizingOptions& options, const Components& components,
                    std::vector<double>& length) {
  bool again = true;
  for (int round = 0; round < 10 && again; ++round) {
    std::vector<double> share(components.count, 0.0);
    for (std::size_t v = 0; v < length.size(); ++v)
      share[components.of_vertex[v]] += scan.areas[v] / (equilateral_area * length[v] * length[v]);
    const double count = std::accumulate(share.begin(), share.end(), 0.0);
    // Where a component is enlarged the others' shares change; that settles after a round or two.
    std::vector<double> scale(components.count, std::sqrt(count / options.triangles));
    again = false;
    for (std::size_t c = 0; c < scale.size(); ++c) {
      const double wanted = options.triangles_per_component * (scale[c] * scale[c]);
      if (share[c] >= 0.99 * wanted || components.count == 1) continue;
      scale[c] *= std::sqrt(share[c] / wanted);
      again = true;
    }
    set_each(length, [&](std::size_t v) { return length[v] * scale[components.of_vertex[v]]; });
  }
}

}  // namespace

double predicted_triangles(const SurfaceMesh& scan, const SizingField& field) {
  double count = 0;
  for (const Triangle& t : scan.triangles) {
    const double third = area_vector(scan, t).norm() / 6;
    for (const std::uint32_t v : t) count += third / (equilateral_area * field.edge_length[v] * field.edge_length[v]);
  }
  return count;
}

void ask_for_lengths(const SurfaceMesh& scan, std::span<const double> edge_length, SizingOptions& options) {
  options.sizing = Sizing::uniform;  // but for the factors; the number of triangles sets their scale
  options.factors = edge_length;
  options.smallest = 0.01;
  options.largest = 100;
  options.triangles = predicted_triangles(scan, {{edge_length.begin(), edge_length.end()}});
}

void limit_gradation(const SurfaceMesh& scan, double gradation, std::vector<double>& edge_length) {
  limit_gradation(Scan(scan), gradation, edge_length);
}

std::vector<double> lengths_for_deviation(const SurfaceMesh& mesh, double deviation, double roughness, double gradation,
                                          const CutSurface* cut) {
  const double width = smoothing_over_deviation * (deviation + roughness);
  std::vector<double> curvature2(mesh.vertices.size(), 0.0);
  if (cut) {
    const std::vector<double> of_copy = squared_curvature_over(Scan(cut->mesh), width);
    for (std::size_t v = 0; v < of_copy.size(); ++v) {
      double& largest = curvature2[cut->vertex_of_copy[v]];
      largest = std::max(largest, of_copy[v]);
    }
  } else {
    curvature2 = squared_curvature_over(Scan(mesh), width);
  }
  std::vector<double> length(curvature2.size());
  set_each(length, [&](std::size_t v) {
    const double wanted = std::sqrt(squared_length_over_deviation * deviation / std::sqrt(curvature2[v]));
    return std::clamp(wanted, shortest_over_deviation * deviation, longest_over_deviation * deviation);
  });
  limit_gradation(mesh, gradation, length);
  return length;
}

SizingField compute_sizing_field(const SurfaceMesh& mesh, const SizingOptions& options, const CutSurface* cut) {
  check(options, mesh);
  const Scan scan(mesh);
  if (!(scan.area > 0)) {
    throw InvalidInput({.what = "the surface has no area",
                        .where = {},
                        .value = std::to_string(scan.area),
                        .limit = "above 0",
                        .advice = "check the file and its units"});
  }
  const double uniform_length = equilateral_edge(scan.area, options.triangles);
  // Mean edge of the scan if its triangles were equilateral. Averaging over k rings reaches sqrt(k) edges: the number
  // of sweeps that is one unit of width where the scan has about eight triangles for one of the result.
  const double scan_length = equilateral_edge(scan.area, static_cast<double>(mesh.triangles.size()));
  const double density = uniform_length / scan_length;
  const int sweeps_factor = static_cast<int>(std::clamp(std::lround(density * density / 8), 1L, 3L));

  std::vector<double> phi(mesh.vertices.size(), 0.0);
  if (options.sizing != Sizing::uniform)
    phi = cut ? log_length_from_curvature(*cut, phi.size(), uniform_length, sweeps_factor, options.strength)
              : log_length_from_curvature(scan, uniform_length, sweeps_factor, options.strength);
  for (std::size_t v = 0; v < options.factors.size(); ++v) phi[v] += std::log(options.factors[v]);

  const Components components = find_components(mesh);
  std::vector<double> length(phi.size());
  set_each(length, [&](std::size_t v) { return std::exp(phi[v]); });
  // Clamps and gradation are relative to the scale, so it comes first; it is nearly one afterwards.
  scale_to_count(scan, options, components, length);
  if (options.sizing != Sizing::uniform || !options.factors.empty()) {
    set_each(phi, [&](std::size_t v) {
      return std::log(std::clamp(length[v], options.smallest * uniform_length, options.largest * uniform_length));
    });
    average_with_neighbours(scan, phi, 10 * sweeps_factor);
    set_each(length, [&](std::size_t v) { return std::exp(phi[v]); });
    // What the limit takes the scale gives back, and steepens again by as much; a few rounds end that.
    for (int round = 0; round < 4; ++round) {
      limit_gradation(scan, options.gradation, length);
      const double limited = length.front();
      scale_to_count(scan, options, components, length);
      if (length.front() < 1.03 * limited) break;
    }
  }
  return {std::move(length)};
}

}  // namespace scan2fea
