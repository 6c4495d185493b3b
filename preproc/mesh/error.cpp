#include "preproc/mesh/error.hpp"

namespace scan2fea {
namespace {

std::string one_line(const ErrorParts& parts) {
  std::string line;
  if (!parts.where.empty()) line = parts.where + ": ";
  line += parts.what;
  if (!parts.value.empty()) line += ": " + parts.value;
  if (!parts.limit.empty()) line += " (limit: " + parts.limit + ")";
  if (!parts.advice.empty()) line += "; try: " + parts.advice;
  // Names and values come from files: a line break or an escape sequence in them must not reach the terminal.
  for (char& c : line)
    if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f) c = ' ';
  return line;
}

}  // namespace

Error::Error(ErrorParts parts) : std::runtime_error(one_line(parts)), parts_(std::move(parts)) {}

OutOfTime::OutOfTime(std::string_view stage)
    : NotMeshable({.what = "the time limit ended the work before there was a valid mesh",
                   .where = {},
                   .value = "it was at '" + std::string(stage) + "'",
                   .limit = {},
                   .advice = "a longer --time-limit, --effort low, or fewer triangles"}) {}

Cancelled::Cancelled() : Error({.what = "interrupted", .where = {}, .value = {}, .limit = {}, .advice = {}}) {}

}  // namespace scan2fea
