#include "preproc/mesh/run_estimate.hpp"

#include <gtest/gtest.h>

#include <random>

namespace scan2fea::command {
namespace {

using Time = RunEstimate::Time;

Time at_second(double seconds) {
  return Time{} + std::chrono::hours(1) +
         std::chrono::duration_cast<RunEstimate::Clock::duration>(std::chrono::duration<double>(seconds));
}

TEST(RunEstimate, WhatTakesAsLongAsExpectedIsExact) {
  RunEstimate run;
  run.expect({{"read", 2}, {"simplify", 6}, {"write", 2}}, at_second(0));
  run.begin("read", at_second(0));
  EXPECT_NEAR(run.at(at_second(1)).fraction, 0.1, 1e-9);
  EXPECT_NEAR(run.at(at_second(1)).seconds_left, 9, 1e-9);
  run.begin("simplify", at_second(2));
  EXPECT_NEAR(run.at(at_second(5)).seconds_left, 5, 0.1);
  EXPECT_GT(run.at(at_second(5)).fraction, 0.4);
}

TEST(RunEstimate, ASlowMachineIsFoundOut) {
  RunEstimate run;
  run.expect({{"read", 1}, {"simplify", 10}}, at_second(0));
  run.begin("read", at_second(0));
  run.begin("simplify", at_second(3));  // three times as slow
  EXPECT_NEAR(run.at(at_second(3)).seconds_left, 30, 1e-6);
}

TEST(RunEstimate, NeverGoesBackNorEndsBeforeTheEnd) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> seconds(0, 3);
  const std::vector<std::string> names{"read", "repair", "simplify", "unknown", "write"};
  for (int trial = 0; trial < 200; ++trial) {
    RunEstimate run;
    double now = 0, fraction = 0;
    run.expect({{"read", seconds(random)}, {"repair", seconds(random)}, {"simplify", seconds(random)}, {"write", 0}},
               at_second(now));
    for (int event = 0; event < 40; ++event) {
      const unsigned kind = random() % 8;
      if (kind == 0) run.begin(names[random() % names.size()], at_second(now));
      if (kind == 1) run.expect_of_stage(seconds(random), at_second(now));
      if (kind == 2) run.expect({{"simplify", seconds(random)}, {"write", seconds(random)}}, at_second(now));
      now += seconds(random) * seconds(random);
      const RunEstimate::State state = run.at(at_second(now));
      EXPECT_GE(state.fraction, fraction - 1e-12);
      EXPECT_LE(state.fraction, 1);
      EXPECT_GE(state.seconds_left, 0);
      fraction = state.fraction;
    }
  }
}

}  // namespace
}  // namespace scan2fea::command
