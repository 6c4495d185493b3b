#include "preproc/volume/multi_face_removal.hpp"

#include "preproc/volume/tet_quality.hpp"

#include <algorithm>
#include <limits>

namespace scan2fea {
namespace {

constexpr std::size_t most_faces = 6;

// A sandwiched face is the pair of elements on its sides: the upper one has the apex `a`, the lower one `b`.
class Sandwich {
 public:
  Sandwich(const TetComplex& complex, std::uint32_t a, std::uint32_t b) : complex_(complex), a_(a), b_(b) {}

  // The best that can be made of a face, counter-clockwise seen from a, and what lies beyond its edges.
  void take_root(std::uint32_t upper, std::uint32_t lower, const Triangle& face) {
    old_[0] = upper;
    old_[1] = lower;
    old_size_ = 2;
    for (std::size_t k = 0; k < 3 && min_fresh_ > floor(); ++k) take_edge(face[k], face[(k + 1) % 3], upper, lower);
  }

  bool improves(double gain) const { return min_fresh_ > std::max(floor() * gain, 0.0); }
  std::span<const std::uint32_t> old() const { return std::span(old_).first(old_size_); }
  std::span<const TetComplex::Fresh> fresh() const { return std::span(fresh_).first(fresh_size_); }

 private:
  double floor() const {
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t k = 0; k < old_size_; ++k) least = std::min(least, complex_.quality(old_[k]));
    return least;
  }

  // Closes the cavity at the edge from v to w, or takes the face beyond the edge where that is better.
  void take_edge(std::uint32_t v, std::uint32_t w, std::uint32_t upper, std::uint32_t lower) {
    const Tetrahedron closing{a_, b_, w, v};
    const double here = goal_quality(complex_.node(a_), complex_.node(b_), complex_.node(w), complex_.node(v));
    const std::size_t old_size = old_size_, fresh_size = fresh_size_;
    const double min_fresh = min_fresh_;
    std::uint32_t next_upper, next_lower, x;
    if (old_size_ < 2 * most_faces && here < min_fresh_ && face_beyond(v, w, upper, lower, next_upper, next_lower, x)) {
      old_[old_size_++] = next_upper;
      old_[old_size_++] = next_lower;
      min_fresh_ = std::numeric_limits<double>::infinity();
      take_edge(v, x, next_upper, next_lower);
      if (min_fresh_ > here) take_edge(x, w, next_upper, next_lower);
      if (min_fresh_ > here) {
        min_fresh_ = std::min(min_fresh_, min_fresh);
        return;
      }
      old_size_ = old_size;
      fresh_size_ = fresh_size;
    }
    fresh_[fresh_size_++] = {closing, here};
    min_fresh_ = std::min(min_fresh, here);
  }

  // The face (w, v, x) that shares the edge and lies between the same apexes.
  bool face_beyond(std::uint32_t v, std::uint32_t w, std::uint32_t upper, std::uint32_t lower,
                   std::uint32_t& next_upper, std::uint32_t& next_lower, std::uint32_t& x) const {
    next_upper = across(upper, a_, v, w, x);
    if (next_upper == no_link) return false;
    std::uint32_t y = no_link;
    next_lower = across(lower, b_, v, w, y);
    if (next_lower == no_link || x != y) return false;
    return std::find(old_.begin(), old_.begin() + static_cast<std::ptrdiff_t>(old_size_), next_upper) ==
           old_.begin() + static_cast<std::ptrdiff_t>(old_size_);
  }

  // The neighbour of t across its face (apex, v, w), and the corner there that is not on that face.
  std::uint32_t across(std::uint32_t t, std::uint32_t apex, std::uint32_t v, std::uint32_t w, std::uint32_t& x) const {
    const Tetrahedron& c = complex_.element(t).corners;
    const std::uint32_t u = c[0] ^ c[1] ^ c[2] ^ c[3] ^ apex ^ v ^ w;
    const std::uint32_t n = complex_.element(t).link[corner_of(c, u)];
    if (n & TetComplex::boundary_bit) return no_link;
    const Tetrahedron& d = complex_.element(n).corners;
    x = d[0] ^ d[1] ^ d[2] ^ d[3] ^ apex ^ v ^ w;
    return n;
  }

  const TetComplex& complex_;
  std::uint32_t a_, b_;
  std::array<std::uint32_t, 2 * most_faces> old_;
  std::size_t old_size_ = 0;
  std::array<TetComplex::Fresh, most_faces + 2> fresh_;
  std::size_t fresh_size_ = 0;
  double min_fresh_ = std::numeric_limits<double>::infinity();
};

}  // namespace

bool remove_faces(TetComplex& complex, std::uint32_t t, std::size_t corner, double gain) {
  const TetComplex::Element& upper = complex.element(t);
  const std::uint32_t n = upper.link[corner];
  if (n & TetComplex::boundary_bit) return false;
  const Triangle face = face_opposite(upper.corners, corner);
  const Tetrahedron& lower = complex.element(n).corners;
  const std::uint32_t a = upper.corners[corner];
  const std::uint32_t b = lower[0] ^ lower[1] ^ lower[2] ^ lower[3] ^ face[0] ^ face[1] ^ face[2];
  Sandwich sandwich(complex, a, b);
  // Outward from a's element is clockwise seen from a.
  sandwich.take_root(t, n, {face[0], face[2], face[1]});
  if (!sandwich.improves(gain)) return false;
  complex.replace(sandwich.old(), sandwich.fresh());
  return true;
}

}  // namespace scan2fea
