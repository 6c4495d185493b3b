// The part of VTK's XML format that its reader needs: tags, and data arrays in all encodings, also compressed ones.
#pragma once

#include <bit>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace scan2fea::vtk_xml {

struct Tag {
  std::string name;                               // "DataArray", "/Points"
  std::map<std::string, std::string> attributes;  // entities (&lt;) stay as they are: VTK's own attributes need none
  std::size_t end = 0;                            // the position behind its '>'

  std::string attribute(const std::string& key, const std::string& otherwise = {}) const;
};

// For values of attributes that are any text, as names of files.
std::string escaped(std::string_view text);
std::string unescaped(std::string_view text);

// The first tag at or behind `position`; comments and declarations are passed over. Nothing at the end of the text or
// where the rest is not XML.
std::optional<Tag> next_tag(std::string_view text, std::size_t position);

enum class Compressor { none, zlib, lz4 };

// How the arrays of a file are stored, from its VTKFile and AppendedData tags.
struct Storage {
  std::endian byte_order = std::endian::little;
  bool header_64 = false;
  Compressor compressor = Compressor::none;
  bool appended_base64 = false;
  std::string_view appended;  // behind the underscore
};

struct DataArray {
  Tag tag;
  std::string_view content;  // up to the closing tag, for ascii and binary
};

// Both throw std::runtime_error that says what is wrong with the array: truncated, unknown type, not a number.
std::vector<double> read_reals(const DataArray& array, const Storage& storage);
std::vector<std::uint64_t> read_integers(const DataArray& array, const Storage& storage);

}  // namespace scan2fea::vtk_xml
