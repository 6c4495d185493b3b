// Files within a ZIP.
#pragma once

#include "preproc/mesh/input_file.hpp"

#include <string>
#include <string_view>
#include <vector>

namespace scan2fea {

struct ZipEntry {
  std::string name;
  std::string_view bytes;  // as they lie in the file
  bool deflated = false;
};

// Those of the directory at the end of the file; of archives of one part, stored or deflated. Throws InvalidInput where
// that is broken.
std::vector<ZipEntry> zip_entries(const InputFile& file);

// What was put in. Throws InvalidInput where it is broken.
std::string content_of(const ZipEntry& entry, const InputFile& file);

}  // namespace scan2fea
