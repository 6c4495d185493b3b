// What the command writes: checked before any work is done, and put in place all at once.
#pragma once

#include "preproc/command/flags.hpp"
#include "preproc/mesh/output_file.hpp"

#include <nlohmann/json.hpp>

#include <filesystem>
#include <string>
#include <vector>

namespace scan2fea::command {

struct OutputPath {
  std::filesystem::path file;
  bool makes_folder = false;  // where that is missing
};

// Files of a mesh, those of a folder of their own with that folder.
void add_outputs(const std::vector<std::filesystem::path>& files, std::vector<OutputPath>& outputs);

// That it reads whatever the sub-command.
std::vector<std::filesystem::path> inputs_of(const CommonFlags& flags);

// Of --json and --junit, unless that is stdout, and --report. Throws WrongUsage where both are. Throws IoError where
// nothing can print the PDF that is asked for.
std::vector<OutputPath> report_outputs(const CommonFlags& flags);

// Throws IoError where an output exists and `force` is off, is no regular file, or cannot be made in its folder; and
// WrongUsage where it is an input, or the same file as another output.
void require_writable(const std::vector<OutputPath>& outputs, const std::vector<std::filesystem::path>& inputs,
                      bool force);

// To stdout, at once, where the file is "-".
void add_text(const std::string& text, const std::filesystem::path& file, OutputFiles& outputs);
void add_json(const nlohmann::json& report, const std::filesystem::path& file, OutputFiles& outputs);
// Into the folder that --report names, which is made where it is missing.
void add_report(const nlohmann::json& report, const std::string& page, const CommonFlags& flags, OutputFiles& outputs);

}  // namespace scan2fea::command
