// Takes the place of TBB's header where the preset `thread` compiles for ThreadSanitizer: the same loops over
// std::thread.
//
// Debian's libtbb is not instrumented. ThreadSanitizer does not see how it hands tasks to its threads and waits for
// them, so it takes all that a body reads from before the loop, and all that is read of its results after, for races. A
// suppression of these reports would cover ours too: every body runs below TBB's frames. Over std::thread every report
// is ours.
#pragma once

#include <tbb/blocked_range.h>
#include <tbb/global_control.h>

#include <cstddef>
#include <exception>
#include <mutex>
#include <thread>
#include <vector>

namespace tbb {

// Four threads also where there are fewer cores, unless a test asks for one. Each has its share fixed beforehand: were
// shares taken as threads come, one would often be through before the next has begun, and no race would be seen.
template <class Index, class Body>
void parallel_for(Index first, Index last, const Body& body) {
  const bool alone = global_control::active_value(global_control::max_allowed_parallelism) == 1;
  const Index threads = alone ? 1 : 4;
  std::exception_ptr failure;
  std::mutex failing;
  const auto work = [&](Index offset) {
    try {
      for (Index i = first + offset; i < last; i += threads) body(i);
    } catch (...) {
      const std::scoped_lock lock(failing);
      failure = std::current_exception();
    }
  };
  std::vector<std::thread> others;
  for (Index offset = 1; offset < threads && first + offset < last; ++offset) others.emplace_back(work, offset);
  work(0);
  for (std::thread& thread : others) thread.join();
  if (failure) std::rethrow_exception(failure);
}

template <class Range, class Body>
void parallel_for(const Range& range, const Body& body) {
  std::vector<Range> pieces;
  if (!range.empty()) pieces.push_back(range);
  for (std::size_t k = 0; k < pieces.size();) {
    if (pieces[k].is_divisible())
      pieces.push_back(Range(pieces[k], split()));
    else
      ++k;
  }
  parallel_for(std::size_t{0}, pieces.size(), [&](std::size_t k) { body(pieces[k]); });
}

}  // namespace tbb
