// Takes the place of TBB's header, as parallel_for.h does and for its reason. One thread will do: the sort is TBB's
// own.
#pragma once

#include <algorithm>

namespace tbb {

template <class Iterator>
void parallel_sort(Iterator first, Iterator last) {
  std::sort(first, last);
}

}  // namespace tbb
