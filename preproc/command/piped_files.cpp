#include "preproc/command/piped_files.hpp"

#include "export/formats.hpp"
#include "preproc/command/option_text.hpp"
#include "preproc/mesh/error.hpp"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <fcntl.h>
#include <map>
#include <mutex>
#include <string_view>
#include <unistd.h>
#include <vector>

namespace scan2fea::command {
namespace {

namespace fs = std::filesystem;

constexpr const char* input_name = "standard-input";

// There is one standard input of a process, and it can be read once.
std::map<std::string, std::unique_ptr<OutputFile>>& kept_inputs() {
  static std::map<std::string, std::unique_ptr<OutputFile>> kept;
  return kept;
}

std::string as_extension(const std::string& format) {
  return format.starts_with(".") ? format : "." + format;
}

[[noreturn]] void cannot_read(const fs::path& input) {
  throw InvalidInput(
      {.what = "cannot be read", .where = shown_name(input), .value = std::strerror(errno), .limit = {}, .advice = {}});
}

void copy_into(std::ostream& out, const fs::path& input) {
  const int descriptor = is_pipe(input) ? STDIN_FILENO : ::open(input.c_str(), O_RDONLY | O_CLOEXEC);
  if (descriptor < 0) cannot_read(input);
  std::vector<char> block(1 << 20);
  ssize_t got = 0;
  while ((got = ::read(descriptor, block.data(), block.size())) > 0 || (got < 0 && errno == EINTR))
    if (got > 0) out.write(block.data(), got);
  if (got < 0) cannot_read(input);
  if (descriptor != STDIN_FILENO) ::close(descriptor);
}

}  // namespace

void add_from_flag(CLI::App& command, std::optional<std::string>& from) {
  const OptionGroup group(command, "Files");
  command.add_option("--from", from, "Format of the input, as its extension (stl), where no name tells it; - is stdin")
      ->type_name("FORMAT");
}

void add_to_flag(CLI::App& command, std::optional<std::string>& to) {
  const OptionGroup group(command, "Files");
  command.add_option("--to", to, "Format of the output, as its extension (inp), where it is - for stdout")
      ->type_name("FORMAT");
}

bool is_pipe(const fs::path& file) {
  return file == "-";
}

fs::path file_to_read(const fs::path& input, const std::optional<std::string>& from) {
  static std::mutex of_kept_inputs;
  const std::lock_guard lock(of_kept_inputs);
  std::unique_ptr<OutputFile>& kept = kept_inputs()[input.string()];
  if (kept) return kept->temporary_path();
  if (!from) {
    kept_inputs().erase(input.string());
    if (!is_pipe(input)) return input;
    throw WrongUsage({.what = "the format of what comes through a pipe is not known",
                      .where = "standard input",
                      .value = {},
                      .limit = {},
                      .advice = "--from stl, or another extension"});
  }
  kept = std::make_unique<OutputFile>(fs::temp_directory_path() / (input_name + as_extension(*from)));
  copy_into(kept->stream(), input);
  kept->finish();
  return kept->temporary_path();
}

std::string with_names_of_pipes(std::string message) {
  for (const auto& [input, kept] : kept_inputs()) {
    if (!kept) continue;
    const std::string name = kept->temporary_path().string();
    for (std::size_t at = 0; (at = message.find(name, at)) != std::string::npos;)
      message.replace(at, name.size(), shown_name(input));
  }
  return message;
}

std::string shown_name(const fs::path& input) {
  return is_pipe(input) ? "standard input" : input.string();
}

std::string name_of_input(const fs::path& input) {
  return is_pipe(input) ? input_name : input.filename().string();
}

PipedOutput::PipedOutput(const fs::path& output, const std::optional<std::string>& to) : file_(output) {
  const bool is_piped = scan2fea::command::is_pipe(output);
  if (is_piped != to.has_value())
    throw WrongUsage({.what = is_piped ? "the format of what goes into a pipe is not known" : "--to is for -o - alone",
                      .where = is_piped ? "standard output" : output.string(),
                      .value = {},
                      .limit = {},
                      .advice = is_piped ? "--to inp, or another extension" : "the extension of -o tells the format"});
  if (!is_piped) return;
  const std::string extension = as_extension(*to);
  if (files_of_volume("x" + extension, 1).size() > 1)
    throw WrongUsage({.what = "a format of several files cannot go into a pipe",
                      .where = "--to",
                      .value = *to,
                      .limit = {},
                      .advice = "-o FILE" + extension});
  kept_ = std::make_unique<OutputFile>(fs::temp_directory_path() / ("standard-output" + extension));
  file_ = kept_->temporary_path();
}

void PipedOutput::send() const {
  if (!kept_) return;
  std::ifstream in(file_, std::ios::binary);
  std::vector<char> block(1 << 20);
  while (in.read(block.data(), static_cast<std::streamsize>(block.size())) || in.gcount() > 0)
    write_to_stdout({block.data(), static_cast<std::size_t>(in.gcount())});
}

void write_to_stdout(std::string_view text) {
  while (!text.empty()) {
    const ssize_t written = ::write(STDOUT_FILENO, text.data(), text.size());
    if (written > 0) {
      text.remove_prefix(static_cast<std::size_t>(written));
    } else if (errno == EPIPE) {
      return;
    } else if (errno != EINTR) {
      throw IoError(
          {.what = "cannot write to stdout", .where = {}, .value = std::strerror(errno), .limit = {}, .advice = {}});
    }
  }
}

}  // namespace scan2fea::command
