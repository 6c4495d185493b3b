#include "preproc/mesh/cloud_formats.hpp"
#include "preproc/mesh/text_scanner.hpp"
#include "preproc/mesh/truncated.hpp"

namespace scan2fea {
namespace {

constexpr std::size_t shortest_ptx_row = std::string_view("0 0 0 0\n").size();

Vec3 row(TextScanner& scanner, double* fourth = nullptr) {
  if (!scanner.skip_space()) scanner.fail(scanner.position(), "the file ends inside the head of a scan");
  const Vec3 value = scanner.point();
  if (fourth != nullptr) *fourth = scanner.number();
  scanner.skip_line();
  return value;
}

std::int64_t count(TextScanner& scanner) {
  if (!scanner.skip_space()) scanner.fail(scanner.position(), "the file ends before the size of a scan");
  const std::int64_t value = scanner.integer();
  scanner.skip_line();
  return value;
}

// A grid of points behind its head: its size, the scanner's place and axes, and a matrix whose last row is the shift.
void read_scan(TextScanner& scanner, PointCloud& cloud) {
  const char* start = scanner.position();
  const std::int64_t columns = count(scanner), rows = count(scanner);
  const auto most = static_cast<std::int64_t>((scanner.bytes_left() + 1) / shortest_ptx_row);
  if (columns < 0 || rows < 0 || (columns > 0 && rows > most / columns))
    scanner.fail(start, "the header promises more points than the file can hold",
                 std::to_string(columns) + " x " + std::to_string(rows), std::to_string(most), truncated_advice);
  row(scanner);  // the scanner's place, which the matrix repeats
  for (int axis = 0; axis < 3; ++axis) row(scanner);
  Eigen::Matrix3d turn;
  double scale = 1;
  for (int axis = 0; axis < 3; ++axis) turn.row(axis) = row(scanner, &scale);
  const Vec3 shift = row(scanner, &scale);
  for (std::int64_t i = 0; i < columns * rows; ++i, scanner.skip_line()) {
    if (!scanner.skip_space())
      scanner.fail(scanner.position(), "points are missing that the header promises", std::to_string(i),
                   std::to_string(columns * rows), truncated_advice);
    const Vec3 p = scanner.point();
    if (p.isZero(0)) {
      ++cloud.left_out;
      continue;
    }
    const Vec3 placed = turn.transpose() * p + shift;
    if (!placed.allFinite()) scanner.fail(scanner.position(), "a point that is moved out of all bounds");
    cloud.points.push_back(placed);
    cloud.scanners.push_back(shift);
  }
}

}  // namespace

PointCloud read_ptx(const InputFile& file) {
  PointCloud cloud;
  TextScanner scanner(file);
  while (scanner.skip_space()) read_scan(scanner, cloud);
  return cloud;
}

}  // namespace scan2fea
