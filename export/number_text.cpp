#include "export/number_text.hpp"

#include <fast_float/fast_float.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstring>
#include <string>

namespace scan2fea {
namespace {

// Longer than any form with 17 digits in the ranges asked for below.
struct Text {
  char characters[64];
  std::size_t size = 0;

  std::string_view view() const { return {characters, size}; }
};

template <class... Form>
Text printed(double value, Form... form) {
  Text text;
  const auto result = std::to_chars(text.characters, std::end(text.characters), value, form...);
  text.size = static_cast<std::size_t>(result.ptr - text.characters);
  return text;
}

// "1e-05" -> "1e-5", "1e+20" -> "1e20": readers want neither the sign nor the zeros, and a digit fits instead.
Text without_exponent_padding(Text text) {
  const std::size_t e = text.view().find('e');
  if (e == std::string_view::npos) return text;
  char* out = text.characters + e + 1;
  const char* in = out;
  const char* const end = text.characters + text.size;
  if (*in == '-')
    *out++ = *in++;
  else if (*in == '+')
    ++in;
  while (in + 1 < end && *in == '0') ++in;
  out = std::copy(in, end, out);
  text.size = static_cast<std::size_t>(out - text.characters);
  return text;
}

// "-0.0123" -> "-.0123"
Text without_leading_zero(Text text) {
  const std::size_t zero = text.characters[0] == '-' ? 1 : 0;
  if (text.size < zero + 2 || text.characters[zero] != '0' || text.characters[zero + 1] != '.') return text;
  std::memmove(text.characters + zero, text.characters + zero + 1, text.size - zero - 1);
  --text.size;
  return text;
}

Text scientific(double value, int digits) {
  return without_exponent_padding(printed(value, std::chars_format::scientific, digits - 1));
}

std::optional<Text> fixed(double value, int digits) {
  const int exponent = static_cast<int>(std::floor(std::log10(std::abs(value))));
  const int decimals = digits - 1 - exponent;
  if (decimals < 0 || decimals > 20) return {};
  return without_leading_zero(printed(value, std::chars_format::fixed, decimals));
}

// "1.5e-3" -> "1.5-3", "2e5" -> "2.+5", "2" -> "2."
Text in_nastran_form(const Text& text) {
  const std::string_view all = text.view(), mantissa = all.substr(0, all.find('e')),
                         exponent = all.substr(std::min(mantissa.size() + 1, all.size()));
  Text result;
  const auto add = [&](std::string_view piece) {
    std::copy(piece.begin(), piece.end(), result.characters + result.size);
    result.size += piece.size();
  };
  add(mantissa);
  if (mantissa.find('.') == std::string_view::npos) add(".");
  if (!exponent.empty() && exponent.front() != '-') add("+");
  add(exponent);
  return result;
}

std::optional<double> number_of_all(std::string_view text) {
  double value = 0;
  const auto [end, error] = fast_float::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size()) return {};
  return value;
}

}  // namespace

std::optional<double> read_number(std::string_view text) {
  if (const auto value = number_of_all(text)) return value;
  std::string with_letters;
  for (const char c : text) {
    const bool sign_of_exponent = (c == '-' || c == '+') && !with_letters.empty() && with_letters.back() != 'e';
    if (c == 'd' || c == 'D' || c == 'E')
      with_letters += 'e';
    else
      (sign_of_exponent ? with_letters += 'e' : with_letters) += c;
  }
  return number_of_all(with_letters);
}

double as_written(double value) {
  if (!std::isfinite(value)) return value;
  char text[longest_number];
  return read_number({text, write_number(text, value)}).value_or(value);
}

double as_written_for_nastran(double value) {
  if (!std::isfinite(value)) return value;
  char text[nastran_width];
  return read_number({text, write_nastran_number(text, value)}).value_or(value);
}

char* write_number(char* text, double value) {
  Text best = without_exponent_padding(printed(value));
  for (int digits = 17; best.size > longest_number; --digits) {
    best = scientific(value, digits);
    if (best.size <= longest_number) break;
    if (const auto candidate = fixed(value, digits); candidate && candidate->size <= longest_number) best = *candidate;
  }
  return std::copy_n(best.characters, best.size, text);
}

char* write_nastran_number(char* text, double value) {
  Text best = in_nastran_form(without_exponent_padding(printed(value)));
  for (int digits = 17; best.size > nastran_width; --digits) {
    best = in_nastran_form(scientific(value, digits));
    if (best.size <= nastran_width) break;
    if (const auto candidate = fixed(value, digits)) {
      const Text with_point = in_nastran_form(*candidate);
      if (with_point.size <= nastran_width) best = with_point;
    }
  }
  return std::copy_n(best.characters, best.size, text);
}

}  // namespace scan2fea
