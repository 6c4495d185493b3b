#include "preproc/mesh/temporary_folder.hpp"

#include "preproc/mesh/error.hpp"

#include <cerrno>
#include <cstdlib>
#include <stdlib.h>  // mkdtemp
#include <system_error>

namespace scan2fea {
namespace {

[[noreturn]] void fail(const std::filesystem::path& where, const std::error_code& reason) {
  throw IoError({.what = "cannot make a temporary folder",
                 .where = where.string(),
                 .value = reason.message(),
                 .limit = {},
                 .advice = "set TMPDIR to a folder that can be written"});
}

}  // namespace

TemporaryFolder::TemporaryFolder() {
  std::error_code error;
  const std::filesystem::path parent = std::filesystem::temp_directory_path(error);
  if (error) {  // the library does not tell which folder it has tried
    const char* set = std::getenv("TMPDIR");
    fail(set != nullptr ? set : "", error);
  }
  std::string pattern = (parent / "scan2fea-XXXXXX").string();
  if (::mkdtemp(pattern.data()) == nullptr) fail(parent, {errno, std::generic_category()});
  path_ = pattern;
}

TemporaryFolder::~TemporaryFolder() {
  std::error_code ignored;
  std::filesystem::remove_all(path_, ignored);
}

}  // namespace scan2fea
