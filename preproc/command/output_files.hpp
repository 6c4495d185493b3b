// What the command writes besides its mesh, and what it refuses to overwrite.
#pragma once

#include <nlohmann/json.hpp>

#include <filesystem>
#include <string>

namespace scan2fea::command {

// Throws IoError, before any work is done, where `file` exists and `force` is off, is a folder, or lies in a folder
// that does not exist.
void require_writable(const std::filesystem::path& file, bool force);

// To the file, or to stdout where it is "-". Existing JSON is replaced: it is a report, not somebody's work.
void write_json(const nlohmann::json& report, const std::filesystem::path& file);

// DIR/report.json and DIR/report.txt; the folder is made where it is missing.
void write_report(const nlohmann::json& report, const std::string& text, const std::filesystem::path& folder);

}  // namespace scan2fea::command
