// Lines and numbers of text formats whose fields have their place in a line.
#pragma once

#include "preproc/mesh/input_file.hpp"

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace scan2fea {

class LineReader {
 public:
  explicit LineReader(const InputFile& file) : file_(file), rest_(file.bytes()) {}

  // To the next line; false at the end of the file.
  bool next();
  // Without its end.
  std::string_view line() const { return line_; }
  // The next call of `next` stays at this line.
  void put_back() { put_back_ = true; }
  std::size_t bytes_left() const { return rest_.size(); }

  // Of this line.
  [[noreturn]] void fail(std::string what, std::string value = {}, std::string limit = {},
                         std::string advice = {}) const;

  // Numbers of this line; they fail where `field`, blanks around it passed over, is none. Reals also in Fortran's
  // forms, 1.5D-03 and Nastran's 1.5-3; an empty one is 0.
  std::uint64_t count(std::string_view field) const;  // 0 or more
  double real(std::string_view field) const;
  // The field from `column` on, shorter or empty where the line ends.
  std::string_view field(std::size_t column, std::size_t width) const;

 private:
  const InputFile& file_;
  std::string_view rest_, line_;
  bool put_back_ = false;
};

std::string_view without_blanks(std::string_view text);  // at both ends
std::vector<std::string_view> words_of(std::string_view line);
std::string upper_case(std::string_view text);

}  // namespace scan2fea
