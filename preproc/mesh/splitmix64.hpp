// A hash of a number whose bits are as good as random, the same on every machine: what shall look random and not differ
// from run to run, nor with the number of threads, is drawn by the index of the thing that it is for.
// Source: Steele, Lea and Flood, "Fast splittable pseudorandom number generators" (OOPSLA 2014).
#pragma once

#include <cstdint>

namespace scan2fea {

// The generator's step from one state to the next, and so what the seeds of a sequence are apart.
inline constexpr std::uint64_t splitmix64_step = 0x9e3779b97f4a7c15;

// The generator's first number from the state x.
constexpr std::uint64_t splitmix64(std::uint64_t x) {
  x += splitmix64_step;
  x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9;
  x = (x ^ (x >> 27)) * 0x94d049bb133111eb;
  return x ^ (x >> 31);
}

}  // namespace scan2fea
