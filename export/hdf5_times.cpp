#include "export/hdf5_times.hpp"

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <optional>
#include <string_view>

namespace scan2fea {
namespace {

std::uint64_t little_endian(std::string_view bytes) {
  std::uint64_t value = 0;
  for (std::size_t i = bytes.size(); i-- > 0;) value = value << 8 | static_cast<unsigned char>(bytes[i]);
  return value;
}

// Bob Jenkins' hash of 2006, "lookup3", of which HDF5 makes its checksums of metadata.
std::uint32_t lookup3(std::string_view bytes) {
  std::array<std::uint32_t, 3> s;
  s.fill(0xdeadbeef + static_cast<std::uint32_t>(bytes.size()));
  const auto take = [&](std::string_view twelve) {
    for (std::size_t k = 0; k < 3 && 4 * k < twelve.size(); ++k)
      s[k] += static_cast<std::uint32_t>(little_endian(twelve.substr(4 * k, 4)));
  };
  auto& [a, b, c] = s;
  const auto turn = [](std::uint32_t& x, std::uint32_t& y, std::uint32_t& z, int by) {  // of the mixing
    x -= z;
    x ^= std::rotl(z, by);
    z += y;
  };
  for (; bytes.size() > 12; bytes.remove_prefix(12)) {
    take(bytes.substr(0, 12));
    turn(a, b, c, 4);
    turn(b, c, a, 6);
    turn(c, a, b, 8);
    turn(a, b, c, 16);
    turn(b, c, a, 19);
    turn(c, a, b, 4);
  }
  if (bytes.empty()) return c;
  take(bytes);
  const auto end = [](std::uint32_t& x, std::uint32_t y, int by) {
    x ^= y;
    x -= std::rotl(y, by);
  };
  end(c, b, 14);
  end(a, c, 11);
  end(b, a, 25);
  end(c, b, 16);
  end(a, c, 4);
  end(b, a, 14);
  end(c, b, 24);
  return c;
}

struct Header {
  std::size_t times, checksum;  // where they stand, from the header's begin
};

constexpr std::string_view signature = "OHDR";
constexpr std::size_t size_of_times = 16, size_of_checksum = 4;

// Of a header that has times; the same bytes among numbers have another checksum.
std::optional<Header> header_at(std::string_view bytes) {
  constexpr std::size_t prefix = 6;  // signature, version, flags
  if (bytes.size() < prefix || bytes[4] != 2) return {};
  const auto flags = static_cast<unsigned char>(bytes[5]);
  if ((flags & 0x20U) == 0) return {};
  const std::size_t size_at = prefix + size_of_times + ((flags & 0x10U) != 0 ? 4 : 0);
  const std::size_t width = std::size_t{1} << (flags & 3U);
  if (bytes.size() < size_at + width) return {};
  const std::uint64_t messages = little_endian(bytes.substr(size_at, width));
  const std::size_t before = size_at + width + size_of_checksum;
  if (bytes.size() < before || messages > bytes.size() - before) return {};
  const std::size_t checksum = size_at + width + static_cast<std::size_t>(messages);
  if (little_endian(bytes.substr(checksum, size_of_checksum)) != lookup3(bytes.substr(0, checksum))) return {};
  return Header{prefix, checksum};
}

}  // namespace

void forget_times(std::string& hdf5) {
  for (std::size_t at = 0; (at = hdf5.find(signature, at)) != std::string::npos; ++at) {
    const auto header = header_at(std::string_view(hdf5).substr(at));
    if (!header) continue;
    std::memset(hdf5.data() + at + header->times, 0, size_of_times);
    const std::uint32_t checksum = lookup3(std::string_view(hdf5).substr(at, header->checksum));
    for (std::size_t k = 0; k < size_of_checksum; ++k)
      hdf5[at + header->checksum + k] = static_cast<char>(checksum >> (8 * k) & 0xffU);
  }
}

}  // namespace scan2fea
