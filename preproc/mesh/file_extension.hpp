// The extension by which a file's format is told.
#pragma once

#include <filesystem>
#include <string>

namespace scan2fea {

// With its dot and in lower case (".stl" of "PART.STL"), empty where there is none.
std::string lower_case_extension(const std::filesystem::path& file);

// Of what is in the file: that before a last `.gz`, since input files may be compressed (see InputFile).
std::string extension_of_content(const std::filesystem::path& file);

}  // namespace scan2fea
