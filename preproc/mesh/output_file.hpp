// Output that appears whole or not at all.
#pragma once

#include <filesystem>
#include <fstream>

namespace scan2fea {

// Writes beside the target under a temporary name and renames on `commit`, so that no reader sees a partial file and a
// failure leaves an existing target as it was. The destructor removes what was not committed.
class OutputFile {
 public:
  // Throws IoError if the folder does not exist or cannot be written.
  explicit OutputFile(std::filesystem::path target);
  ~OutputFile();
  OutputFile(const OutputFile&) = delete;
  OutputFile& operator=(const OutputFile&) = delete;

  std::ofstream& stream() { return stream_; }
  // For writers that want a path of their own (the Gmsh SDK); it has the target's extension.
  const std::filesystem::path& temporary_path() const { return temporary_; }

  // Flushes, checks that all was written (IoError on a full disk), and renames.
  void commit();

 private:
  std::filesystem::path target_;
  std::filesystem::path temporary_;
  std::ofstream stream_;
};

}  // namespace scan2fea
