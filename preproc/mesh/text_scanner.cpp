#include "preproc/mesh/text_scanner.hpp"

#include <fast_float/fast_float.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstring>

namespace scan2fea {
namespace {

bool is_line_break(char c) {
  return c == '\n' || c == '\r';
}

bool is_blank(char c) {
  return c == ' ' || c == '\t' || c == '\v' || c == '\f';
}

// As the first line tells.
bool breaks_lines_with_cr_alone(std::string_view bytes) {
  const auto first = std::ranges::find_if(bytes, is_line_break);
  return first != bytes.end() && *first == '\r' && (first + 1 == bytes.end() || first[1] != '\n');
}

// How long the backslash and line break at `at` are; 0 where there are none.
std::ptrdiff_t continuation_length(const char* at, const char* end) {
  if (*at != '\\' || end - at < 2 || !is_line_break(at[1])) return 0;
  return at[1] == '\r' && end - at > 2 && at[2] == '\n' ? 3 : 2;
}

}  // namespace

TextScanner::TextScanner(const InputFile& file) : TextScanner(file, file.bytes().data()) {
  if (file.bytes().starts_with("\xef\xbb\xbf")) at_ += 3;
}

TextScanner::TextScanner(const InputFile& file, const char* at)
    : file_(&file),
      at_(at),
      end_(file.bytes().data() + file.bytes().size()),
      line_end_(breaks_lines_with_cr_alone(file.bytes()) ? '\r' : '\n') {}

bool TextScanner::skip_blanks() {
  while (at_ != end_) {
    if (is_blank(*at_)) {
      ++at_;
    } else if (is_line_break(*at_)) {
      return false;
    } else if (*at_ == '#') {
      at_ = std::find_if(at_, end_, is_line_break);
      return false;
    } else if (const std::ptrdiff_t length = continuation_length(at_, end_)) {
      at_ += length;
    } else {
      return true;
    }
  }
  return false;
}

bool TextScanner::skip_space() {
  while (!skip_blanks()) {
    if (at_ == end_) return false;
    ++at_;
  }
  return true;
}

void TextScanner::skip_line() {
  const void* found = at_ == end_ ? nullptr : std::memchr(at_, line_end_, bytes_left());
  at_ = found ? static_cast<const char*>(found) + 1 : end_;
}

std::string_view TextScanner::word() {
  if (!skip_blanks()) return {};
  const char* first = at_;
  finish_word();
  return {first, static_cast<std::size_t>(at_ - first)};
}

void TextScanner::finish_word() {
  while (at_ != end_ && !is_blank(*at_) && !is_line_break(*at_)) ++at_;
}

double TextScanner::number() {
  if (!skip_blanks()) fail_number("a number");
  double value = 0;
  const char* digits = at_ + (*at_ == '+' ? 1 : 0);
  const auto [last, error] = fast_float::from_chars(digits, end_, value);
  if (error != std::errc() || !ends_word(last) || !std::isfinite(value)) fail_number("a finite number");
  at_ = last;
  return value;
}

Vec3 TextScanner::point() {
  const double x = number(), y = number(), z = number();
  return {x, y, z};
}

std::int64_t TextScanner::integer(char delimiter) {
  if (!skip_blanks()) fail_number("a whole number");
  std::int64_t value = 0;
  const auto [last, error] = std::from_chars(at_, end_, value);
  if (error != std::errc() || !(ends_word(last) || *last == delimiter)) fail_number("a whole number");
  at_ = last;
  return value;
}

bool TextScanner::ends_word(const char* at) const {
  return at == end_ || is_blank(*at) || is_line_break(*at) || *at == '#' || continuation_length(at, end_) > 0;
}

void TextScanner::fail_number(const char* expected) const {
  constexpr std::size_t longest_quotation = 40;  // a message is one line, and the word may be a binary file
  TextScanner here = *this;
  std::string value(here.word().substr(0, longest_quotation));
  const std::size_t comma = value.find(',');
  const auto is_digit = [&](std::size_t i) { return i < value.size() && value[i] >= '0' && value[i] <= '9'; };
  if (comma != std::string::npos && comma > 0 && is_digit(comma - 1) && is_digit(comma + 1))
    fail(at_, "not " + std::string(expected), std::move(value), "a decimal point, not a decimal comma",
         "an export under a locale with decimal points, LC_NUMERIC=C");
  if (!value.empty()) fail(at_, "not " + std::string(expected), std::move(value));
  // At the end of the line: position the error on it rather than on the line break's far side.
  fail(at_, at_ == end_ ? "the file ends where " + std::string(expected) + " is expected"
                        : std::string(expected) + " is missing");
}

bool is_keyword(std::string_view word, std::string_view expected) {
  return std::equal(word.begin(), word.end(), expected.begin(), expected.end(),
                    [](char a, char b) { return (a >= 'A' && a <= 'Z' ? static_cast<char>(a - 'A' + 'a') : a) == b; });
}

}  // namespace scan2fea
