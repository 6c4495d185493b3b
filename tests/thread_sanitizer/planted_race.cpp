// A loop whose blocks write the same place. Run to see ThreadSanitizer say so: tests/CMakeLists.txt.
#include <tbb/parallel_for.h>

#include <cstddef>
#include <cstdio>

int main() {
  double sum = 0;
  tbb::parallel_for(std::size_t{0}, std::size_t{100}, [&](std::size_t i) { sum += static_cast<double>(i); });
  std::printf("%g\n", sum);
}
