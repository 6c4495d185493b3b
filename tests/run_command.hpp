// Runs the built command as a user's script would.
#pragma once

#include <filesystem>
#include <string>

namespace scan2fea::testing {

struct CommandResult {
  int exit_code;
  std::string standard_output;
  std::string standard_error;
};

// `arguments` is what a shell would be given after the command's name.
CommandResult run_command(const std::string& arguments);

// A folder that is gone after the test.
class TemporaryFolder {
 public:
  TemporaryFolder();
  ~TemporaryFolder();
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;
  std::filesystem::path operator/(const std::string& name) const { return path_ / name; }
  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

std::string file_content(const std::filesystem::path& file);
void write_file(const std::filesystem::path& file, const std::string& content);

}  // namespace scan2fea::testing
