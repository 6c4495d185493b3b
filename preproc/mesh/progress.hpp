// How a long computation tells how far it is, and how it is asked to stop, or to come to an end in time.
#pragma once

#include "preproc/mesh/error.hpp"

#include <algorithm>
#include <chrono>
#include <functional>
#include <memory>
#include <string_view>

namespace scan2fea {

// Called from the thread that called the algorithm, at most a few hundred times per stage.
class Progress {
 public:
  // Returns false to ask the algorithm to stop. `fraction` is in [0, 1].
  using Callback = std::function<bool(std::string_view stage, double fraction)>;
  // Told before a piece of work what it is, and about how long it takes on one processor, by what is to be made of how
  // much.
  using Announce = std::function<void(std::string_view work, double processor_seconds)>;
  // Told the name of each stage of a chain before it begins, and why one went on as it did.
  using Begin = std::function<void(std::string_view stage)>;
  using Explain = std::function<void(std::string_view why)>;
  using Clock = std::chrono::steady_clock;

  Progress() = default;
  explicit Progress(Callback callback, Announce announce = {}, Begin begin = {}, Explain explain = {})
      : callback_(std::move(callback)),
        announce_(std::move(announce)),
        begin_(std::move(begin)),
        explain_(std::move(explain)) {}

  // The same, with an end of all work, and of what makes a valid result better; or with earlier ones.
  Progress until(Clock::time_point end) const { return until(end, end); }
  Progress until(Clock::time_point end, Clock::time_point end_of_improvement) const {
    Progress progress = *this;
    progress.end_ = std::min(end_, end);
    progress.end_of_improvement_ = std::min({progress.end_, end_of_improvement_, end_of_improvement});
    progress.ran_short_ = std::make_shared<bool>(false);
    return progress;
  }
  // For work by which a valid result, which its caller keeps, may become better.
  Progress for_improvement() const {
    Progress progress = *this;
    progress.end_ = end_of_improvement_;
    return progress;
  }
  // Does such work, which leaves the result as it was where it throws.
  template <class Work>
  void improve(const Work& work) const {
    try {
      work(for_improvement());
    } catch (const OutOfTime&) {
    }
  }
  Clock::time_point end() const { return end_; }

  // Throws Cancelled if the callback asks to stop, and OutOfTime after the end. Algorithms call it at points where
  // their state can be dropped.
  void operator()(std::string_view stage, double fraction) const {
    tell(stage, fraction);
    if (is_over(end_)) throw OutOfTime(stage);
  }
  // Those whose result is valid at any moment call these two instead, and end with it. The first throws Cancelled.
  void tell(std::string_view stage, double fraction) const {
    if (callback_ && !callback_(stage, fraction)) throw Cancelled();
  }
  bool may_improve() const { return !is_over(end_of_improvement_); }

  void announce(std::string_view work, double processor_seconds) const {
    if (announce_) announce_(work, processor_seconds);
  }
  void begin(std::string_view stage) const {
    if (begin_) begin_(stage);
  }
  void explain(std::string_view why) const {
    if (explain_) explain_(why);
  }

  // Whether time was over for anybody who asked, since `until`.
  bool ran_short() const { return ran_short_ && *ran_short_; }

 private:
  bool is_over(Clock::time_point end) const {
    if (!ran_short_ || Clock::now() < end) return false;
    *ran_short_ = true;
    return true;
  }

  Callback callback_;
  Announce announce_;
  Begin begin_;
  Explain explain_;
  Clock::time_point end_ = Clock::time_point::max(), end_of_improvement_ = Clock::time_point::max();
  std::shared_ptr<bool> ran_short_;  // there is none where there is no end
};

}  // namespace scan2fea
