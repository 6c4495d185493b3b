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

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <exception>
#include <mutex>
#include <thread>
#include <vector>

namespace tbb {

// Four threads also where there are two cores, unless a test asks for one.
template <class Index, class Body>
void parallel_for(Index first, Index last, const Body& body) {
  std::atomic<Index> next = first;
  std::exception_ptr failure;
  std::mutex failing;
  const auto work = [&] {
    // Relaxed, so that the counter itself puts no order between the threads, which would hide races.
    for (Index i; (i = next.fetch_add(1, std::memory_order_relaxed)) < last;) try {
        body(i);
      } catch (...) {
        const std::scoped_lock lock(failing);
        failure = std::current_exception();
        next = last;
      }
  };
  std::vector<std::thread> threads;
  if (global_control::active_value(global_control::max_allowed_parallelism) > 1)
    for (int k = 0; k < 3 && first + k + 1 < last; ++k) threads.emplace_back(work);
  work();
  for (std::thread& thread : threads) thread.join();
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
