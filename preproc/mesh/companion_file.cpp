#include "preproc/mesh/companion_file.hpp"

#include <dlfcn.h>
#include <link.h>
#include <system_error>

namespace scan2fea {
namespace {

namespace fs = std::filesystem;

// Of the executable or shared library that this function was linked into. The loader knows the executable by the name
// that it was called with, which need not be a path: the kernel knows better.
fs::path folder_of_this_code() {
  Dl_info info;
  void* entry = nullptr;
  const void* here = reinterpret_cast<const void*>(&folder_of_this_code);
  fs::path file = "/proc/self/exe";
  if (::dladdr1(here, &info, &entry, RTLD_DL_LINKMAP) != 0) {
    const char* library = static_cast<const link_map*>(entry)->l_name;
    if (*library != '\0') file = library;
  }
  std::error_code error;
  return fs::canonical(file, error).parent_path();
}

}  // namespace

fs::path companion_file(std::string_view name) {
  const fs::path folder = folder_of_this_code();
  const fs::path beside = folder / name;
  for (const char* companions :
       {".", SCAN2FEA_COMPANIONS_FROM_COMMAND, SCAN2FEA_COMPANIONS_FROM_LIBRARY, SCAN2FEA_COMPANIONS_FROM_PYTHON}) {
    const fs::path file = (folder / companions / name).lexically_normal();
    std::error_code error;
    if (fs::exists(file, error)) return file;
  }
  return beside;
}

}  // namespace scan2fea
