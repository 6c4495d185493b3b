#include "preproc/mesh/output_file.hpp"

#include "preproc/mesh/error.hpp"

#include <cassert>
#include <cerrno>
#include <cstring>
#include <fcntl.h>
#include <string>
#include <unistd.h>

namespace scan2fea {
namespace {

[[noreturn]] void fail(const std::filesystem::path& target, std::string what, std::string reason, std::string advice) {
  throw IoError({std::move(what), target.string(), std::move(reason), {}, std::move(advice)});
}

// Creates `stem.tmp-PID-N.extension` beside the target. O_EXCL makes the name ours, also among machines that share the
// folder; the file's permissions are those of any new file, which mkstemp's would not be.
std::filesystem::path create_beside(const std::filesystem::path& target) {
  const std::string stem = target.stem().string() + ".tmp-" + std::to_string(::getpid()) + "-";
  for (unsigned n = 0;; ++n) {
    std::filesystem::path temporary = target;
    temporary.replace_filename(stem + std::to_string(n) + target.extension().string());
    const int descriptor = ::open(temporary.c_str(), O_CREAT | O_EXCL | O_WRONLY | O_CLOEXEC, 0666);
    if (descriptor >= 0) {
      ::close(descriptor);
      return temporary;
    }
    if (errno != EEXIST)
      fail(target, "the output cannot be created", std::strerror(errno), "a folder that exists and can be written");
  }
}

// Through a symbolic link the file that it names is replaced, not the link.
std::filesystem::path resolved(std::filesystem::path target) {
  std::error_code error;
  const auto status = std::filesystem::status(target, error);
  if (std::filesystem::exists(status) && !std::filesystem::is_regular_file(status))
    fail(target, "the output is not a regular file", {}, "another name");
  if (!std::filesystem::is_symlink(target, error)) return target;
  std::filesystem::path canonical = std::filesystem::canonical(target, error);
  return error ? target : canonical;
}

}  // namespace

OutputFile::OutputFile(std::filesystem::path target)
    : target_(resolved(std::move(target))), temporary_(create_beside(target_)) {
  stream_.open(temporary_, std::ios::binary);
  if (!stream_) {
    const std::string reason = std::strerror(errno);
    std::error_code ignored;
    std::filesystem::remove(temporary_, ignored);
    fail(target_, "the output cannot be opened", reason, "a folder that can be written");
  }
}

OutputFile::~OutputFile() {
  if (temporary_.empty()) return;
  stream_.close();
  std::error_code ignored;
  std::filesystem::remove(temporary_, ignored);
}

void OutputFile::commit() {
  assert(!temporary_.empty() && "committed twice");
  errno = 0;
  stream_.close();  // flushes
  if (!stream_)
    fail(target_, "not all of the output could be written", errno ? std::strerror(errno) : "", "freeing disk space");
  std::error_code error;
  std::filesystem::rename(temporary_, target_, error);
  if (error) fail(target_, "the output cannot be put in place", error.message(), "another name or folder");
  temporary_.clear();
}

}  // namespace scan2fea
