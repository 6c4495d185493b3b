// How far a run is, and how long it will take: by what each stage is expected to take, corrected by what those before
// it took.
#pragma once

#include <chrono>
#include <string>
#include <string_view>
#include <vector>

namespace scan2fea::command {

struct ExpectedStage {
  std::string name;
  double seconds;
};

// The fraction never goes back. A stage that begins sooner than others in the list leaves these out; one that is not in
// the list is done beside it.
class RunEstimate {
 public:
  using Clock = std::chrono::steady_clock;
  using Time = Clock::time_point;

  void expect(std::vector<ExpectedStage> stages, Time now);  // after the one that is on
  void begin(std::string_view stage, Time now);
  void expect_of_stage(double seconds, Time now);  // for its next part, which is as far as it knows

  struct State {
    double fraction;      // of the whole run, 0 to 1
    double seconds_left;  // about
  };
  State at(Time now) const;
  const std::string& stage() const { return stage_; }

 private:
  double pace() const;  // seconds that passed, over those that were expected
  void begin_part(double expected, Time now);

  std::vector<ExpectedStage> to_come_;
  std::string stage_;
  double of_stage_ = 0, of_parts_ = 0;  // expected when the stage began, and since
  Time stage_began_ = {}, part_began_ = {};
  double of_part_ = 0;
  double base_ = 0;  // the fraction when the part began
  double taken_ = 0, expected_ = 0;
};

}  // namespace scan2fea::command
