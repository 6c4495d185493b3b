#include "export/vtk_xml.hpp"

#include "export/compressed_blocks.hpp"
#include "preproc/mesh/byte_order.hpp"

#include <fast_float/fast_float.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <stdexcept>
#include <utility>

namespace scan2fea::vtk_xml {
namespace {

bool is_space(char c) {
  return c == ' ' || c == '\t' || c == '\n' || c == '\r';
}

std::size_t skip_spaces(std::string_view text, std::size_t i) {
  while (i < text.size() && is_space(text[i])) ++i;
  return i;
}

int base64_value(char c) {
  if (c >= 'A' && c <= 'Z') return c - 'A';
  if (c >= 'a' && c <= 'z') return c - 'a' + 26;
  if (c >= '0' && c <= '9') return c - '0' + 52;
  if (c == '+') return 62;
  if (c == '/') return 63;
  return -1;
}

// The first `wanted` bytes, or fewer where the text ends. A padded group may be followed by further groups: VTK pads
// the array's header and its data apart from one another, other writers encode both in one go.
std::string decode_base64(std::string_view text, std::size_t wanted) {
  std::string bytes;
  unsigned group = 0;
  int count = 0;
  int padding = 0;
  for (const char c : text) {
    if (bytes.size() >= wanted) break;
    if (is_space(c)) continue;
    const int value = base64_value(c);
    if (c == '=')
      ++padding;
    else if (value < 0 || padding > 0)
      break;
    group = group << 6 | static_cast<unsigned>(std::max(value, 0));
    if (++count < 4) continue;
    for (int k = 0; k < 3 - padding; ++k) bytes += static_cast<char>(group >> (16 - 8 * k) & 0xff);
    group = 0;
    count = padding = 0;
  }
  if (bytes.size() > wanted) bytes.resize(wanted);
  return bytes;
}

std::uint64_t load_header(std::string_view bytes, const Storage& storage) {
  if (bytes.size() < (storage.header_64 ? 8U : 4U)) throw std::runtime_error("is truncated");
  return storage.header_64 ? load<std::uint64_t>(bytes.data(), storage.byte_order)
                           : load<std::uint32_t>(bytes.data(), storage.byte_order);
}

// Text that holds an array, from where its bytes start.
struct Encoded {
  std::string_view text;
  bool base64;

