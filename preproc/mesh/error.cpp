#include "preproc/mesh/error.hpp"

#include "preproc/mesh/error_text.hpp"

#include <utility>

namespace scan2fea {
namespace {

std::string one_line(const ErrorParts& parts) {
  std::string line;
  if (!parts.where.empty()) line = parts.where;
  if (parts.at) line += (line.empty() ? "" : " at ") + error_text(*parts.at);
  if (!line.empty()) line += ": ";
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

Error::Error(ErrorParts parts) {
  amend(std::move(parts));
}

void Error::amend(ErrorParts parts) {
  parts_ = std::move(parts);
  line_ = one_line(parts_);
}

OutOfTime::OutOfTime(std::string_view stage)
    : NotMeshable({.what = "the time limit ended the work before there was a valid mesh",
                   .where = {},
                   .value = "it was at '" + std::string(stage) + "'",
                   .limit = {},
                   .advice = "a longer --time-limit, --effort low, or fewer triangles"}) {}

Cancelled::Cancelled() : Error({.what = "interrupted", .where = {}, .value = {}, .limit = {}, .advice = {}}) {}

}  // namespace scan2fea
