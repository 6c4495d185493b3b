// How the program ends where there is no memory left. It has no header: being linked is enough, which is why it is of
// the program alone and not of what others link.
#include "preproc/mesh/output_file.hpp"

#include <cstdlib>
#include <exception>
#include <new>
#include <string_view>
#include <unistd.h>

namespace scan2fea::command {
namespace {

constexpr int without_memory = 4;

// Where memory is so short that there is none for an exception, or where the exception is one that nobody may throw.
[[noreturn]] void end_without_memory() {
  try {
    if (const std::exception_ptr exception = std::current_exception()) std::rethrow_exception(exception);
  } catch (const std::bad_alloc&) {
  } catch (...) {
    std::abort();
  }
  remove_unfinished_outputs();
  constexpr std::string_view line = "scan2fea: out of memory\n";
  [[maybe_unused]] const ssize_t ignored = ::write(STDERR_FILENO, line.data(), line.size());
  ::_exit(without_memory);
}

// Before what other sources make at the start.
[[gnu::constructor(101)]] void end_when_out_of_memory() {
  std::set_terminate(end_without_memory);
}

}  // namespace
}  // namespace scan2fea::command
