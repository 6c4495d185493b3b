// `-` for standard input and output. What comes through a pipe is kept in a temporary file, since readers look at it
// more than once; what goes into one is written whole first, so that nothing is sent of what was not made.
#pragma once

#include "preproc/mesh/output_file.hpp"

#include <CLI/App.hpp>

#include <filesystem>
#include <memory>
#include <optional>
#include <string>

namespace scan2fea::command {

// Formats by their extensions, "stl", for what has no name that tells it.
struct PipeFlags {
  std::optional<std::string> from, to;
};

void add_from_flag(CLI::App& command, std::optional<std::string>& from);
void add_to_flag(CLI::App& command, std::optional<std::string>& to);

bool is_pipe(const std::filesystem::path& file);  // "-"

// The file itself or, of `-` and wherever a format is given, a temporary one with what is in it, under a name that
// tells the format. Throws WrongUsage for `-` without a format, InvalidInput where it cannot be read.
std::filesystem::path file_to_read(const std::filesystem::path& input, const std::optional<std::string>& from = {});

// "standard input" for the name of the temporary file.
std::string with_names_of_pipes(std::string message);
std::string shown_name(const std::filesystem::path& input);     // "standard input" of "-"
std::string name_of_input(const std::filesystem::path& input);  // without folders, for what is written into files

class PipedOutput {
 public:
  // Throws WrongUsage for `-` without a format, or a format of several files.
  PipedOutput(const std::filesystem::path& output, const std::optional<std::string>& to);
  bool is_pipe() const { return kept_ != nullptr; }
  const std::filesystem::path& file() const { return file_; }  // what is to be written
  void send() const;                                           // to stdout, if it is a pipe; throws IoError

 private:
  std::filesystem::path file_;
  std::unique_ptr<OutputFile> kept_;
};

// To stdout. Throws IoError where not all could be written, but not where the reader has closed the pipe: that is how
// `head` says that it has enough.
void write_to_stdout(std::string_view text);

}  // namespace scan2fea::command
