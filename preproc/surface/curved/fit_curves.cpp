#include "preproc/surface/curved/fit_curves.hpp"

#include "preproc/surface/curved/curve_fitter.hpp"
#include "preproc/surface/curved/curved_deviation.hpp"
#include "preproc/surface/curved/keep_curved_volume.hpp"
#include "preproc/surface/kernel/cut_surface.hpp"
#include "preproc/surface/kernel/rings.hpp"
#include "quality/self_intersections.hpp"
#include "quality/triangle_measures.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numeric>
#include <utility>

namespace scan2fea {
namespace {

// The third changes the RMS distance by less than a hundredth.
constexpr int rounds = 3;
// Of an edge's length: what would have to go farther belongs to another place of the scan.
constexpr double largest_bend = 0.25;
constexpr double least_angle_deg = 30;

// Corners along their normals, nodes of edges along that of both faces.
std::vector<Vec3> directions_of(const CurvedSurface& surface, bool keep_corners) {
  std::vector<Vec3> directions = vertex_normals(surface.corners);
  if (keep_corners) std::fill(directions.begin(), directions.end(), Vec3::Zero());
  directions.resize(surface.nodes(), Vec3::Zero());
  for (std::size_t f = 0; f < surface.corners.triangles.size(); ++f)
    for (std::size_t k = 3; k < 6; ++k)
      directions[surface.nodes_of(f)[k]] += area_vector(surface.corners, surface.corners.triangles[f]);
  for (std::size_t i = surface.corners.vertices.size(); i < directions.size(); ++i) directions[i].normalize();
  return directions;
}

// Nodes on lines go to them, and stay there.
void place_lines(CurvedSurface& surface, const FeatureNet& net, bool keep_corners, std::vector<Vec3>& directions) {
  for (const FeatureLine& line : net.lines)
    for (const VertexOnLine& at : line.vertices) {
      directions[at.vertex].setZero();
      if (!keep_corners) surface.corners.vertices[at.vertex] = line.point_at(at.place);
    }
  for (std::size_t e = 0; e < surface.edges.size(); ++e) surface.mid[e] = surface.middle(e);
  for (const LineEdge& piece : line_edges(net)) {
    const auto at = std::lower_bound(surface.edges.begin(), surface.edges.end(), piece.edge());
    const auto e = static_cast<std::size_t>(at - surface.edges.begin());
    const FeatureLine& line = net.lines[piece.line];
    const Vec3 on_line = line.point_at(middle_place(line, piece.from_place, piece.to_place));
    const double length = (surface.corners.vertices[piece.from] - surface.corners.vertices[piece.to]).norm();
    directions[surface.corners.vertices.size() + e].setZero();
    if ((on_line - surface.mid[e]).norm() <= largest_bend * length) surface.mid[e] = on_line;
  }
}

// Nodes in planes stay in them, as the corners of the straight surface are.
void place_planes(const SurfaceMesh& straight, const FeatureNet& net, const PlanesOfScan& planes,
                  CurvedSurface& surface, std::vector<Vec3>& directions) {
  if (planes.empty()) return;
  const std::vector<PlaneNumbers> of_corner = planes.planes_of(straight, net);
  for (std::size_t v = 0; v < of_corner.size(); ++v) {
    if (of_corner[v].empty()) continue;
    surface.corners.vertices[v] = straight.vertices[v];
    directions[v].setZero();
  }
  for (std::size_t e = 0; e < surface.edges.size(); ++e) {
    const auto& [a, b] = surface.edges[e];
    PlaneNumbers both;
    std::ranges::set_intersection(of_corner[a], of_corner[b], std::back_inserter(both));
    if (both.empty()) continue;
    surface.mid[e] += planes.step_onto(both, surface.mid[e]);
    directions[of_corner.size() + e].setZero();
  }
}

void sort_and_unique(std::vector<std::uint32_t>& values) {
  std::ranges::sort(values);
  values.erase(std::ranges::unique(values).begin(), values.end());
}

CurvedSurface cut_open(const SurfaceMesh& surface, const FeatureNet& net) {
  return CurvedSurface(cut_along(surface, edges_of(net)).mesh);
}

bool is_needle(const SurfaceMesh& mesh, const Triangle& t, double least_deg) {
  const auto shape = measure_triangle(mesh.vertices[t[0]], mesh.vertices[t[1]], mesh.vertices[t[2]]);
  return !shape || shape->min_angle_deg < least_deg;
}

// No edge bends farther than a quarter of its length, as where corners came near to one another.
void limit_bends(CurvedSurface& surface) {
  for (std::size_t e = 0; e < surface.edges.size(); ++e) {
    const Vec3 middle = surface.middle(e), bend = surface.mid[e] - middle;
    const auto& [a, b] = surface.edges[e];
    const double most = largest_bend * (surface.corners.vertices[a] - surface.corners.vertices[b]).norm();
    if (bend.norm() > most) surface.mid[e] = middle + most / bend.norm() * bend;
  }
}

void fit_nodes(CurvedSurface& surface, const std::vector<Vec3>& directions, const FeatureNet& net,
               const ReferenceSurface& scan, const Progress& progress) {
  CurvedSurface cut = cut_open(surface.corners, net);
  CurveFitter fitter(surface, cut, net.patch_of_face, scan);
  for (int round = 0; round < rounds; ++round) {
    progress("curved sides", round / (rounds + 1.0));
    fitter.step(directions);
  }
  progress("curved sides", rounds / (rounds + 1.0));
  limit_bends(surface);
}

// Of `faces`, those that meet others, each taken as four plane ones, and those whose corners went where they make a
// needle that is none in `straight`; with those that they meet. Sorted.
std::vector<std::uint32_t> spoilt_faces(const CurvedSurface& surface, const SurfaceMesh& straight,
                                        const std::vector<std::uint32_t>& faces) {
  std::vector<std::uint32_t> spoilt, quarters;
  for (const std::uint32_t f : faces)
    for (std::uint32_t q = 0; q < 4; ++q) quarters.push_back(4 * f + q);
  for (const FacePair& pair : find_self_intersections(in_four(surface), quarters))
    spoilt.insert(spoilt.end(), {pair.face / 4, pair.other / 4});
  for (const FacePair& pair : find_self_intersections(surface.corners, faces))
    spoilt.insert(spoilt.end(), {pair.face, pair.other});
  for (const std::uint32_t f : faces)
    if (is_needle(surface.corners, straight.triangles[f], least_angle_deg) &&
        !is_needle(straight, straight.triangles[f], least_angle_deg))
      spoilt.push_back(f);
  sort_and_unique(spoilt);
  return spoilt;
}

// Which faces are within the deviation that is to be kept if they are straight.
class NearerStraight {
 public:
  NearerStraight(const CurvedSurface& straight, const KeptDeviation* kept) : straight_(straight), kept_(kept) {}

