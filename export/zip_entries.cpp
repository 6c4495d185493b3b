#include "export/zip_entries.hpp"

#include "preproc/mesh/byte_order.hpp"
#include "preproc/mesh/gzip.hpp"
#include "preproc/mesh/require_memory.hpp"

#include <bit>
#include <cstdint>

namespace scan2fea {
namespace {

template <class T>
T little(std::string_view bytes, std::size_t at) {
  return load<T>(bytes.data() + at, std::endian::little);
}

// The record at the end, behind which a comment may follow.
std::size_t find_end_record(const InputFile& file) {
  constexpr std::size_t size = 22;
  const std::size_t at = file.bytes().rfind("PK\x05\x06");
  if (at == std::string_view::npos || at + size > file.bytes().size()) file.fail("not a ZIP, or cut short");
  return at;
}

}  // namespace

std::vector<ZipEntry> zip_entries(const InputFile& file) {
  constexpr std::size_t directory_head = 46, local_head = 30;
  const std::string_view bytes = file.bytes();
  const std::size_t end = find_end_record(file);
  const std::size_t count = little<std::uint16_t>(bytes, end + 10);
  std::size_t at = little<std::uint32_t>(bytes, end + 16);
  std::vector<ZipEntry> entries;
  for (std::size_t e = 0; e < count; ++e) {
    if (at + directory_head > bytes.size() || !bytes.substr(at).starts_with("PK\x01\x02"))
      file.fail("the directory of the ZIP is broken");
    const std::size_t name = little<std::uint16_t>(bytes, at + 28), extra = little<std::uint16_t>(bytes, at + 30),
                      comment = little<std::uint16_t>(bytes, at + 32);
    const unsigned method = little<std::uint16_t>(bytes, at + 10);
    const std::size_t size = little<std::uint32_t>(bytes, at + 20), local = little<std::uint32_t>(bytes, at + 42);
    if (at + directory_head + name > bytes.size() || local + local_head > bytes.size())
      file.fail("the directory of the ZIP is broken");
    ZipEntry entry{std::string(bytes.substr(at + directory_head, name)), {}, method == 8};
    const std::size_t begin =
        local + local_head + little<std::uint16_t>(bytes, local + 26) + little<std::uint16_t>(bytes, local + 28);
    if (begin > bytes.size() || size > bytes.size() - begin) file.fail("an entry of the ZIP is cut short", entry.name);
    entry.bytes = bytes.substr(begin, size);
    if (method == 0 || method == 8) entries.push_back(std::move(entry));
    at += directory_head + name + extra + comment;
  }
  return entries;
}

std::string content_of(const ZipEntry& entry, const InputFile& file) {
  if (!entry.deflated) return std::string(entry.bytes);
  gzip::Expander expander(entry.bytes, gzip::Wrapping::none);
  std::string content(4 * entry.bytes.size() + 1024, '\0');
  for (std::size_t size = 0;;) {
    size += expander.read({content.data() + size, content.size() - size});
    if (expander.is_broken()) file.fail("an entry of the ZIP is broken", entry.name);
    if (expander.is_at_end()) {
      content.resize(size);
      return content;
    }
    if (size < content.size()) continue;
    require_memory(2 * static_cast<double>(content.size()), 1, "bytes", "less in one file");
    content.resize(2 * content.size());
  }
}

}  // namespace scan2fea
