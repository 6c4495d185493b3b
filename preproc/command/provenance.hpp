// Where a result comes from: what a reader needs to make it again.
#pragma once

#include "quality/report.hpp"

#include <filesystem>
#include <string>
#include <vector>

namespace scan2fea::command {

struct ReadFile {
  std::string role;  // "scan", "reference", "configuration"
  std::filesystem::path path;
};

// {name, version, libraries {name: version}}
Json program_json();

// As the shell gave them to this process.
std::vector<std::string> arguments_of_process();

// {folder, arguments}
Json command_json(const std::vector<std::string>& arguments);

// [{role, file, bytes, sha256}]; null where a file is no longer to be read, a pipe say.
Json inputs_json(const std::vector<ReadFile>& files);

// Of a file that was written, whether it is in place or not.
struct WrittenFile {
  std::string role;                // "mesh", "deck", "feature edges"
  std::filesystem::path path;      // as the user knows it; "-" for stdout
  std::filesystem::path readable;  // by which this process finds it
};

// The same, of what will be in place if no gate fails.
Json outputs_json(const std::vector<WrittenFile>& files);

}  // namespace scan2fea::command