  // The first bytes; fewer where there are no more.
  std::string first(std::size_t wanted) const {
    return base64 ? decode_base64(text, wanted) : std::string(text.substr(0, wanted));
  }
  // What follows so many bytes that were encoded by themselves.
  Encoded behind(std::size_t bytes) const {
    if (!base64) return {text.substr(std::min(bytes, text.size())), false};
    std::size_t left = (bytes + 2) / 3 * 4, i = 0;
    for (; i < text.size() && left > 0; ++i)
      if (!is_space(text[i])) --left;
    return {text.substr(i), true};
  }
};

Encoded encoded(const DataArray& array, const Storage& storage) {
  if (array.tag.attribute("format") != "appended") return {array.content, true};
  const std::string offset_text = array.tag.attribute("offset");
  std::uint64_t offset = 0;
  const auto result = std::from_chars(offset_text.data(), offset_text.data() + offset_text.size(), offset);
  if (result.ec != std::errc() || offset > storage.appended.size()) throw std::runtime_error("has a wrong offset");
  return {storage.appended.substr(offset), storage.appended_base64};
}

// A header of the number of blocks, their size, that of the last one (0: as the others), and the compressed size of
// each; then the blocks.
std::string compressed_bytes(const Encoded& encoded, const Storage& storage) {
  const std::size_t word = storage.header_64 ? 8 : 4;
  const auto entry = [&](const std::string& header, std::size_t i) {
    return load_header(std::string_view(header).substr(std::min(i * word, header.size())), storage);
  };
  const std::uint64_t blocks = entry(encoded.first(word), 0);
  if (blocks == 0) return {};
  if (blocks > encoded.text.size() / word) throw std::runtime_error("is truncated");
  const std::string header = encoded.first((3 + blocks) * word);
  BlockSizes sizes{.block = entry(header, 1), .last = entry(header, 2), .compressed = {}};
  std::uint64_t total = 0;
  for (std::uint64_t b = 0; b < blocks; ++b) {
    sizes.compressed.push_back(entry(header, 3 + b));
    if (sizes.compressed.back() > encoded.text.size()) throw std::runtime_error("is truncated");
    total += sizes.compressed.back();
  }
  if (total > encoded.text.size()) throw std::runtime_error("is truncated");
  const std::string bytes = encoded.behind((3 + blocks) * word).first(total);
  if (bytes.size() < total) throw std::runtime_error("is truncated");
  return storage.compressor == Compressor::zlib ? inflate_blocks(bytes, sizes) : expand_lz4_blocks(bytes, sizes);
}

// The bytes of a binary or appended array.
std::string array_bytes(const DataArray& array, const Storage& storage) {
  const Encoded source = encoded(array, storage);
  if (storage.compressor != Compressor::none) return compressed_bytes(source, storage);
  const std::size_t header = storage.header_64 ? 8 : 4;
  const std::uint64_t size = load_header(source.first(header), storage);
  if (size > source.text.size()) throw std::runtime_error("is truncated");  // base64 is longer than its bytes
  const std::string bytes = source.first(header + size);
  if (bytes.size() < header + size) throw std::runtime_error("is truncated");
  return bytes.substr(header);
}

template <class Value>
Value checked(auto stored) {
  if constexpr (std::is_integral_v<Value> && std::is_signed_v<decltype(stored)>)
    if (stored < 0) throw std::runtime_error("holds a negative number");
  return static_cast<Value>(stored);
}

template <class Value, class Stored>
std::vector<Value> convert(const std::string& bytes, std::endian order) {
  std::vector<Value> values(bytes.size() / sizeof(Stored));
  for (std::size_t i = 0; i < values.size(); ++i)
    values[i] = checked<Value>(load<Stored>(bytes.data() + i * sizeof(Stored), order));
  return values;
}

template <class Value>
std::vector<Value> parse_ascii(std::string_view text) {
  std::vector<Value> values;
  for (std::size_t i = skip_spaces(text, 0); i < text.size(); i = skip_spaces(text, i)) {
    Value value{};
    const char* const end = text.data() + text.size();
    const char* parsed = nullptr;
    bool good = false;
    if constexpr (std::is_floating_point_v<Value>) {
      const auto result = fast_float::from_chars(text.data() + i, end, value);
      parsed = result.ptr;
      good = result.ec == std::errc();
    } else {
      const auto result = std::from_chars(text.data() + i, end, value);
      parsed = result.ptr;
      good = result.ec == std::errc();
    }
    if (!good || (parsed != end && !is_space(*parsed))) {
      const std::string_view rest = text.substr(i, 20);
      throw std::runtime_error("holds what is not a number: " +
                               std::string(rest.substr(0, rest.find_first_of(" \t\r\n"))));
    }
    values.push_back(value);
    i = static_cast<std::size_t>(parsed - text.data());
  }
  return values;
}

template <class Value>
std::vector<Value> read(const DataArray& array, const Storage& storage) {
  const std::string format = array.tag.attribute("format", "ascii");
  if (format == "ascii") return parse_ascii<Value>(array.content);
  if (format != "binary" && format != "appended") throw std::runtime_error("has an unknown format: " + format);
  const std::string bytes = array_bytes(array, storage);
  const std::string type = array.tag.attribute("type");
  const std::endian order = storage.byte_order;
  if (type == "Int8") return convert<Value, std::int8_t>(bytes, order);
  if (type == "UInt8") return convert<Value, std::uint8_t>(bytes, order);
  if (type == "Int16") return convert<Value, std::int16_t>(bytes, order);
  if (type == "UInt16") return convert<Value, std::uint16_t>(bytes, order);
  if (type == "Int32") return convert<Value, std::int32_t>(bytes, order);
  if (type == "UInt32") return convert<Value, std::uint32_t>(bytes, order);
  if (type == "Int64") return convert<Value, std::int64_t>(bytes, order);
  if (type == "UInt64") return convert<Value, std::uint64_t>(bytes, order);
  if constexpr (std::is_floating_point_v<Value>) {
    if (type == "Float32") return convert<Value, float>(bytes, order);
    if (type == "Float64") return convert<Value, double>(bytes, order);
  }
  throw std::runtime_error("has a type that does not suit it: " + type);
}

constexpr std::array<std::pair<char, std::string_view>, 5> entities{
    {{'&', "&amp;"}, {'<', "&lt;"}, {'>', "&gt;"}, {'"', "&quot;"}, {'\'', "&apos;"}}};

}  // namespace

std::string escaped(std::string_view text) {
  std::string result;
  for (const char c : text) {
    const auto* const entity = std::ranges::find(entities, c, &std::pair<char, std::string_view>::first);
    if (entity != entities.end())
      result += entity->second;
    else if (static_cast<unsigned char>(c) < 0x20)
      result += "&#" + std::to_string(c) + ";";
    else
      result += c;
  }
  return result;
}

std::string unescaped(std::string_view text) {
  std::string result;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const std::string_view rest = text.substr(i);
    const auto* const entity =
        std::ranges::find_if(entities, [&](const auto& e) { return rest.starts_with(e.second); });
    unsigned code = 0;
    if (entity != entities.end()) {
      result += entity->first;
      i += entity->second.size() - 1;
    } else if (const auto number = std::from_chars(rest.data() + std::min<std::size_t>(2, rest.size()),
                                                   rest.data() + rest.size(), code);
               rest.starts_with("&#") && number.ec == std::errc() && code < 0x80 &&
               number.ptr != rest.data() + rest.size() && *number.ptr == ';') {
      result += static_cast<char>(code);
      i = static_cast<std::size_t>(number.ptr - text.data());
    } else {
      result += text[i];
    }
  }
  return result;
}

