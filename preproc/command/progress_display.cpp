#include "preproc/command/progress_display.hpp"

#include <algorithm>
#include <atomic>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <unistd.h>

namespace scan2fea::command {
namespace {

std::atomic<bool> interrupted{false};
static_assert(std::atomic<bool>::is_always_lock_free, "a signal handler may touch lock-free atomics only");

void on_interrupt(int) {
  interrupted = true;
}

}  // namespace

void catch_interrupts() {
  struct sigaction action {};
  action.sa_handler = on_interrupt;
  action.sa_flags = static_cast<int>(SA_RESETHAND);
  sigaction(SIGINT, &action, nullptr);
  sigaction(SIGTERM, &action, nullptr);
}

ProgressDisplay::ProgressDisplay(bool quiet)
    : quiet_(quiet),
      terminal_(isatty(STDERR_FILENO) != 0 && std::getenv("TERM") != nullptr &&
                std::strcmp(std::getenv("TERM"), "dumb") != 0) {}

ProgressDisplay::~ProgressDisplay() {
  clear();
}

Progress ProgressDisplay::progress() {
  return Progress([this](std::string_view stage, double fraction) { return update(stage, fraction); });
}

void ProgressDisplay::line(const std::string& text) {
  if (quiet_) return;
  clear();
  std::fprintf(stderr, "%s\n", text.c_str());
}

bool ProgressDisplay::update(std::string_view stage, double fraction) {
  if (interrupted) return false;
  if (quiet_ || !terminal_) return true;
  const auto now = std::chrono::steady_clock::now();
  if (bar_shown_ && now - last_drawn_ < std::chrono::milliseconds(50)) return true;
  last_drawn_ = now;
  bar_shown_ = true;
  constexpr int width = 30;  // beside the stage's name it leaves a terminal of 80 columns some room
  const double clamped = std::clamp(fraction, 0.0, 1.0);
  const std::string filled(static_cast<std::size_t>(clamped * width), '#');
  std::fprintf(stderr, "\r\033[K%-16.*s [%-*s] %3.0f %%", static_cast<int>(stage.size()), stage.data(), width,
               filled.c_str(), 100 * clamped);
  std::fflush(stderr);
  return true;
}

void ProgressDisplay::clear() {
  if (!bar_shown_) return;
  std::fprintf(stderr, "\r\033[K");
  std::fflush(stderr);
  bar_shown_ = false;
}

}  // namespace scan2fea::command
