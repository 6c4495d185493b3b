// A folder of our own that goes when this object goes, with all that is in it.
#pragma once

#include <filesystem>
#include <string>

namespace scan2fea {

// In TMPDIR, or where the system keeps such files; readable for the user alone. A process that is killed leaves it.
class TemporaryFolder {
 public:
  TemporaryFolder();  // throws IoError where none can be made
  ~TemporaryFolder();
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;

  const std::filesystem::path& path() const { return path_; }
  std::filesystem::path operator/(const std::string& name) const { return path_ / name; }

 private:
  std::filesystem::path path_;
};

}  // namespace scan2fea
