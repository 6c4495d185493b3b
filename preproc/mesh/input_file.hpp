// One input file, and the errors about what it holds.
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <string_view>

namespace scan2fea {

// Gives back what new[] gave, or mmap where `mapped` bytes are.
struct ReleaseBytes {
  std::size_t mapped = 0;
  void operator()(const char* bytes) const;
};

// Read whole rather than mapped: a mapped file that another program shortens meanwhile ends the process with SIGBUS,
// and a pipe cannot be mapped. Files of a gigabyte and more are mapped all the same, since memory may not hold them: a
// process should then end on SIGBUS with a message. What is compressed by gzip is expanded, whatever the file is
// called.
class InputFile {
 public:
  // Throws InvalidInput where the file is missing, a directory, unreadable, empty, or broken gzip; NotMeshable where
  // memory does not hold what it expands to.
  explicit InputFile(std::filesystem::path path);

  const std::filesystem::path& path() const { return path_; }
  std::string_view bytes() const { return {bytes_.get(), size_}; }

  // Throw InvalidInput for the file, the line or the byte of `at`, which points into `bytes()`. Lines are counted here,
  // not while reading: they are asked for once at most.
  [[noreturn]] void fail(std::string what, std::string value = {}, std::string limit = {},
                         std::string advice = {}) const;
  [[noreturn]] void fail_at_line(const char* at, std::string what, std::string value = {}, std::string limit = {},
                                 std::string advice = {}) const;
  [[noreturn]] void fail_at_byte(const char* at, std::string what, std::string value = {}, std::string limit = {},
                                 std::string advice = {}) const;

 private:
  void read();
  bool map(std::size_t size);
  void expand();

  std::filesystem::path path_;
  std::unique_ptr<const char[], ReleaseBytes> bytes_;
  std::size_t size_ = 0;
};

}  // namespace scan2fea
