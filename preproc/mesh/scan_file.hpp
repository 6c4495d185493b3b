// A scan's file, read once for all that is asked of it.
#pragma once

#include "preproc/mesh/input_file.hpp"
#include "preproc/mesh/read_cloud.hpp"

namespace scan2fea {

// The file of a scan that is gone through several times, and may be larger than memory.
class ScanFile {
 public:
  explicit ScanFile(const std::filesystem::path& path) : file_(path) {}

  // Of what is in it, where it is compressed.
  std::size_t bytes() const { return file_.bytes().size(); }
  // Whether its format has no faces.
  bool is_of_points() const;

  PointCloud read_points() const;  // as read_cloud
  NamedScan read() const;          // as read_named_scan
  // Hands over the triangles some ten thousands at a time, and forgets them; returns what else there is, names and the
  // unit. Beside a block, memory holds the vertices of formats that number them (24 bytes each). Precondition: the
  // format has faces.
  NamedSurface read_in_blocks(const TakeBlock& take) const;

 private:
  InputFile file_;
};

}  // namespace scan2fea
