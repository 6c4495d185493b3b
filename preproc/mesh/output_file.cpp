#include "preproc/mesh/output_file.hpp"

#include "preproc/mesh/error.hpp"
#include "preproc/mesh/file_extension.hpp"

#include <climits>

#include <array>
#include <atomic>
#include <cassert>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <fcntl.h>
#include <string>
#include <sys/resource.h>
#include <unistd.h>

namespace scan2fea {
namespace {

namespace fs = std::filesystem;

// Names that are to be taken away if the process ends. Arrays that stay, since a signal handler may look at them at any
// moment; more names than these at a time, which nobody has, are not known to it.
struct UnfinishedName {
  std::atomic<bool> taken{false}, valid{false};
  char path[PATH_MAX] = {};
};
std::array<UnfinishedName, 16> unfinished;
static_assert(std::atomic<bool>::is_always_lock_free, "a signal handler may touch lock-free atomics only");

void note_unfinished(const fs::path& path) {
  if (path.native().size() >= PATH_MAX) return;
  for (UnfinishedName& name : unfinished) {
    if (name.taken.exchange(true)) continue;
    std::strcpy(name.path, path.c_str());
    name.valid = true;
    return;
  }
}

void note_finished(const fs::path& path) {
  for (UnfinishedName& name : unfinished) {
    if (!name.valid || path != name.path) continue;
    name.valid = false;
    name.taken = false;
    return;
  }
}

[[noreturn]] void fail(const fs::path& target, std::string what, std::string reason, std::string advice) {
  throw IoError({std::move(what), target.string(), std::move(reason), {}, std::move(advice)});
}

fs::path folder_of(const fs::path& target, OutputFile::Folder which) {
  fs::path folder = target.has_parent_path() ? target.parent_path() : fs::path(".");
  std::error_code error;
  if (which == OutputFile::Folder::is_made)
    while (!fs::exists(folder, error)) folder = folder.has_parent_path() ? folder.parent_path() : fs::path(".");
  return folder;
}

// By which a file that this process has open can be opened again, and be given a name.
std::string path_of(int descriptor) {
  return "/proc/self/fd/" + std::to_string(descriptor);
}

// A name that nobody else has, `stem.tmp-PID-N.extension`, given by `give`, which fails with EEXIST where it exists.
// Among machines that share the folder, too.
template <class Give>
fs::path temporary_name(const fs::path& folder, const fs::path& target, const Give& give) {
  const std::string stem = target.stem().string() + ".tmp-" + std::to_string(::getpid()) + "-";
  for (unsigned n = 0;; ++n) {
    const fs::path name = folder / (stem + std::to_string(n) + lower_case_extension(target));
    note_unfinished(name);
    if (give(name)) return name;
    note_finished(name);
    if (errno != EEXIST)
      fail(target, "the output cannot be created", std::strerror(errno), "a folder that exists and can be written");
  }
}

// Through a symbolic link the file that it names is replaced, not the link.
fs::path resolved(fs::path target) {
  std::error_code error;
  const auto status = fs::status(target, error);
  if (fs::exists(status) && !fs::is_regular_file(status))
    fail(target, "the output is not a regular file", {}, "another name");
  if (!fs::is_symlink(target, error)) return target;
  fs::path canonical = fs::canonical(target, error);
  return error ? target : canonical;
}

// Processes may open few files, 1024 by default, until they ask for as many as they are allowed.
void allow_more_open_files() {
  rlimit limit{};
  if (::getrlimit(RLIMIT_NOFILE, &limit) != 0) return;
  limit.rlim_cur = limit.rlim_max;
  ::setrlimit(RLIMIT_NOFILE, &limit);
}

// While one of these lives, none comes through to this thread: what ends the process waits until all files are there.
class NoSignals {
 public:
  NoSignals() {
    sigset_t all;
    sigfillset(&all);
    ::pthread_sigmask(SIG_BLOCK, &all, &before_);
  }
  ~NoSignals() { ::pthread_sigmask(SIG_SETMASK, &before_, nullptr); }
  NoSignals(const NoSignals&) = delete;
  NoSignals& operator=(const NoSignals&) = delete;

