// Loops over index ranges on all cores whose outcome does not depend on their number: the blocks are fixed by the count
// alone. For this folder's .cpp files.
#pragma once

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cstddef>
#include <vector>

namespace scan2fea {

inline constexpr std::size_t parallel_block_size = 2048;

inline std::size_t parallel_block_count(std::size_t count) {
  return (count + parallel_block_size - 1) / parallel_block_size;
}

// body(first, last) for consecutive ranges that cover [0, count). Ranges must not write what others read.
template <class Body>
void for_each_block(std::size_t count, const Body& body) {
  const std::size_t blocks = parallel_block_count(count);
  const auto run = [&](std::size_t b) {
    body(b * parallel_block_size, std::min(count, (b + 1) * parallel_block_size));
  };
  if (blocks <= 1) {
    if (blocks == 1) run(0);
    return;
  }
  tbb::parallel_for(std::size_t{0}, blocks, run);
}

// Sum of body(first, last), added up in the order of the blocks, so that it is the same to the last bit.
template <class Body>
double sum_over_blocks(std::size_t count, const Body& body) {
  std::vector<double> partial(parallel_block_count(count), 0.0);
  for_each_block(
      count, [&](std::size_t first, std::size_t last) { partial[first / parallel_block_size] = body(first, last); });
  double sum = 0;
  for (const double p : partial) sum += p;
  return sum;
}

}  // namespace scan2fea
