#include "preproc/volume/vertex_insertion.hpp"

#include "preproc/volume/entropy_smoothing.hpp"
#include "preproc/volume/max_min_relocation.hpp"

#include <algorithm>
#include <limits>
#include <optional>

namespace scan2fea {
namespace {

constexpr std::size_t largest_cavity = 64;

double signed_volume(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
  return (b - a).cross(c - a).dot(d - a);
}

// Whether p lies within the circumsphere of a positive element. Rounding may err: the cavity's shape is checked by
// quality in any case.
bool in_circumsphere(const TetComplex& complex, std::uint32_t t, const Vec3& p) {
  const Tetrahedron& c = complex.element(t).corners;
  const Vec3 a = complex.node(c[0]) - p, b = complex.node(c[1]) - p, d = complex.node(c[2]) - p,
             e = complex.node(c[3]) - p;
  const Vec3 ab = a.cross(b), de = d.cross(e);
  // Cofactor expansion along the column of squared norms; positive inside for a positive element.
  return a.squaredNorm() * b.dot(de) - b.squaredNorm() * a.dot(de) + d.squaredNorm() * e.dot(ab) -
             e.squaredNorm() * d.dot(ab) >
         0;
}

// Walks from an element to the one that holds p; nothing if the boundary or too many elements lie between.
std::optional<std::uint32_t> locate(const TetComplex& complex, std::uint32_t t, const Vec3& p) {
  for (int step = 0; step < 16; ++step) {
    const TetComplex::Element& element = complex.element(t);
    std::uint32_t next = t;
    for (std::size_t k = 0; k < 4 && next == t; ++k) {
      const Triangle f = face_opposite(element.corners, k);
      if (signed_volume(complex.node(f[0]), complex.node(f[1]), complex.node(f[2]), p) > 0) next = element.link[k];
    }
    if (next == t) return t;
    if (next & TetComplex::boundary_bit) return std::nullopt;
    t = next;
  }
  return std::nullopt;
}

}  // namespace

bool VertexInsertion::mend(TetComplex& complex, std::uint32_t bad, double gain, double least) {
  const TetComplex::Element element = complex.element(bad);
  std::array<Vec3, 4> p;
  for (std::size_t k = 0; k < 4; ++k) p[k] = complex.node(element.corners[k]);

  for (std::size_t k = 0; k < 4; ++k) {
    if (!(element.link[k] & TetComplex::boundary_bit)) continue;
    const Vec3 &a = p[opposite_face[k][0]], &b = p[opposite_face[k][1]], &c = p[opposite_face[k][2]];
    const Vec3 inwards = -(b - a).cross(c - a).normalized();
    const double mean_edge = ((b - a).norm() + (c - b).norm() + (a - c).norm()) / 3;
    for (const double depth : {0.45, 0.7}) {
      const Vec3 place = (a + b + c) / 3 + depth * mean_edge * inwards;
      const auto holds = locate(complex, bad, place);
      if (holds && insert(complex, bad, *holds, place, gain, least)) return true;
    }
  }
  if (insert(complex, bad, bad, (p[0] + p[1] + p[2] + p[3]) / 4, gain, least)) return true;
  TetComplex::Ring ring;
  for (std::size_t i = 0; i < 4; ++i)
    for (std::size_t j = i + 1; j < 4; ++j)
      if (complex.ring(bad, i, j, ring) && insert(complex, bad, bad, (p[i] + p[j]) / 2, gain, least)) return true;
  return false;
}

bool VertexInsertion::insert(TetComplex& complex, std::uint32_t bad, std::uint32_t holds_place, Vec3 place, double gain,
                             double least) {
  take_delaunay_cavity(complex, holds_place, place);
  if (!complex.marked(bad)) {
    complex.mark(bad);
    cavity_.push_back(bad);
  }
  find_faces(complex, place);
  improve_cavity(complex, bad, holds_place, place);

  double before = std::numeric_limits<double>::infinity(), after = before;
  for (const std::uint32_t t : cavity_) before = std::min(before, complex.quality(t));
  star_.clear();
  for (const CavityFace& f : faces_) {
    after = std::min(after, f.quality);
    star_.push_back({complex.node(f.corners[0]), complex.node(f.corners[1]), complex.node(f.corners[2])});
  }
  // Polishing rarely more than doubles.
  if (after <= 0 || after < 0.4 * before) return false;
  smooth_by_entropy(star_, place, after);
  const double wanted = std::max(before * gain, least);
  if (after < wanted) relocate_max_min(star_, place, after, 4);
  if (after < wanted) return false;

  const std::uint32_t vertex = complex.add_node(place);
  fresh_.clear();
  for (const CavityFace& f : faces_) {
    const Tetrahedron corners{f.corners[0], f.corners[1], f.corners[2], vertex};
    fresh_.push_back(
        {corners, goal_quality(complex.node(corners[0]), complex.node(corners[1]), complex.node(corners[2]), place)});
  }
  complex.replace(cavity_, fresh_);
  return true;
}

void VertexInsertion::take_delaunay_cavity(const TetComplex& complex, std::uint32_t holds_place, const Vec3& place) {
  complex.begin_marks();
  cavity_.assign(1, holds_place);
  complex.mark(holds_place);
  for (std::size_t i = 0; i < cavity_.size() && cavity_.size() < largest_cavity; ++i)
    for (const std::uint32_t n : complex.element(cavity_[i]).link) {
      if ((n & TetComplex::boundary_bit) || complex.marked(n) || !in_circumsphere(complex, n, place)) continue;
      complex.mark(n);
      cavity_.push_back(n);
    }
}

void VertexInsertion::find_faces(const TetComplex& complex, const Vec3& place) {
  faces_.clear();
  for (const std::uint32_t t : cavity_) {
    const TetComplex::Element& element = complex.element(t);
    for (std::size_t k = 0; k < 4; ++k) {
      const std::uint32_t n = element.link[k];
      if (!(n & TetComplex::boundary_bit) && complex.marked(n)) continue;
      const Triangle f = face_opposite(element.corners, k);
      faces_.push_back(
          {{f[0], f[2], f[1]}, t, n, goal_quality(complex.node(f[0]), complex.node(f[2]), complex.node(f[1]), place)});
    }
  }
}

void VertexInsertion::improve_cavity(const TetComplex& complex, std::uint32_t bad, std::uint32_t holds_place,
                                     const Vec3& place) {
  for (std::size_t round = 0; round < largest_cavity; ++round) {
    const auto worst = std::min_element(faces_.begin(), faces_.end(),
                                        [](const CavityFace& a, const CavityFace& b) { return a.quality < b.quality; });
    const bool may_grow = !(worst->outside & TetComplex::boundary_bit) && cavity_.size() < largest_cavity;
    const bool may_shrink = worst->inside != bad && worst->inside != holds_place;
    if (may_grow && grow(complex, *worst, place)) continue;
    if (may_shrink && shrink(complex, *worst, place)) continue;
    return;
  }
}

// Takes the element beyond the worst face if all the faces that this opens are better than it.
bool VertexInsertion::grow(const TetComplex& complex, const CavityFace& worst, const Vec3& place) {
  const std::uint32_t t = worst.outside;
  const TetComplex::Element& element = complex.element(t);
  const double to_beat = worst.quality;
  trial_.clear();
  for (std::size_t k = 0; k < 4; ++k) {
    const std::uint32_t n = element.link[k];
    if (!(n & TetComplex::boundary_bit) && complex.marked(n)) continue;
    const Triangle f = face_opposite(element.corners, k);
    const double quality = goal_quality(complex.node(f[0]), complex.node(f[2]), complex.node(f[1]), place, to_beat);
    if (quality <= to_beat) return false;
    trial_.push_back({{f[0], f[2], f[1]}, t, n, quality});
  }
  std::erase_if(faces_, [&](const CavityFace& f) { return f.outside == t; });
  faces_.insert(faces_.end(), trial_.begin(), trial_.end());
  complex.mark(t);
  cavity_.push_back(t);
  return true;
}

// Gives up the element behind the worst face if all the faces that this opens are better than it.
bool VertexInsertion::shrink(const TetComplex& complex, const CavityFace& worst, const Vec3& place) {
  const std::uint32_t t = worst.inside;
  const TetComplex::Element& element = complex.element(t);
  const double to_beat = worst.quality;
  trial_.clear();
  for (std::size_t k = 0; k < 4; ++k) {
    const std::uint32_t n = element.link[k];
    if ((n & TetComplex::boundary_bit) || !complex.marked(n)) continue;
    const Triangle f = face_opposite(element.corners, k);
    // The face as the neighbour sees it.
    const double quality = goal_quality(complex.node(f[0]), complex.node(f[1]), complex.node(f[2]), place, to_beat);
    if (quality <= to_beat) return false;
    trial_.push_back({f, n, t, quality});
  }
  std::erase_if(faces_, [&](const CavityFace& f) { return f.inside == t; });
  faces_.insert(faces_.end(), trial_.begin(), trial_.end());
  complex.unmark(t);
  std::erase(cavity_, t);
  return true;
}

}  // namespace scan2fea
