#include "preproc/command/restart.hpp"

#include "preproc/mesh/huge_pages.hpp"

#include <cstdlib>
#include <filesystem>
#include <system_error>
#include <unistd.h>

namespace scan2fea::command {

void restart_with_huge_pages(char** argv) {
  if (std::getenv(allocator_variable) != nullptr || setenv(allocator_variable, allocator_setting, 1) != 0) return;
  std::error_code error;
  const std::filesystem::path program = std::filesystem::read_symlink("/proc/self/exe", error);
  if (!error) execv(program.c_str(), argv);
}

}  // namespace scan2fea::command