 private:
  sigset_t before_;
};

}  // namespace

// The file's permissions are those of any new file, which mkstemp's would not be.
OutputFile::OutputFile(fs::path target, Folder folder)
    : name_(std::move(target)), target_(resolved(name_)), folder_(folder_of(target_, folder)) {
  constexpr mode_t permissions = 0666;
  descriptor_ = ::open(folder_.c_str(), O_TMPFILE | O_WRONLY | O_CLOEXEC, permissions);
  if (descriptor_ >= 0) {
    stream_.open(path_of(descriptor_), std::ios::binary);
    if (stream_) return;
    ::close(descriptor_);  // where /proc is missing
  }
  // Network file systems know no files without names.
  temporary_ = temporary_name(folder_, target_, [&](const fs::path& name) {
    descriptor_ = ::open(name.c_str(), O_CREAT | O_EXCL | O_WRONLY | O_CLOEXEC, permissions);
    return descriptor_ >= 0;
  });
  stream_.open(temporary_, std::ios::binary);
  if (stream_) return;
  const std::string reason = std::strerror(errno);
  ::close(descriptor_);
  ::unlink(temporary_.c_str());
  note_finished(temporary_);
  fail(target_, "the output cannot be opened", reason, "a folder that can be written");
}

OutputFile::~OutputFile() {
  ::close(descriptor_);
  if (temporary_.empty()) return;
  stream_.close();
  std::error_code ignored;
  fs::remove(temporary_, ignored);
  note_finished(temporary_);
}

const fs::path& OutputFile::temporary_path() {
  if (temporary_.empty()) give_name();
  return temporary_;
}

void OutputFile::give_name() {
  temporary_ = temporary_name(folder_, target_, [&](const fs::path& name) {
    return ::linkat(AT_FDCWD, path_of(descriptor_).c_str(), AT_FDCWD, name.c_str(), AT_SYMLINK_FOLLOW) == 0;
  });
}

void OutputFile::finish() {
  if (!stream_.is_open()) return;
  errno = 0;
  stream_.close();  // flushes
  if (!stream_)
    fail(target_, "not all of the output could be written", errno ? std::strerror(errno) : "", "freeing disk space");
}

void OutputFile::commit() {
  finish();
  assert(descriptor_ >= 0 && "committed twice");
  std::error_code error;
  const fs::path temporary = temporary_path();
  if (target_.has_parent_path()) fs::create_directories(target_.parent_path(), error);
  if (!error) fs::rename(temporary, target_, error);
  if (error) fail(target_, "the output cannot be put in place", error.message(), "another name or folder");
  note_finished(temporary_);
  temporary_.clear();
  ::close(descriptor_);
  descriptor_ = -1;
}

fs::path OutputFile::readable_path() const {
  return temporary_.empty() ? fs::path(path_of(descriptor_)) : temporary_;
}

OutputFile& OutputFiles::open(const fs::path& target, OutputFile::Folder folder) {
  // Each holds a descriptor until it is in place.
  constexpr std::size_t many = 200;
  std::size_t open_files = 0;
  for (const OutputFiles* files = this; files != nullptr; files = files->owner_) open_files += files->files_.size();
  if (open_files == many) allow_more_open_files();
  return files_.emplace_back(target, folder);
}

void OutputFiles::add(const fs::path& target, const std::string& text, OutputFile::Folder folder) {
  OutputFile& file = open(target, folder);
  file.stream() << text;
  file.finish();
}

void OutputFiles::commit() {
  for (OutputFile& file : files_) file.finish();
  if (owner_ != nullptr) {
    owner_->files_.splice(owner_->files_.end(), files_);
  } else {
    const NoSignals no_signals;
    for (OutputFile& file : files_) file.commit();
  }
  std::error_code ignored;
  for (const fs::path& file : obsolete_) fs::remove(file, ignored);
}

void remove_unfinished_outputs() noexcept {
  for (const UnfinishedName& name : unfinished)
    if (name.valid) ::unlink(name.path);
}

}  // namespace scan2fea
