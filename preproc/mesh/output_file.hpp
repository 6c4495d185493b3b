// Output that appears whole or not at all.
#pragma once

#include <filesystem>
#include <fstream>
#include <list>
#include <string>
#include <vector>

namespace scan2fea {

// Writes into a file without a name and gives it that of the target on `commit`, so that no reader sees a partial file,
// and a failure leaves an existing target as it was and nothing beside it. So does the end of the process, however it
// comes; but where the file system knows no files without names, or `temporary_path` was asked for, only if the
// destructor runs or `remove_unfinished_outputs` is called.
class OutputFile {
 public:
  enum class Folder {
    exists,
    is_made,  // by `commit`, where it is missing, with all above it
  };

  // Throws IoError if the folder does not exist (or, if it may be made, the nearest one above it) or cannot be written.
  explicit OutputFile(std::filesystem::path target, Folder folder = Folder::exists);
  ~OutputFile();
  OutputFile(const OutputFile&) = delete;
  OutputFile& operator=(const OutputFile&) = delete;

  std::ofstream& stream() { return stream_; }
  // For writers that want a path of their own (the Gmsh SDK): it has the target's extension, in lower case.
  const std::filesystem::path& temporary_path();

  const std::filesystem::path& name() const { return name_; }  // as it was given
  // By which this process can read what was written, after `finish`.
  std::filesystem::path readable_path() const;

  // Flushes and checks that all was written (IoError on a full disk); done by `commit`, too.
  void finish();
  // The target is the new file.
  void commit();

 private:
  void give_name();

  std::filesystem::path name_;
  std::filesystem::path target_;  // that it links to, or itself
  std::filesystem::path folder_;  // in which it lies until then: the target's, or one above
  int descriptor_;
  std::filesystem::path temporary_;  // empty while the file has no name
  std::ofstream stream_;
};

// Files that are put in place together, all of them written before the first is: by this `commit` or, where they belong
// to others, by that of those. So a mesh of several files, or a mesh with its report, is there whole or not at all.
class OutputFiles {
 public:
  explicit OutputFiles(OutputFiles* owner = nullptr) : owner_(owner) {}

  // Throws IoError as OutputFile does. The reference holds as long as these files, or those that they belong to.
  OutputFile& open(const std::filesystem::path& target, OutputFile::Folder folder = OutputFile::Folder::exists);
  void add(const std::filesystem::path& target, const std::string& text,
           OutputFile::Folder folder = OutputFile::Folder::exists);
  // Takes away what an earlier output left there, when these are put in place.
  void remove(const std::filesystem::path& target) { obsolete_.push_back(target); }
  // Throws IoError where one is not whole, before the first is in place.
  void commit();

  auto begin() const { return files_.begin(); }
  auto end() const { return files_.end(); }

 private:
  OutputFiles* owner_;
  std::list<OutputFile> files_;
  std::vector<std::filesystem::path> obsolete_;
};

// For signal handlers that end the process: takes away what has a name already and was not committed. Not while another
// thread makes or commits outputs.
void remove_unfinished_outputs() noexcept;

}  // namespace scan2fea
