#include "preproc/mesh/input_file.hpp"

#include "preproc/mesh/error.hpp"
#include "preproc/mesh/gzip.hpp"
#include "preproc/mesh/require_memory.hpp"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <fcntl.h>
#include <fstream>
#include <sstream>
#include <sys/mman.h>
#include <unistd.h>

namespace scan2fea {

InputFile::InputFile(std::filesystem::path path) : path_(std::move(path)) {
  read();
  if (bytes().starts_with("\x1f\x8b")) expand();
  if (size_ == 0) fail("the file is empty");
}

void InputFile::read() {
  std::error_code error;
  const auto status = std::filesystem::status(path_, error);
  if (status.type() == std::filesystem::file_type::not_found) fail("no such file");
  if (std::filesystem::is_directory(status)) fail("this is a directory", {}, {}, "one of the files in it");

  errno = 0;
  std::ifstream stream(path_, std::ios::binary);
  if (!stream) fail("the file cannot be opened", std::strerror(errno));
  if (std::filesystem::is_regular_file(status)) {
    const std::uintmax_t size = std::filesystem::file_size(path_, error);
    if (error) fail("the file cannot be read", error.message());
    constexpr std::uintmax_t too_large_to_read_whole = 1U << 30;
    if (size >= too_large_to_read_whole && map(size)) return;
    auto bytes = std::make_unique_for_overwrite<char[]>(size);
    stream.read(bytes.get(), static_cast<std::streamsize>(size));
    size_ = static_cast<std::size_t>(stream.gcount());
    bytes_ = {bytes.release(), ReleaseBytes{}};
  } else {  // a pipe does not know its size
    std::ostringstream all;
    all << stream.rdbuf();
    size_ = all.view().size();
    auto bytes = std::make_unique_for_overwrite<char[]>(size_);
    std::copy(all.view().begin(), all.view().end(), bytes.get());
    bytes_ = {bytes.release(), ReleaseBytes{}};
  }
  if (stream.bad()) fail("the file cannot be read", std::strerror(errno));
}

// False where the file's system cannot.
bool InputFile::map(std::size_t size) {
  const int file = ::open(path_.c_str(), O_RDONLY | O_CLOEXEC);
  if (file < 0) return false;
  void* bytes = ::mmap(nullptr, size, PROT_READ, MAP_PRIVATE, file, 0);
  ::close(file);
  if (bytes == MAP_FAILED) return false;
  bytes_ = {static_cast<const char*>(bytes), ReleaseBytes{size}};
  size_ = size;
  return true;
}

void ReleaseBytes::operator()(const char* bytes) const {
  if (mapped > 0)
    ::munmap(const_cast<char*>(bytes), mapped);
  else
    delete[] bytes;
}

// A gzip file is one member behind another.
void InputFile::expand() {
  gzip::Expander expander(bytes());
  std::size_t capacity = 4 * size_ + 1024, size = 0;
  auto expanded = std::make_unique_for_overwrite<char[]>(capacity);
  for (;;) {
    size += expander.read({expanded.get() + size, capacity - size});
    if (expander.is_broken()) fail("the compressed file is broken", {}, {}, "gzip --test");
    if (expander.is_at_end()) break;
    if (size < capacity) continue;
    capacity *= 2;
    require_memory(static_cast<double>(capacity), 1, "bytes", "less in one file");
    auto larger = std::make_unique_for_overwrite<char[]>(capacity);
    std::copy_n(expanded.get(), size, larger.get());
    expanded = std::move(larger);
  }
  bytes_ = {expanded.release(), ReleaseBytes{}};
  size_ = size;
}

void InputFile::fail(std::string what, std::string value, std::string limit, std::string advice) const {
  throw InvalidInput({std::move(what), path_.string(), std::move(value), std::move(limit), std::move(advice)});
}

void InputFile::fail_at_line(const char* at, std::string what, std::string value, std::string limit,
                             std::string advice) const {
  std::size_t line = 1;
  for (const char* c = bytes_.get(); c < at; ++c)
    line += *c == '\n' || (*c == '\r' && !(c + 1 < bytes_.get() + size_ && c[1] == '\n'));
  throw InvalidInput({std::move(what), path_.string() + ":" + std::to_string(line), std::move(value), std::move(limit),
                      std::move(advice)});
}

void InputFile::fail_at_byte(const char* at, std::string what, std::string value, std::string limit,
                             std::string advice) const {
  throw InvalidInput({std::move(what), path_.string() + ": byte " + std::to_string(at - bytes_.get()), std::move(value),
                      std::move(limit), std::move(advice)});
}

}  // namespace scan2fea
