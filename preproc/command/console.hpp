// What stands on stderr: finished lines and, below them on a terminal, one that is drawn again and again.
//
// A process has one stderr, so that this is the one state that is not handed around: whoever writes a line must know
// of the bar below it, the handler of an interrupt too. Safe to call from any thread.
#pragma once

#include <functional>
#include <string>
#include <string_view>

namespace scan2fea::command {

enum class LineKind { message, warning, error };

// Each line is a JSON object from here on, {"type": "message", "text": ...}: for programs.
void say_in_json();
bool says_in_json();

// A finished line, above the bar. Warnings and errors begin with the program's name, in colour on a terminal unless
// NO_COLOR is set (no-color.org).
void say(LineKind kind, std::string_view text);
inline void warn(std::string_view text) {
  say(LineKind::warning, text);
}
std::string console_line(LineKind kind, std::string_view text);  // what `say` writes, with its end

// While it lives, what its thread says goes there and not to stderr: several calls of a program may be on at once.
class LinesHeard {
 public:
  using Hear = std::function<void(LineKind, std::string_view)>;
  explicit LinesHeard(Hear hear);
  ~LinesHeard();
  LinesHeard(const LinesHeard&) = delete;
  LinesHeard& operator=(const LinesHeard&) = delete;

 private:
  Hear hear_;
};

// One line of JSON of another type, as it is.
void say_raw(std::string_view line);

// A line that the next one, or the next bar, takes the place of.
void show_bar(std::string_view text);
void clear_bar();

// Whether stderr is a terminal that knows how to go back to the start of a line; how many characters fit into one.
bool has_terminal();
std::size_t terminal_width();

// For the handler of a signal that ends the process: takes the bar away, if it can, and lets nobody else write.
void end_console();

}  // namespace scan2fea::command
