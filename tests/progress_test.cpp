#include "preproc/mesh/progress.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace scan2fea {
namespace {

using testing::HasSubstr;

constexpr std::chrono::hours long_time(1);

Progress::Clock::time_point now() {
  return Progress::Clock::now();
}

TEST(Progress, WithoutAnEndThereIsTime) {
  const Progress progress;
  EXPECT_NO_THROW(progress("stage", 0.5));
  EXPECT_NO_THROW(progress.for_improvement()("stage", 0.5));
  EXPECT_TRUE(progress.may_improve());
  EXPECT_FALSE(progress.ran_short());
}

TEST(Progress, AfterTheEndItThrowsAndNamesTheStage) {
  const Progress progress = Progress().until(now());
  try {
    progress("a stage", 0.5);
    FAIL();
  } catch (const OutOfTime& error) {
    EXPECT_THAT(error.what(), HasSubstr("a stage"));
    EXPECT_EQ(error.exit_code(), 4);
  }
  EXPECT_TRUE(progress.ran_short());
  EXPECT_NO_THROW(progress.tell("a stage", 0.5));
}

TEST(Progress, WhatIsBetterEndsEarlier) {
  const Progress progress = Progress().until(now() + long_time, now());
  EXPECT_NO_THROW(progress("stage", 0.5));
  EXPECT_FALSE(progress.ran_short());
  EXPECT_FALSE(progress.may_improve());
  EXPECT_THROW(progress.for_improvement()("stage", 0.5), OutOfTime);
  EXPECT_TRUE(progress.ran_short());
}

TEST(Progress, AnImprovementWithoutTimeIsPassedOver) {
  const auto work = [](const Progress& in_time) { in_time("stage", 0.5); };
  EXPECT_NO_THROW(Progress().until(now() + long_time, now()).improve(work));
  EXPECT_THROW(Progress([](std::string_view, double) { return false; }).improve(work), Cancelled);
}

TEST(Progress, AnEndOnlyComesNearer) {
  const Progress over = Progress().until(now());
  EXPECT_THROW(over.until(now() + long_time)("stage", 0.5), OutOfTime);
  const Progress no_better = Progress().until(now() + long_time, now());
  EXPECT_FALSE(no_better.until(now() + long_time).may_improve());
}

TEST(Progress, EachEndTellsOfItselfWhetherTimeRanShort) {
  const Progress whole = Progress().until(now());
  const Progress stage = whole.until(whole.end());
  EXPECT_FALSE(stage.may_improve());
  EXPECT_TRUE(stage.ran_short());
  EXPECT_FALSE(whole.until(whole.end()).ran_short());
}

TEST(Progress, WorkIsAnnouncedWhoeverAsks) {
  std::string told;
  const Progress progress({}, [&](std::string_view work, double seconds) {
    told += work;
    told += seconds > 1 ? "!" : ".";
  });
  progress.announce("much", 20);
  progress.until(now() + long_time).for_improvement().announce("little", 0.1);
  EXPECT_EQ(told, "much!little.");
  Progress().announce("to nobody", 1);
}

TEST(Progress, TheCallbackCancels) {
  const Progress progress([](std::string_view, double) { return false; });
  EXPECT_THROW(progress("stage", 0.5), Cancelled);
  EXPECT_THROW(progress.tell("stage", 0.5), Cancelled);
  EXPECT_THROW(progress.until(now() + long_time)("stage", 0.5), Cancelled);
}

}  // namespace
}  // namespace scan2fea
