#include "preproc/command/console.hpp"

#include <nlohmann/json.hpp>

#include <atomic>
#include <cstdlib>
#include <mutex>
#include <sys/ioctl.h>
#include <unistd.h>
#include <utility>

namespace scan2fea::command {
namespace {

constexpr std::string_view erase_line = "\r\033[K";

std::atomic<bool> in_json{false};
std::atomic_flag writing;  // no mutex: a signal handler asks for it, too
std::atomic<bool> bar_shown{false};
static_assert(std::atomic<bool>::is_always_lock_free, "a signal handler may touch lock-free atomics only");

thread_local const LinesHeard::Hear* heard_by = nullptr;

struct Writing {
  Writing() {
    while (writing.test_and_set(std::memory_order_acquire)) ::usleep(50);
  }
  ~Writing() { writing.clear(std::memory_order_release); }
  Writing(const Writing&) = delete;
  Writing& operator=(const Writing&) = delete;
};

// Nobody reads what cannot be written here.
void write_all(std::string_view text) {
  while (!text.empty()) {
    const ssize_t written = ::write(STDERR_FILENO, text.data(), text.size());
    if (written <= 0) return;
    text.remove_prefix(static_cast<std::size_t>(written));
  }
}

bool has_colour() {
  const char* no = std::getenv("NO_COLOR");
  return has_terminal() && (no == nullptr || *no == '\0');
}

std::string plain_line(LineKind kind, std::string_view text) {
  if (kind == LineKind::message) return std::string(text) + "\n";
  const bool coloured = has_colour();
  constexpr std::string_view bold_red = "\033[1;31m", yellow = "\033[33m", reset = "\033[0m";
  std::string line;
  if (coloured) line += kind == LineKind::error ? bold_red : yellow;
  line += kind == LineKind::error ? "scan2fea:" : "scan2fea: warning:";
  if (coloured) line += reset;
  return line + " " + std::string(text) + "\n";
}

}  // namespace

void say_in_json() {
  in_json = true;
}

bool says_in_json() {
  return in_json;
}

std::string console_line(LineKind kind, std::string_view text) {
  if (!in_json) return plain_line(kind, text);
  const char* type = kind == LineKind::error ? "error" : kind == LineKind::warning ? "warning" : "message";
  const nlohmann::ordered_json line{{"type", type}, {"text", std::string(text)}};
  return line.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace) + "\n";  // file names are any bytes
}

LinesHeard::LinesHeard(Hear hear) : hear_(std::move(hear)) {
  heard_by = &hear_;
}

LinesHeard::~LinesHeard() {
  heard_by = nullptr;
}

void say(LineKind kind, std::string_view text) {
  if (heard_by != nullptr) return (*heard_by)(kind, text);
  say_raw(console_line(kind, text));
}

void say_raw(std::string_view line) {
  const Writing only_one;
  std::string text;
  if (bar_shown.exchange(false)) text += erase_line;
  write_all(text += line);
}

void show_bar(std::string_view text) {
  const Writing only_one;
  bar_shown = true;
  write_all(std::string(erase_line) + std::string(text));
}

void clear_bar() {
  const Writing only_one;
  if (bar_shown.exchange(false)) write_all(erase_line);
}

bool has_terminal() {
  const char* terminal = std::getenv("TERM");
  return isatty(STDERR_FILENO) != 0 && terminal != nullptr && std::string_view(terminal) != "dumb";
}

std::size_t terminal_width() {
  winsize size{};
  if (ioctl(STDERR_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 0) return size.ws_col;
  const char* columns = std::getenv("COLUMNS");
  const long told = columns != nullptr ? std::strtol(columns, nullptr, 10) : 0;
  constexpr std::size_t usual = 80;
  return told > 0 ? static_cast<std::size_t>(told) : usual;
}

// Whoever writes may be the thread that the signal came to, and then never ends.
void end_console() {
  for (int tries = 0; writing.test_and_set(std::memory_order_acquire) && tries < 200; ++tries) ::usleep(50);
  if (bar_shown) write_all(erase_line);
}

}  // namespace scan2fea::command
