// How a long computation tells how far it is, and how it is asked to stop.
#pragma once

#include "preproc/mesh/error.hpp"

#include <functional>
#include <string_view>

namespace scan2fea {

// Called from the thread that called the algorithm, at most a few hundred times per stage.
class Progress {
 public:
  // Returns false to ask the algorithm to stop. `fraction` is in [0, 1].
  using Callback = std::function<bool(std::string_view stage, double fraction)>;

  Progress() = default;
  explicit Progress(Callback callback) : callback_(std::move(callback)) {}

  // Throws Cancelled if the callback asks to stop. Algorithms call it at points where their state can be dropped.
  void operator()(std::string_view stage, double fraction) const {
    if (callback_ && !callback_(stage, fraction)) throw Cancelled();
  }

 private:
  Callback callback_;
};

}  // namespace scan2fea
