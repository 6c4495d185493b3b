#include "preproc/command/output_files.hpp"

#include "preproc/command/piped_files.hpp"
#include "preproc/command/print_pdf.hpp"
#include "preproc/mesh/error.hpp"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <set>
#include <sys/stat.h>
#include <unistd.h>

namespace scan2fea::command {
namespace {

namespace fs = std::filesystem;

[[noreturn]] void fail(std::string what, const fs::path& where, std::string value, std::string advice) {
  throw IoError({std::move(what), where.string(), std::move(value), {}, std::move(advice)});
}

// The same for all names of one file or folder, links too.
std::string identity_of(const fs::path& file) {
  struct stat status {};
  if (::stat(file.c_str(), &status) == 0) return std::to_string(status.st_dev) + ":" + std::to_string(status.st_ino);
  std::error_code error;
  const fs::path canonical = fs::weakly_canonical(file, error);
  return (error ? file : canonical).string();
}

// The folder that a new file or folder of this name would be made in, or the one that a folder above it would.
fs::path existing_folder_above(const fs::path& file) {
  std::error_code error;
  fs::path folder = fs::absolute(file, error).parent_path();
  while (!fs::exists(folder, error) && folder.has_relative_path()) folder = folder.parent_path();
  return folder;
}

void require_possible(const OutputPath& output, bool force) {
  const fs::path& file = output.file;
  std::error_code error;
  const auto status = fs::status(file, error);
  if (fs::is_directory(status)) fail("the output is a folder", file, {}, "a file in it");
  if (fs::exists(status) && !fs::is_regular_file(status))
    fail("the output is not a regular file", file, {}, "another name");
  if (fs::exists(status) && !force) fail("the output exists already", file, {}, "--force, or another name");
  const fs::path parent = file.has_parent_path() ? file.parent_path() : fs::path(".");
  if (!output.makes_folder && !fs::is_directory(parent, error))
    fail("the output's folder does not exist", parent, {}, "mkdir -p");
  const fs::path folder = existing_folder_above(fs::exists(status) ? fs::canonical(file, error) : file);
  if (!fs::is_directory(folder, error)) fail("the output's folder is a file", folder, {}, "another folder");
  if (::access(folder.c_str(), W_OK | X_OK) != 0)
    fail("the output's folder cannot be written", folder, std::strerror(errno), "another folder");
}

std::string text_of(const nlohmann::json& report) {
  // Names of files are any bytes.
  return report.dump(2, ' ', false, nlohmann::json::error_handler_t::replace) + "\n";
}

constexpr const char *report_json = "report.json", *report_page = "report.html", *report_pdf = "report.pdf";

}  // namespace

void add_outputs(const std::vector<fs::path>& files, std::vector<OutputPath>& outputs) {
  for (const fs::path& file : files) outputs.push_back({file, file.parent_path() != files.back().parent_path()});
}

std::vector<fs::path> inputs_of(const CommonFlags& flags) {
  std::vector<fs::path> inputs{flags.input};
  if (flags.config) inputs.push_back(*flags.config);
  return inputs;
}

std::vector<OutputPath> report_outputs(const CommonFlags& flags) {
  std::vector<OutputPath> outputs;
  if (flags.json && *flags.json != "-") outputs.push_back({*flags.json});
  if (flags.junit && *flags.junit != "-") outputs.push_back({*flags.junit});
  if (flags.json == "-" && flags.junit == "-")
    throw WrongUsage({.what = "two outputs are the same file",
                      .where = "--json and --junit",
                      .value = "-",
                      .limit = {},
                      .advice = "a file for one of them"});
  if (flags.report)
    // Without a new PDF, too: an old one would be of another mesh, and goes.
    for (const char* name : {report_json, report_page, report_pdf}) outputs.push_back({*flags.report / name, true});
  if (flags.report && flags.report_pdf) require_chromium();
  return outputs;
}

void require_writable(const std::vector<OutputPath>& outputs, const std::vector<fs::path>& inputs, bool force) {
  std::set<std::string> of_inputs, files, folders;
  for (const fs::path& input : inputs) of_inputs.insert(identity_of(input));
  for (const OutputPath& output : outputs) {
    const std::string file = identity_of(output.file);
    const bool is_input = of_inputs.contains(file);
    bool is_twice = folders.contains(file) || !files.insert(file).second;
    if (output.makes_folder) {
      const std::string folder = identity_of(output.file.parent_path());
      is_twice = is_twice || files.contains(folder);
      folders.insert(folder);
    }
    if (is_input || is_twice)
      throw WrongUsage({.what = is_input ? "the output is an input" : "two outputs are the same file",
                        .where = output.file.string(),
                        .value = {},
                        .limit = {},
                        .advice = "another name"});
  }
  for (const OutputPath& output : outputs) require_possible(output, force);
}

void add_text(const std::string& text, const fs::path& file, OutputFiles& outputs) {
  if (file == "-")
    write_to_stdout(text);
  else
    outputs.add(file, text);
}

void add_json(const nlohmann::json& report, const fs::path& file, OutputFiles& outputs) {
  add_text(text_of(report), file, outputs);
}

void add_report(const nlohmann::json& report, const std::string& page, const CommonFlags& flags, OutputFiles& outputs) {
  const fs::path& folder = *flags.report;
  outputs.add(folder / report_json, text_of(report), OutputFile::Folder::is_made);
  outputs.add(folder / report_page, page, OutputFile::Folder::is_made);
  if (flags.report_pdf)
    outputs.add(folder / report_pdf, printed_as_pdf(page), OutputFile::Folder::is_made);
  else
    outputs.remove(folder / report_pdf);
}

}  // namespace scan2fea::command
