// One shape growing over the points that it describes better than what they have.
#pragma once

#include "preproc/surface/primitives/shape_set.hpp"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace scan2fea {

// Neighbours that a first guess is made of.
inline constexpr std::size_t patch_size = 20;

// All that it is made of must outlive it; the set and the costs may change from one growth to the next.
class ShapeGrowth {
 public:
  // `described`: the shapes that there are; `cost`: of each point as these describe it.
  ShapeGrowth(const OrientedPoints& cloud, const Neighbours& neighbours, const ShapeNoise& noise,
              const ShapeSet& described, const std::vector<double>& cost)
      : cloud_(cloud),
        neighbours_(neighbours),
        noise_(noise),
        described_(described),
        cost_(cost),
        mark_(cloud.points.size(), 0) {}

  // Fits the shape to its points and spreads from them over others that it describes better than what they have, until
  // both stay. At most threefold at a time: a shape fitted to few points is not to be trusted far off. False where it
  // does not shorten the description, or leaves more than noise.
  bool grow(FoundShape& grown);

 private:
  std::vector<std::uint32_t> flooded(const Shape& shape, const std::vector<std::uint32_t>& from, std::size_t most);
  double saving(const Shape& shape, std::uint32_t i) const;
  bool rate(FoundShape& grown) const;

  const OrientedPoints& cloud_;
  const Neighbours& neighbours_;
  const ShapeNoise& noise_;
  const ShapeSet& described_;
  const std::vector<double>& cost_;
  std::vector<std::uint32_t> mark_;  // the last flood that came by
  std::uint32_t round_ = 0;
};

}  // namespace scan2fea
