// Words and numbers of a text file, for the readers of text formats.
#pragma once

#include "preproc/mesh/input_file.hpp"
#include "preproc/mesh/surface_mesh.hpp"

#include <cstdint>
#include <string>
#include <string_view>

namespace scan2fea {

// A position in a text file that moves from word to word. Lines end with LF, CR LF or CR; `#` starts a comment; a
// backslash at the end of a line continues it. The formats that do not have the last two do not use those characters
// either. Copyable: a copy remembers a place. All failures are InvalidInput with the file and the line.
class TextScanner {
 public:
  // At the start of the file, after a byte-order mark.
  explicit TextScanner(const InputFile& file);
  TextScanner(const InputFile& file, const char* at);

  // To the next word of this line; false where the line has no more.
  bool skip_blanks();
  // To the next word of the file; false where the file has no more.
  bool skip_space();
  // To the start of the next line.
  void skip_line();

  // The word at the position, which moves behind it; empty at the end of a line.
  std::string_view word();
  // Over what is left of the word that the position is in.
  void finish_word();
  // The next number of this line. Fails where it is missing, is not one, or is not finite.
  double number();
  // The next three numbers of this line.
  Vec3 point();
  // The next whole number of this line. `delimiter` may follow it directly, as in OBJ's 7/2/5.
  std::int64_t integer(char delimiter = ' ');

  const char* position() const { return at_; }
  std::size_t bytes_left() const { return static_cast<std::size_t>(end_ - at_); }
  const InputFile& file() const { return *file_; }

  // About the word at `at`, which points into the file.
  [[noreturn]] void fail(const char* at, std::string what, std::string value = {}, std::string limit = {},
                         std::string advice = {}) const {
    file_->fail_at_line(at, std::move(what), std::move(value), std::move(limit), std::move(advice));
  }

 private:
  bool ends_word(const char* at) const;
  [[noreturn]] void fail_number(const char* expected) const;

  const InputFile* file_;
  const char* at_;
  const char* end_;
  char line_end_;  // what ends all lines: LF, or CR where the file has it alone
};

// Whether a keyword is `expected`, which is in lower case, in any case.
bool is_keyword(std::string_view word, std::string_view expected);

}  // namespace scan2fea