std::string Tag::attribute(const std::string& key, const std::string& otherwise) const {
  const auto it = attributes.find(key);
  return it == attributes.end() ? otherwise : it->second;
}

std::optional<Tag> next_tag(std::string_view text, std::size_t position) {
  std::size_t i = text.find('<', position);
  while (i != std::string_view::npos && (text.substr(i, 2) == "<!" || text.substr(i, 2) == "<?")) {
    const bool comment = text.substr(i, 4) == "<!--";
    const std::size_t end = text.find(comment ? "-->" : ">", i);
    if (end == std::string_view::npos) return {};
    i = text.find('<', end);
  }
  if (i == std::string_view::npos) return {};

  Tag tag;
  for (++i; i < text.size() && !is_space(text[i]) && text[i] != '>' && (text[i] != '/' || tag.name.empty()); ++i)
    tag.name += text[i];
  for (i = skip_spaces(text, i); i < text.size() && text[i] != '>'; i = skip_spaces(text, i)) {
    if (text[i] == '/') {
      ++i;
      continue;
    }
    const std::size_t equals = text.find('=', i);
    if (equals == std::string_view::npos) return {};
    std::string_view key = text.substr(i, equals - i);
    while (!key.empty() && is_space(key.back())) key.remove_suffix(1);
    const std::size_t quote = skip_spaces(text, equals + 1);
    if (quote >= text.size() || (text[quote] != '"' && text[quote] != '\'')) return {};
    const std::size_t close = text.find(text[quote], quote + 1);
    if (close == std::string_view::npos) return {};
    tag.attributes[std::string(key)] = text.substr(quote + 1, close - quote - 1);
    i = close + 1;
  }
  if (i >= text.size()) return {};
  tag.end = i + 1;
  return tag;
}

std::vector<double> read_reals(const DataArray& array, const Storage& storage) {
  return read<double>(array, storage);
}

std::vector<std::uint64_t> read_integers(const DataArray& array, const Storage& storage) {
  return read<std::uint64_t>(array, storage);
}

}  // namespace scan2fea::vtk_xml
