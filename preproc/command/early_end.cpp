#include "preproc/command/early_end.hpp"

#include "preproc/command/console.hpp"
#include "preproc/mesh/output_file.hpp"

#include <algorithm>
#include <array>
#include <atomic>
#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <pthread.h>
#include <string>
#include <string_view>
#include <sys/time.h>
#include <unistd.h>

namespace scan2fea::command {
namespace {

constexpr int interrupted = 130, out_of_time = 4, input_is_invalid = 3;

// What a signal handler looks at.
pthread_t main_thread;
std::atomic<bool> is_done{false};
using Line = std::array<char, 1024>;
Line line_when_interrupted{}, line_when_out_of_time{}, line_when_shortened{};
static_assert(std::atomic<bool>::is_always_lock_free, "a signal handler may touch lock-free atomics only");

void say(std::string_view text) {
  [[maybe_unused]] const ssize_t ignored = ::write(STDERR_FILENO, text.data(), text.size());
}

// Only in the main thread, which is the one that gives names to outputs, is nobody giving one meanwhile.
void end(int signal) {
  if (!pthread_equal(pthread_self(), main_thread)) {
    pthread_kill(main_thread, signal);
    return;
  }
  if (is_done) return;
  remove_unfinished_outputs();
  end_console();
  say(signal == SIGALRM ? line_when_out_of_time.data() : line_when_interrupted.data());
  ::_exit(signal == SIGALRM ? out_of_time : interrupted);
}

// In whichever thread reads: there is no going on for it.
void end_by_shortened_input(int) {
  remove_unfinished_outputs();
  end_console();
  say(line_when_shortened.data());
  ::_exit(input_is_invalid);
}

// Where it is too long, nothing but its end is lost.
void set_line(std::string_view text, Line& line) {
  std::string whole = console_line(LineKind::error, text);
  for (std::size_t most = text.size(); whole.size() > line.size() - 1 && most > 0;)
    whole = console_line(LineKind::error, text.substr(0, most -= std::min<std::size_t>(most, 16)));
  std::ranges::copy(whole, line.begin());
  line[whole.size()] = '\0';
}

void call_on(int signal, void (*handler)(int)) {
  struct sigaction action {};
  action.sa_handler = handler;
  action.sa_flags = SA_RESTART;
  sigfillset(&action.sa_mask);
  sigaction(signal, &action, nullptr);
}

void call_end_on(int signal) {
  call_on(signal, end);
}

bool is_ignored(int signal) {
  struct sigaction action {};
  return sigaction(signal, nullptr, &action) == 0 && action.sa_handler == SIG_IGN;
}

}  // namespace

void end_on_interrupts() {
  main_thread = pthread_self();
  set_line("interrupted", line_when_interrupted);
  set_line("an input was shortened by another program while it was read; try: again", line_when_shortened);
  call_on(SIGBUS, end_by_shortened_input);
  call_end_on(SIGINT);
  call_end_on(SIGTERM);
  if (!is_ignored(SIGHUP)) call_end_on(SIGHUP);  // as nohup asks for
  std::signal(SIGPIPE, SIG_IGN);
  std::signal(SIGXFSZ, SIG_IGN);
}

void end_after(std::chrono::duration<double> time, const std::string& text) {
  set_line(text, line_when_out_of_time);
  call_end_on(SIGALRM);
  const auto microseconds = std::max<long>(1, std::chrono::duration_cast<std::chrono::microseconds>(time).count());
  constexpr long a_second = 1'000'000;
  const itimerval timer{.it_interval = {}, .it_value = {microseconds / a_second, microseconds % a_second}};
  setitimer(ITIMER_REAL, &timer, nullptr);
}

void ends_by_itself_now() {
  is_done = true;
}

}  // namespace scan2fea::command
