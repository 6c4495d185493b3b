// What is seen while the command works: a bar on a terminal, lines of JSON for a program, finished lines of text, or
// nothing.
//
// A line of JSON, with `--progress json`, when a stage begins or has a new step, and four times a second at most:
//   {"type": "progress", "stage": "simplify", "words": "laying triangles", "step": "shape and fit",
//    "fraction": 0.4312, "seconds": 2.1, "seconds_left": 2.7}
// `fraction` is of the whole run, never goes back, and is 1 in the last line of a run that came to its end; `seconds`
// have passed, `seconds_left` is an estimate. All else on stderr is then JSON, too: {"type": "message", "text": ...},
// "warning" and "error".
#pragma once

#include "preproc/mesh/progress.hpp"
#include "preproc/mesh/run_estimate.hpp"

#include <atomic>
#include <condition_variable>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

namespace scan2fea::command {

enum class ProgressMode { automatic, off, bar, json };

struct Caller;

// That every sub-command knows.
struct DisplayFlags {
  bool quiet = false;    // no messages but errors
  bool verbose = false;  // why stages came out as they did, too
  ProgressMode progress = ProgressMode::automatic;
  Caller* caller = nullptr;  // a program, not a shell; then nothing of the above is asked for (caller.hpp)
};

class ProgressDisplay {
 public:
  explicit ProgressDisplay(const DisplayFlags& flags);
  ~ProgressDisplay();
  ProgressDisplay(const ProgressDisplay&) = delete;
  ProgressDisplay& operator=(const ProgressDisplay&) = delete;

  Progress progress();

  // Of the stages that are to come, what each will take, about.
  void expect(std::vector<ExpectedStage> stages);
  void begin(std::string_view stage);
  void finish();  // all is done

  // A finished line, unless quiet; one of detail only where these are asked for.
  void line(const std::string& text);
  void detail(const std::string& text);
  bool is_verbose() const { return flags_.verbose && !flags_.quiet; }

  // For a program that looks by itself: such a line of JSON, empty before the first stage. What works is asked to stop,
  // and throws Cancelled where it tells how far it is. Both from any thread.
  std::string told();
  void cancel() { is_cancelled_ = true; }

 private:
  void step(std::string_view name);
  void draw_until_stopped();
  void draw(RunEstimate::State state, RunEstimate::Time now);
  std::string json_line(RunEstimate::State state, RunEstimate::Time now) const;
  void stop();

  DisplayFlags flags_;
  ProgressMode mode_;  // never `automatic`
  RunEstimate estimate_;
  std::string step_;
  RunEstimate::Time start_;
  std::mutex mutex_;  // of what the drawing thread reads
  std::condition_variable changed_;
  bool has_changed_ = false, is_stopped_ = false;
  std::atomic<bool> is_cancelled_{false};
  std::thread drawing_;
};

}  // namespace scan2fea::command
