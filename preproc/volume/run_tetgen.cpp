#include "preproc/volume/run_tetgen.hpp"

#include "preproc/mesh/companion_file.hpp"
#include "preproc/mesh/huge_pages.hpp"

#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <fcntl.h>
#include <spawn.h>
#include <string>
#include <string_view>
#include <sys/mman.h>
#include <sys/wait.h>
#include <system_error>
#include <thread>
#include <unistd.h>
#include <vector>

extern char** environ;

namespace scan2fea {
namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

constexpr const char* worker_name = "scan2fea-tetgen";

MeshingFailed failed(std::string what, std::string value, std::string limit, std::string advice) {
  return MeshingFailed({.what = std::move(what),
                        .where = {},
                        .value = std::move(value),
                        .limit = std::move(limit),
                        .advice = std::move(advice)});
}

// What the user has set stays.
std::vector<char*> environment_of_worker(std::string& setting) {
  std::vector<char*> result;
  const std::string_view name = std::string_view(setting).substr(0, setting.find('=') + 1);
  bool set = false;
  for (char** variable = environ; *variable != nullptr; ++variable) {
    set = set || std::string_view(*variable).starts_with(name);
    result.push_back(*variable);
  }
  if (!set) result.push_back(setting.data());
  result.push_back(nullptr);
  return result;
}

// A file without a name, in memory, that children have open, too: whatever becomes of them, none is left behind.
class NamelessFile {
 public:
  NamelessFile() : descriptor_(::memfd_create("scan2fea", 0)) {
    if (descriptor_ < 0)
      throw IoError({.what = "no file can be made in memory for TetGen",
                     .where = {},
                     .value = std::strerror(errno),
                     .limit = {},
                     .advice = "more memory, or more open files (ulimit -n)"});
  }
  ~NamelessFile() { ::close(descriptor_); }
  NamelessFile(const NamelessFile&) = delete;
  NamelessFile& operator=(const NamelessFile&) = delete;

  // The same for this process and its children.
  std::string path() const { return "/proc/self/fd/" + std::to_string(descriptor_); }

 private:
  int descriptor_;
};

// A child that does not outlive this object.
class Child {
 public:
  Child(const fs::path& executable, std::vector<std::string> arguments) {
    std::vector<char*> argv;
    std::string name = executable.string();
    argv.push_back(name.data());
    for (std::string& argument : arguments) argv.push_back(argument.data());
    argv.push_back(nullptr);
    std::string setting = std::string(allocator_variable) + '=' + allocator_setting;
    const std::vector<char*> environment = environment_of_worker(setting);

    // TetGen prints even when told to be quiet, and the command's stdout belongs to its results.
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    for (const int stream : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO})
      posix_spawn_file_actions_addopen(&actions, stream, "/dev/null", stream == STDIN_FILENO ? O_RDONLY : O_WRONLY, 0);
    const int error = ::posix_spawn(&pid_, executable.c_str(), &actions, nullptr, argv.data(), environment.data());
    posix_spawn_file_actions_destroy(&actions);
    if (error != 0) {
      pid_ = -1;
      throw failed("the TetGen worker does not start", name + ": " + std::strerror(error), {},
                   "check that it is there and may be executed, or install scan2fea anew");
    }
  }
  ~Child() {
    if (pid_ < 0) return;
    ::kill(pid_, SIGKILL);
    while (::waitpid(pid_, nullptr, 0) < 0 && errno == EINTR) {
    }
  }
  Child(const Child&) = delete;
  Child& operator=(const Child&) = delete;

  // The exit status, 128 + signal if it was killed, nothing while it runs.
  std::optional<int> ended() {
    int status = 0;
    if (::waitpid(pid_, &status, WNOHANG) != pid_) return std::nullopt;
    pid_ = -1;
    return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  }

 private:
  pid_t pid_ = -1;
};

std::string seconds_text(double seconds) {
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), "%.3g s", seconds);
  return text.data();
}

int wait_for(Child& child, const TetgenLimits& limits, const Progress& progress) {
  constexpr std::chrono::milliseconds pause(2), between_reports(50);
  const Clock::time_point start = Clock::now();
  for (Clock::time_point reported = start;; std::this_thread::sleep_for(pause)) {
    if (const auto status = child.ended()) return *status;
    const Clock::time_point now = Clock::now();
    const std::chrono::duration<double> elapsed = now - start;
    if (elapsed > limits.time)
      throw failed("TetGen exceeded the time limit", seconds_text(elapsed.count()), seconds_text(limits.time.count()),
                   "a coarser mesh");
    if (now - reported < between_reports) continue;
    reported = now;
    // How far TetGen is, it does not tell: half way after ten seconds, never quite done.
    progress("tetgen", elapsed.count() / (elapsed.count() + 10));
  }
}

[[noreturn]] void report(int status, const TetgenLimits& limits) {
  const std::string limit =
      limits.memory_bytes ? std::to_string(*limits.memory_bytes >> 20) + " MiB" : std::string("the machine's memory");
  switch (static_cast<TetgenStatus>(status)) {
    case TetgenStatus::out_of_memory:
      throw failed("TetGen ran out of memory", {}, limit, "a coarser mesh or a higher memory limit");
    case TetgenStatus::self_intersection:
      throw failed("TetGen found that the surface intersects itself", {}, {},
                   "scan2fea repair, or scan2fea check to see where");
    case TetgenStatus::tiny_feature:
      throw failed("TetGen found a feature too small to mesh", {}, {}, "scan2fea repair, or larger triangles");
    case TetgenStatus::close_facets:
      throw failed("TetGen found two facets that nearly touch", {}, {}, "scan2fea repair, or smaller triangles there");
    case TetgenStatus::wrong_input:
      throw failed("TetGen refused its input", {}, {}, "scan2fea check on the surface");
    case TetgenStatus::file_error:
      throw IoError({.what = "the TetGen worker could not read its input or write its output",
                     .where = {},
                     .value = {},
                     .limit = {},
                     .advice = "more memory, or larger files (ulimit -f)"});
    default:
      break;
  }
  throw failed("TetGen crashed",
               status > 128 ? "signal " + std::to_string(status - 128) : "status " + std::to_string(status), {},
               "scan2fea check on the surface: shells that cross or touch are the usual cause");
}

}  // namespace

TetgenOutput run_tetgen(const TetgenInput& input, const TetgenLimits& limits, const Progress& progress) {
  const fs::path worker = limits.worker.value_or(companion_file(worker_name));
  const NamelessFile in, out;
  write_exchange(input, in.path());
  Child child(worker,
              {in.path(), out.path(), std::to_string(limits.memory_bytes.value_or(0)), std::to_string(::getpid())});
  if (const int status = wait_for(child, limits, progress); status != 0) report(status, limits);
  return read_tetgen_output(out.path());
}

}  // namespace scan2fea
