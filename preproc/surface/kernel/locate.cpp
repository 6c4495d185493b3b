#include "preproc/surface/kernel/locate.hpp"

#include <algorithm>

namespace scan2fea {
namespace {

// Normals more than 53 degrees apart: the sample may sit on another sheet.
constexpr double least_normal_agreement = 0.6;
// A walk over a fine result needs one or two steps; one that needs more than this is circling.
constexpr int most_steps = 60;

// What the descent minimises: the squared distance, plus up to 1.6 triangle areas for opposed normals, so that a wall
// must be thicker than about 1.3 edges before the wrong side of it wins.
double badness(const WalkableMesh& on, const Sample& sample, std::uint32_t f, Location& at) {
  const Triangle& t = on.mesh.triangles[f];
  const Vec3& a = on.mesh.vertices[t[0]];
  const Vec3& b = on.mesh.vertices[t[1]];
  const Vec3& c = on.mesh.vertices[t[2]];
  at.face = f;
  at.barycentric = nearest_in_triangle(sample.point, a, b, c, at.clamped);
  const double squared_distance = (sample.point - point_at(on.mesh, at)).squaredNorm();
  const double disagreement = least_normal_agreement - sample.normal.dot(on.face_normals[f]);
  if (disagreement <= 0 || sample.normal.isZero()) return squared_distance;
  return squared_distance + disagreement * (b - a).cross(c - a).norm() / 2;
}

// How far the way from one end of a side to the other goes: none where both ends are one point.
double share(double from_one, double from_other) {
  return from_one > 0 ? from_one / (from_one - from_other) : 0;
}

// The latest faces that were added, and mostly all of them.
class TriedFaces {
 public:
  // Whether it is not known to be there already.
  bool add(std::uint32_t face) {
    const auto end = faces_.begin() + static_cast<std::ptrdiff_t>(std::min(count_, faces_.size()));
    if (std::find(faces_.begin(), end, face) != end) return false;
    faces_[count_++ % faces_.size()] = face;
    return true;
  }

 private:
  std::array<std::uint32_t, 32> faces_;  // two rings of a triangle
  std::size_t count_ = 0;
};

}  // namespace

std::array<double, 3> nearest_in_triangle(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c, bool& clamped) {
  const Vec3 ab = b - a;
  const Vec3 ac = c - a;
  const Vec3 ap = p - a;
  const double d1 = ab.dot(ap);
  const double d2 = ac.dot(ap);
  clamped = true;
  if (d1 <= 0 && d2 <= 0) return {1, 0, 0};
  const Vec3 bp = p - b;
  const double d3 = ab.dot(bp);
  const double d4 = ac.dot(bp);
  if (d3 >= 0 && d4 <= d3) return {0, 1, 0};
  const double vc = d1 * d4 - d3 * d2;
  if (vc <= 0 && d1 >= 0 && d3 <= 0) {
    const double s = share(d1, d3);
    return {1 - s, s, 0};
  }
  const Vec3 cp = p - c;
  const double d5 = ab.dot(cp);
  const double d6 = ac.dot(cp);
  if (d6 >= 0 && d5 <= d6) return {0, 0, 1};
  const double vb = d5 * d2 - d1 * d6;
  if (vb <= 0 && d2 >= 0 && d6 <= 0) {
    const double s = share(d2, d6);
    return {1 - s, 0, s};
  }
  const double va = d3 * d6 - d5 * d4;
  if (va <= 0 && d4 >= d3 && d5 >= d6) {
    const double s = share(d4 - d3, d6 - d5);
    return {0, 1 - s, s};
  }
  const double whole = va + vb + vc;
  if (!(whole > 0)) {  // no area, and rounding found no side that is nearest
    const double from_a = ap.squaredNorm(), from_b = bp.squaredNorm(), from_c = cp.squaredNorm();
    if (from_a <= from_b && from_a <= from_c) return {1, 0, 0};
    return from_b <= from_c ? std::array<double, 3>{0, 1, 0} : std::array<double, 3>{0, 0, 1};
  }
  clamped = false;
  return {va / whole, vb / whole, vc / whole};
}

Location descend_to_nearest(const WalkableMesh& on, const Sample& sample, std::uint32_t start) {
  Location best;
  double least = badness(on, sample, start, best);
  // The rings of two corners share faces, and those of two steps most of theirs. None that was tried can be better than
  // the best by now.
  TriedFaces tried;
  tried.add(start);
  for (bool improved = true; improved;) {
    improved = false;
    const Triangle& t = on.mesh.triangles[best.face];
    for (const std::uint32_t v : Triangle(t)) {
      for (const std::uint32_t corner : on.stars.corners(v)) {
        if (!tried.add(corner / 3)) continue;
        Location at;
        const double bad = badness(on, sample, corner / 3, at);
        if (bad < least) {
          least = bad;
          best = at;
          improved = true;
        }
      }
    }
  }
  return best;
}

Location locate(const WalkableMesh& on, const Sample& sample, std::uint32_t start, double suspicious_distance) {
  std::uint32_t f = start;
  std::uint32_t previous = no_face;
  for (int step = 0; step < most_steps; ++step) {
    const Triangle& t = on.mesh.triangles[f];
    const Vec3& a = on.mesh.vertices[t[0]];
    const Vec3& b = on.mesh.vertices[t[1]];
    const Vec3& c = on.mesh.vertices[t[2]];
    const Vec3 normal = (b - a).cross(c - a);
    const double squared = normal.squaredNorm();
    if (!(squared > 0)) break;
    const Vec3 ap = sample.point - a;
    const double of_b = ap.cross(c - a).dot(normal) / squared;
    const double of_c = (b - a).cross(ap).dot(normal) / squared;
    const std::array<double, 3> barycentric{1 - of_b - of_c, of_b, of_c};
    const auto least = std::min_element(barycentric.begin(), barycentric.end());
    if (*least >= 0) {
      const double distance = std::abs(ap.dot(normal)) / std::sqrt(squared);
      const bool agree = sample.normal.dot(normal) >= least_normal_agreement * std::sqrt(squared);
      if (distance > suspicious_distance || !agree) break;
      return {f, false, barycentric};
    }
    const auto k = static_cast<std::size_t>(least - barycentric.begin());
    const std::uint32_t next = on.neighbours[f][k];
    if (next == no_face) break;
    if (next == previous) {
      // Between two faces that both send the walk to the other: a ridge. The nearest point is on the edge, unless it
      // falls on an end of it.
      Location at{f, true, nearest_in_triangle(sample.point, a, b, c, at.clamped)};
      const bool on_edge = at.barycentric[(k + 1) % 3] > 0 && at.barycentric[(k + 2) % 3] > 0;
      const double distance_squared = (sample.point - point_at(on.mesh, at)).squaredNorm();
      const bool agree = sample.normal.dot(normal) >= least_normal_agreement * std::sqrt(squared);
      if (!on_edge || !agree || distance_squared > suspicious_distance * suspicious_distance) break;
      return at;
    }
    previous = f;
    f = next;
  }
  return descend_to_nearest(on, sample, f);
}

}  // namespace scan2fea
