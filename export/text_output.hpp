// A buffer between a writer and its stream: numbers are printed into memory and written by the megabyte.
#pragma once

#include "export/number_text.hpp"

#include <charconv>
#include <concepts>
#include <iterator>
#include <ostream>
#include <string>
#include <string_view>

namespace scan2fea {

class TextOutput {
 public:
  explicit TextOutput(std::ostream& stream) : stream_(stream) { buffer_.reserve(capacity); }
  ~TextOutput() { flush(); }
  TextOutput(const TextOutput&) = delete;
  TextOutput& operator=(const TextOutput&) = delete;

  TextOutput& operator<<(std::string_view text) {
    if (buffer_.size() + text.size() > capacity) flush();
    buffer_.append(text);
    return *this;
  }
  // As short as CalculiX wants it, see write_number.
  TextOutput& operator<<(double value) {
    char text[longest_number];
    return *this << std::string_view(text, write_number(text, value));
  }
  // The shortest form that reads back to the same bits, however long.
  TextOutput& exact(double value) {
    char text[32];
    return *this << std::string_view(text, std::to_chars(text, std::end(text), value).ptr);
  }
  TextOutput& operator<<(std::integral auto value) {
    char text[24];
    return *this << std::string_view(text, std::to_chars(text, std::end(text), value).ptr);
  }

 private:
  static constexpr std::size_t capacity = 1 << 20;  // bytes; what the stream is handed at a time

  void flush() {
    stream_.write(buffer_.data(), static_cast<std::streamsize>(buffer_.size()));
    buffer_.clear();
  }

  std::ostream& stream_;
  std::string buffer_;
};

// For header comments: control characters become spaces, so that a text cannot end its comment.
std::string one_line(std::string_view text);

}  // namespace scan2fea
