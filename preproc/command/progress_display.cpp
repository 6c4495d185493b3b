#include "preproc/command/progress_display.hpp"

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <unistd.h>

namespace scan2fea::command {

ProgressDisplay::ProgressDisplay(bool quiet)
    : quiet_(quiet),
      terminal_(isatty(STDERR_FILENO) != 0 && std::getenv("TERM") != nullptr &&
                std::strcmp(std::getenv("TERM"), "dumb") != 0) {}

ProgressDisplay::~ProgressDisplay() {
  clear();
}

Progress ProgressDisplay::progress() {
  const auto callback = [this](std::string_view stage, double fraction) {
    update(stage, fraction);
    return true;
  };
  const auto announce = [this](std::string_view work, double processor_seconds) {
    char seconds[32];
    std::snprintf(seconds, sizeof seconds, "%.1g", processor_seconds);
    line("next: " + std::string(work) + ", about " + seconds + " s of processor time");
  };
  return Progress(callback, announce);
}

void ProgressDisplay::line(const std::string& text) {
  if (quiet_) return;
  clear();
  std::fprintf(stderr, "%s\n", text.c_str());
}

void ProgressDisplay::update(std::string_view stage, double fraction) {
  if (quiet_ || !terminal_) return;
  const auto now = std::chrono::steady_clock::now();
  if (bar_shown_ && now - last_drawn_ < std::chrono::milliseconds(50)) return;
  last_drawn_ = now;
  bar_shown_ = true;
  constexpr int width = 30;  // beside the stage's name it leaves a terminal of 80 columns some room
  const double clamped = std::clamp(fraction, 0.0, 1.0);
  const std::string filled(static_cast<std::size_t>(clamped * width), '#');
  std::fprintf(stderr, "\r\033[K%-16.*s [%-*s] %3.0f %%", static_cast<int>(stage.size()), stage.data(), width,
               filled.c_str(), 100 * clamped);
  std::fflush(stderr);
}

void ProgressDisplay::clear() {
  if (!bar_shown_) return;
  std::fprintf(stderr, "\r\033[K");
  std::fflush(stderr);
  bar_shown_ = false;
}

}  // namespace scan2fea::command
