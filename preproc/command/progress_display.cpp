#include "preproc/command/progress_display.hpp"

#include "preproc/command/console.hpp"
#include "preproc/command/stage_words.hpp"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <csignal>
#include <cstdio>

namespace scan2fea::command {
namespace {

ProgressMode mode_of(const DisplayFlags& flags) {
  if (flags.progress != ProgressMode::automatic) return flags.progress;
  return has_terminal() && !flags.quiet ? ProgressMode::bar : ProgressMode::off;
}

// As exact as such an estimate is.
std::string time_text(double seconds) {
  char text[32];
  if (seconds < 9.5)
    std::snprintf(text, sizeof text, "%.0f s", std::max(1.0, std::ceil(seconds)));
  else if (seconds < 90)
    std::snprintf(text, sizeof text, "%.0f s", 5 * std::ceil(seconds / 5));
  else if (seconds < 5400)
    std::snprintf(text, sizeof text, "%.0f min", seconds / 60);
  else
    std::snprintf(text, sizeof text, "%.1f h", seconds / 3600);
  return text;
}

// "laying triangles: edge lengths         [#####.......]  43 %, 12 s left", or as much of it as there is room for. The
// bar stays where it is, whatever the stage is called.
std::string bar_text(const std::string& words, std::string_view step, RunEstimate::State state, std::size_t columns) {
  constexpr std::size_t words_alone = 36, words_and_step = 43, brackets = 4, least_of_bar = 8, most_of_bar = 30,
                        times = 19;
  const std::size_t room = columns > 0 ? columns - 1 : 0;  // a full line would wrap
  char percent[16];
  std::snprintf(percent, sizeof percent, "%3.0f %%", std::floor(100 * state.fraction));
  const std::string told = std::string(percent) + ", " + time_text(state.seconds_left) + " left";
  if (room < words_alone + brackets + least_of_bar + times) {
    const std::string narrow = words + " " + told;
    return narrow.size() <= room ? narrow : (std::string(percent) + " " + words).substr(0, room);
  }
  const std::size_t label = room < words_and_step + brackets + least_of_bar + times ? words_alone : words_and_step;
  std::string text = label == words_and_step && !step.empty() ? words + ": " + std::string(step) : words;
  text.resize(label, ' ');
  const std::size_t width = std::min(most_of_bar, room - label - brackets - times);
  const auto full = static_cast<std::size_t>(state.fraction * static_cast<double>(width));
  return text + " [" + std::string(full, '#') + std::string(width - full, '.') + "] " + told;
}

double rounded(double value, double of_one) {
  return std::round(value * of_one) / of_one;
}

}  // namespace

ProgressDisplay::ProgressDisplay(const DisplayFlags& flags)
    : flags_(flags), mode_(mode_of(flags)), start_(RunEstimate::Clock::now()) {
  if (mode_ != ProgressMode::bar && mode_ != ProgressMode::json) return;
  // Signals come to the main thread.
  sigset_t all, before;
  sigfillset(&all);
  pthread_sigmask(SIG_SETMASK, &all, &before);
  drawing_ = std::thread([this] { draw_until_stopped(); });
  pthread_sigmask(SIG_SETMASK, &before, nullptr);
}

ProgressDisplay::~ProgressDisplay() {
  stop();
}

void ProgressDisplay::stop() {
  {
    const std::lock_guard lock(mutex_);
    is_stopped_ = true;
  }
  changed_.notify_one();
  if (drawing_.joinable()) drawing_.join();
  clear_bar();
}

Progress ProgressDisplay::progress() {
  const auto callback = [this](std::string_view name, double) {
    step(name);
    return !is_cancelled_;
  };
  const auto announce = [this](std::string_view work, double processor_seconds) {
    {
      const std::lock_guard lock(mutex_);
      estimate_.expect_of_stage(processor_seconds, RunEstimate::Clock::now());
    }
    char seconds[32];
    std::snprintf(seconds, sizeof seconds, "%.1g", processor_seconds);
    detail("next: " + std::string(work) + ", about " + seconds + " s of processor time");
  };
  return Progress(
      callback, announce, [this](std::string_view stage) { begin(stage); },
      [this](std::string_view why) { detail("  " + std::string(why)); });
}

void ProgressDisplay::expect(std::vector<ExpectedStage> stages) {
  const std::lock_guard lock(mutex_);
  estimate_.expect(std::move(stages), RunEstimate::Clock::now());
}

void ProgressDisplay::begin(std::string_view stage) {
  {
    const std::lock_guard lock(mutex_);
    estimate_.begin(stage, RunEstimate::Clock::now());
    step_.clear();
    has_changed_ = true;
  }
  changed_.notify_one();
}

void ProgressDisplay::step(std::string_view name) {
  {
    const std::lock_guard lock(mutex_);
    if (step_ == name) return;
    step_ = name;
    has_changed_ = true;
  }
  changed_.notify_one();
}

void ProgressDisplay::finish() {
  stop();
  if (mode_ == ProgressMode::json) draw({.fraction = 1, .seconds_left = 0}, RunEstimate::Clock::now());
}

// The bar goes on between what the algorithms tell, so that it is seen that the command lives.
void ProgressDisplay::draw_until_stopped() {
  using std::chrono::milliseconds;
  const milliseconds least_apart(mode_ == ProgressMode::json ? 40 : 50);
  const milliseconds most_apart(mode_ == ProgressMode::json ? 250 : 100);
  std::unique_lock lock(mutex_);
  while (!is_stopped_) {
    changed_.wait_for(lock, most_apart, [this] { return has_changed_ || is_stopped_; });
    if (is_stopped_) return;
    has_changed_ = false;
    const RunEstimate::Time now = RunEstimate::Clock::now();
    if (!estimate_.stage().empty()) draw(estimate_.at(now), now);
    changed_.wait_for(lock, least_apart, [this] { return is_stopped_; });
  }
}

void ProgressDisplay::draw(RunEstimate::State state, RunEstimate::Time now) {
  if (mode_ == ProgressMode::bar)
    show_bar(bar_text(std::string(words_of_stage(estimate_.stage())), words_of_step(step_), state, terminal_width()));
  else
    say_raw(json_line(state, now) + "\n");
}

std::string ProgressDisplay::told() {
  const std::lock_guard lock(mutex_);
  const RunEstimate::Time now = RunEstimate::Clock::now();
  return estimate_.stage().empty() ? std::string() : json_line(estimate_.at(now), now);
}

std::string ProgressDisplay::json_line(RunEstimate::State state, RunEstimate::Time now) const {
  nlohmann::ordered_json line{
      {"type", "progress"}, {"stage", estimate_.stage()}, {"words", words_of_stage(estimate_.stage())}};
  if (!step_.empty()) line["step"] = step_;
  line["fraction"] = state.fraction < 1 ? std::min(rounded(state.fraction, 10000), 0.9999) : 1;
  line["seconds"] = rounded(std::chrono::duration<double>(now - start_).count(), 1000);
  line["seconds_left"] = rounded(state.seconds_left, 10);
  return line.dump();
}

void ProgressDisplay::line(const std::string& text) {
  if (!flags_.quiet) say(LineKind::message, text);
}

void ProgressDisplay::detail(const std::string& text) {
  if (is_verbose()) say(LineKind::message, text);
}

}  // namespace scan2fea::command
