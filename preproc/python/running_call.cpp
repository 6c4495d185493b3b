#include "preproc/python/running_call.hpp"

#include "preproc/command/console.hpp"
#include "preproc/mesh/error.hpp"

#include <chrono>
#include <csignal>
#include <new>
#include <thread>
#include <utility>

namespace scan2fea::python {
namespace {

namespace py = pybind11;
using command::LineKind;

struct Ending {
  std::thread thread;
  std::shared_ptr<RunningCall> call;
};

std::mutex of_ending;
std::vector<Ending> ending;

bool has_ended(RunningCall& call) {
  const std::lock_guard lock(call.mutex);
  return call.has_ended;
}

void leave_to_end(std::thread thread, std::shared_ptr<RunningCall> call) {
  call->caller.display.cancel();
  const std::lock_guard lock(of_ending);
  std::erase_if(ending, [](Ending& other) {
    if (!has_ended(*other.call)) return false;
    other.thread.join();
    return true;
  });
  ending.push_back({std::move(thread), std::move(call)});
}

void work(RunningCall& call) {
  const command::LinesHeard heard([&call](LineKind kind, std::string_view text) {
    if (kind == LineKind::warning) call.warnings.emplace_back(text);
    if (kind == LineKind::error) call.failures.emplace_back(text);
  });
  try {
    call.work(call);
  } catch (const Error&) {
    call.error = std::current_exception();
  } catch (const std::bad_alloc&) {
    call.error = std::current_exception();
  } catch (const std::exception& e) {  // of a library: no thread can be started, say
    call.error = std::make_exception_ptr(NotMeshable({.what = "no mesh could be made",
                                                      .where = {},
                                                      .value = e.what(),
                                                      .limit = {},
                                                      .advice = "more memory, or threads=1"}));
  }
  const std::lock_guard lock(call.mutex);
  call.has_ended = true;
  call.ended.notify_all();
}

// Signals come to Python's main thread.
std::thread start(const std::shared_ptr<RunningCall>& call) {
  sigset_t all, before;
  sigfillset(&all);
  pthread_sigmask(SIG_SETMASK, &all, &before);
  std::thread thread([call] { work(*call); });
  pthread_sigmask(SIG_SETMASK, &before, nullptr);
  return thread;
}

void tell(RunningCall& call, const py::object& progress, std::string& told_before) {
  std::string told = call.caller.display.told();
  if (told.empty() || told == told_before) return;
  const py::object answer = progress(py::str(told));
  told_before = std::move(told);
  if (answer.is(py::bool_(false))) throw Cancelled();
}

void wait(RunningCall& call, const py::object& progress) {
  constexpr std::chrono::milliseconds between_looks(50);
  std::string told;
  while (true) {
    {
      const py::gil_scoped_release released;
      std::unique_lock lock(call.mutex);
      if (call.ended.wait_for(lock, between_looks, [&] { return call.has_ended; })) return;
    }
    if (PyErr_CheckSignals() != 0) throw py::error_already_set();
    if (!progress.is_none()) tell(call, progress, told);
  }
}

}  // namespace

void run_while_python_waits(const std::shared_ptr<RunningCall>& call, const py::object& progress) {
  std::thread thread = start(call);
  try {
    wait(*call, progress);
  } catch (...) {
    leave_to_end(std::move(thread), call);
    throw;
  }
  {
    const py::gil_scoped_release released;
    thread.join();
  }
  if (call->error) std::rethrow_exception(call->error);
}

void wait_for_ending() {
  const py::gil_scoped_release released;
  const std::lock_guard lock(of_ending);
  for (Ending& other : ending) other.thread.join();
  ending.clear();
}

}  // namespace scan2fea::python
