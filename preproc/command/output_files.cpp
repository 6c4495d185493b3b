#include "preproc/command/output_files.hpp"

#include "preproc/mesh/error.hpp"
#include "preproc/mesh/output_file.hpp"

#include <iostream>

namespace scan2fea::command {
namespace {

void write_text(const std::string& text, const std::filesystem::path& file) {
  OutputFile out(file);
  out.stream() << text;
  out.commit();
}

}  // namespace

void require_writable(const std::filesystem::path& file, bool force) {
  std::error_code error;
  const auto status = std::filesystem::status(file, error);
  if (std::filesystem::is_directory(status))
    throw IoError(
        {.what = "the output is a folder", .where = file.string(), .value = {}, .limit = {}, .advice = "a file in it"});
  if (std::filesystem::exists(status) && !force)
    throw IoError({.what = "the output exists already",
                   .where = file.string(),
                   .value = {},
                   .limit = {},
                   .advice = "--force, or another name"});
  const auto folder = file.has_parent_path() ? file.parent_path() : std::filesystem::path(".");
  if (!std::filesystem::is_directory(folder, error))
    throw IoError({.what = "the output's folder does not exist",
                   .where = folder.string(),
                   .value = {},
                   .limit = {},
                   .advice = "mkdir -p"});
}

void write_json(const nlohmann::json& report, const std::filesystem::path& file) {
  const std::string text = report.dump(2) + "\n";
  if (file == "-") {
    std::cout << text << std::flush;
    if (!std::cout)
      throw IoError({.what = "cannot write to stdout", .where = {}, .value = {}, .limit = {}, .advice = {}});
  } else {
    write_text(text, file);
  }
}

void write_report(const nlohmann::json& report, const std::string& text, const std::filesystem::path& folder) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error)
    throw IoError({.what = "cannot make the report's folder",
                   .where = folder.string(),
                   .value = error.message(),
                   .limit = {},
                   .advice = "another folder"});
  write_json(report, folder / "report.json");
  write_text(text, folder / "report.txt");
}

}  // namespace scan2fea::command
