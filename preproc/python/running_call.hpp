// Work of the library while Python waits for it.
//
// It is done in a thread of its own, without the interpreter's lock. The thread that called looks after signals and the
// progress callback meanwhile, so that an interrupt comes through at once, whatever the work is at: it is asked to
// stop, and left to end by itself with the meshes that it works on, which it shares.
#pragma once

#include "preproc/command/caller.hpp"

#include <atomic>
#include <condition_variable>
#include <exception>
#include <functional>
#include <memory>
#include <mutex>
#include <pybind11/pybind11.h>
#include <string>
#include <vector>

namespace scan2fea::python {

struct RunningCall {
  std::function<void(RunningCall&)> work;
  command::Caller caller = {};
  int exit_code = 0;
  std::vector<std::string> warnings = {}, failures = {};  // of gates

  std::exception_ptr error = {};
  std::mutex mutex = {};
  std::condition_variable ended = {};
  bool has_ended = false;
};

// Does `call->work` and throws what it throws. `progress` is None, or called in this thread with the text of a JSON
// object (progress_display.hpp), several times a second; where it returns False that throws Cancelled. With the
// interpreter's lock held.
void run_while_python_waits(const std::shared_ptr<RunningCall>& call, const pybind11::object& progress);

// Waits for those that were left to end: before the interpreter ends. With the lock held.
void wait_for_ending();

}  // namespace scan2fea::python