  // Of these faces, but for those that are straight already. Each is measured once.
  std::vector<std::uint32_t> of(std::vector<std::uint32_t> faces, const std::vector<bool>& is_straight) {
    far_.resize(is_straight.size(), false);
    std::erase_if(faces, [&](std::uint32_t f) { return is_straight[f] || far_[f]; });
    constexpr double as_told = 1.02;  // bounds of curved faces are right to a hundredth, and so straight ones' come out
    const KeptDeviation kept{kept_->scan, as_told * kept_->distance};
    for (const std::uint32_t f : faces_beyond(straight_, kept, faces)) far_[f] = true;
    std::erase_if(faces, [&](std::uint32_t f) { return far_[f]; });
    return faces;
  }

 private:
  const CurvedSurface& straight_;
  const KeptDeviation* kept_;
  std::vector<bool> far_;
};

// Those that share a corner with one of these; sorted.
std::vector<std::uint32_t> faces_around(const CurvedSurface& surface, const std::vector<std::uint32_t>& faces) {
  FaceMarks marks(surface.corners.triangles.size(), 0);
  for (const std::uint32_t f : faces) marks[f] = 1;
  grow(surface.corners, marks, 1);
  std::vector<std::uint32_t> around;
  for (std::uint32_t f = 0; f < marks.size(); ++f)
    if (marks[f] != 0) around.push_back(f);
  return around;
}

}  // namespace

std::size_t settle(const CurvedSurface& straight, const VolumeKeeper& keep_volume, const KeptDeviation* kept,
                   CurvedSurface& fitted, std::vector<Vec3>& directions) {
  constexpr int trials = 40;
  const std::size_t count = straight.corners.triangles.size();
  std::vector<bool> is_straight(count, false);
  NearerStraight nearer(straight, kept);
  std::vector<std::uint32_t> changed(count);
  std::iota(changed.begin(), changed.end(), 0U);
  for (int trial = 0; trial < trials; ++trial) {
    CurvedSurface shifted = fitted;
    const bool keeps_volume = keep_volume(directions, shifted);
    std::vector<std::uint32_t> spoilt = spoilt_faces(shifted, straight.corners, changed);
    if (spoilt.empty() && kept != nullptr) spoilt = nearer.of(faces_beyond(shifted, *kept, changed), is_straight);
    if (spoilt.empty() && kept != nullptr && changed.size() < count) {
      changed.resize(count);
      std::iota(changed.begin(), changed.end(), 0U);
      spoilt = nearer.of(faces_beyond(shifted, *kept, changed), is_straight);
    }
    if (spoilt.empty()) {
      if (!keeps_volume) break;
      fitted = std::move(shifted);
      return static_cast<std::size_t>(std::ranges::count(is_straight, true));
    }
    for (const std::uint32_t f : spoilt) {
      is_straight[f] = true;
      for (const std::size_t i : straight.nodes_of(f)) {
        fitted.node(i) = straight.node(i);
        directions[i].setZero();
      }
    }
    changed = faces_around(straight, spoilt);
  }
  fitted = straight;
  std::fill(directions.begin(), directions.end(), Vec3::Zero());
  return count;
}

FittedCurves fit_curves(const SurfaceMesh& surface, const FeatureNet& net, const ReferenceSurface& scan,
                        const PlanesOfScan& planes, bool keep_corners, const KeptDeviation* kept,
                        const Progress& progress) {
  const CurvedSurface straight(surface);
  FittedCurves fitted{.surface = straight, .directions = {}, .volumes = volumes_of_components(surface)};
  fitted.directions = directions_of(fitted.surface, keep_corners);
  place_lines(fitted.surface, net, keep_corners, fitted.directions);
  place_planes(surface, net, planes, fitted.surface, fitted.directions);
  fit_nodes(fitted.surface, fitted.directions, net, scan, progress);
  const auto keep_volume = [&](const std::vector<Vec3>& directions, CurvedSurface& shifted) {
    return keep_curved_volume(shifted, fitted.volumes, directions);
  };
  fitted.straight = settle(straight, keep_volume, kept, fitted.surface, fitted.directions);
  return fitted;
}

std::vector<Vec3> fit_piece(CurvedSurface& surface, const std::vector<bool>& is_held, const FeatureNet& net,
                            const ReferenceSurface& scan, const Progress& progress) {
  const CurvedSurface given = surface;
  std::vector<Vec3> directions = directions_of(surface, false);
  place_lines(surface, net, false, directions);
  for (std::size_t i = 0; i < is_held.size(); ++i) {
    if (!is_held[i]) continue;
    surface.node(i) = given.node(i);
    directions[i].setZero();
  }
  fit_nodes(surface, directions, net, scan, progress);
  return directions;
}

}  // namespace scan2fea
