#include "preproc/mesh/run_estimate.hpp"

#include <algorithm>
#include <cmath>

namespace scan2fea::command {
namespace {

constexpr double unexpected_seconds = 0.1;  // of a stage that nobody told of

// Of a part that was expected to take so long. What takes longer comes to its end ever more slowly: from five sixths on
// what is left halves with four times the time.
double share_done(double taken, double expected) {
  constexpr double on_time = 5.0 / 6;
  const double share = taken / std::max(expected, 1e-3);
  return share < on_time ? share : 1 - (1 - on_time) * std::sqrt(on_time / share);
}

double seconds_between(RunEstimate::Time from, RunEstimate::Time to) {
  return std::chrono::duration<double>(to - from).count();
}

}  // namespace

void RunEstimate::begin_part(double expected, Time now) {
  base_ = at(now).fraction;
  part_began_ = now;
  of_part_ = expected;
}

void RunEstimate::expect(std::vector<ExpectedStage> stages, Time now) {
  begin_part(of_part_, now);
  to_come_ = std::move(stages);
}

void RunEstimate::begin(std::string_view stage, Time now) {
  const auto planned = std::ranges::find(to_come_, stage, &ExpectedStage::name);
  const double expected = planned == to_come_.end() ? unexpected_seconds : planned->seconds;
  begin_part(expected, now);
  if (stage_began_ != Time{}) {
    taken_ += seconds_between(stage_began_, now);
    expected_ += std::max(of_parts_, of_stage_);
  }
  if (planned != to_come_.end()) to_come_.erase(to_come_.begin(), planned + 1);
  stage_ = stage;
  stage_began_ = now;
  of_stage_ = expected;
  of_parts_ = 0;
}

void RunEstimate::expect_of_stage(double seconds, Time now) {
  // A stage knows what its next part takes, and not what comes after it.
  const double of_rest = of_stage_ - seconds_between(stage_began_, now) / pace();
  begin_part(std::max(seconds, of_rest), now);
  of_parts_ += seconds;
}

double RunEstimate::pace() const {
  constexpr double least_known = 0.1;  // seconds; before, nothing is known of this machine
  constexpr double largest = 5;
  return expected_ < least_known ? 1 : std::clamp(taken_ / expected_, 1 / largest, largest);
}

RunEstimate::State RunEstimate::at(Time now) const {
  if (part_began_ == Time{}) return {.fraction = 0, .seconds_left = 0};
  double rest = 0;
  for (const ExpectedStage& stage : to_come_) rest += stage.seconds;
  const double taken = seconds_between(part_began_, now);
  const double expected = pace() * of_part_;
  const double done = share_done(taken, expected);
  const double left = done < 0.5 ? expected - taken : taken * (1 - done) / done;
  const double of_rest = of_part_ / std::max(of_part_ + rest, 1e-9);
  return {.fraction = base_ + (1 - base_) * done * of_rest, .seconds_left = std::max(left, 0.0) + pace() * rest};
}

}  // namespace scan2fea::command
