#include "preproc/command/huge_pages.hpp"

#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <system_error>

namespace scan2fea::command {

void restart_with_huge_pages(char** argv) {
  // Blocks below 4 MiB come from a heap that grows by 64 MiB at once, instead of from pages of their own each time.
  constexpr const char* setting =
      "glibc.malloc.hugetlb=1:glibc.malloc.top_pad=67108864:glibc.malloc.mmap_threshold=4194304";
  if (std::getenv("GLIBC_TUNABLES") != nullptr || setenv("GLIBC_TUNABLES", setting, 1) != 0) return;
  std::error_code error;
  const std::filesystem::path program = std::filesystem::read_symlink("/proc/self/exe", error);
  if (!error) execv(program.c_str(), argv);
}

}  // namespace scan2fea::command
