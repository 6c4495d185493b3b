// What a person sees while the command works: a bar on a terminal, plain lines elsewhere, nothing when quiet.
#pragma once

#include "preproc/mesh/progress.hpp"

#include <chrono>
#include <string>

namespace scan2fea::command {

// Draws on stderr.
class ProgressDisplay {
 public:
  explicit ProgressDisplay(bool quiet);
  ~ProgressDisplay();
  ProgressDisplay(const ProgressDisplay&) = delete;
  ProgressDisplay& operator=(const ProgressDisplay&) = delete;

  Progress progress();

  // One finished line, above the bar where there is one.
  void line(const std::string& text);

 private:
  void update(std::string_view stage, double fraction);
  void clear();

  bool quiet_;
  bool terminal_;
  bool bar_shown_ = false;
  std::chrono::steady_clock::time_point last_drawn_;
};

}  // namespace scan2fea::command
