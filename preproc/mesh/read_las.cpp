#include "preproc/mesh/byte_order.hpp"
#include "preproc/mesh/cloud_formats.hpp"
#include "preproc/mesh/truncated.hpp"

#include <array>
#include <cmath>
#include <limits>
#include <string>

namespace scan2fea {
namespace {

// Offsets of the public header block, in bytes, and the shortest one (LAS 1.0).
constexpr std::size_t minor_version_at = 25, points_offset_at = 96, format_at = 104, record_length_at = 105,
                      count_at = 107, scale_at = 131, offset_at = 155, long_count_at = 247;
constexpr std::size_t shortest_header = 227, header_with_long_count = 375;
// Of the point formats 0 to 10.
constexpr std::array<std::uint16_t, 11> shortest_record{20, 28, 26, 34, 57, 63, 30, 36, 38, 59, 67};

class LasReader {
 public:
  explicit LasReader(const InputFile& file) : file_(file), bytes_(file.bytes()) {}

  PointCloud run() {
    if (bytes_.size() < shortest_header) file_.fail("the file ends inside its header", {}, {}, truncated_advice);
    read_header();
    PointCloud cloud;
    cloud.points.reserve(count_);
    for (std::uint64_t i = 0; i < count_; ++i) {
      const char* record = bytes_.data() + first_ + i * length_;
      if (is_left_out(record)) {
        ++cloud.left_out;
        continue;
      }
      Vec3 p;
      for (std::size_t k = 0; k < 3; ++k)
        p[static_cast<Eigen::Index>(k)] =
            scale_[k] * load<std::int32_t>(record + 4 * k, std::endian::little) + offset_[k];
      if (!p.allFinite()) file_.fail_at_byte(record, "not a finite coordinate");
      cloud.points.push_back(p);
    }
    return cloud;
  }

 private:
  template <class T>
  T at(std::size_t byte) const {
    return load<T>(bytes_.data() + byte, std::endian::little);
  }

  void read_header() {
    const auto format = at<std::uint8_t>(format_at);
    if (format & 0xc0)
      file_.fail_at_byte(bytes_.data() + format_at, "this is compressed LAS (LAZ), which is not read", {}, {},
                         "laszip -i FILE.laz -o FILE.las, or an export as LAS");
    if (format >= shortest_record.size())
      file_.fail_at_byte(bytes_.data() + format_at, "not a point format of LAS", std::to_string(format), "0 to 10");
    format_ = format;
    length_ = at<std::uint16_t>(record_length_at);
    if (length_ < shortest_record[format])
      file_.fail_at_byte(bytes_.data() + record_length_at, "the point records are shorter than their format",
                         std::to_string(length_), std::to_string(shortest_record[format]));
    first_ = at<std::uint32_t>(points_offset_at);
    count_ = at<std::uint32_t>(count_at);
    if (at<std::uint8_t>(minor_version_at) >= 4 && bytes_.size() >= header_with_long_count)
      count_ = std::max(count_, at<std::uint64_t>(long_count_at));
    const std::uint64_t most = first_ < bytes_.size() ? (bytes_.size() - first_) / length_ : 0;
    if (count_ > most || count_ > std::numeric_limits<std::uint32_t>::max())
      file_.fail_at_byte(bytes_.data() + count_at, "the header promises more points than the file holds",
                         std::to_string(count_), std::to_string(most), truncated_advice);
    for (std::size_t k = 0; k < 3; ++k) {
      scale_[k] = at<double>(scale_at + 8 * k);
      offset_[k] = at<double>(offset_at + 8 * k);
      if (!std::isfinite(scale_[k]) || !std::isfinite(offset_[k]) || scale_[k] == 0)
        file_.fail_at_byte(bytes_.data() + scale_at, "the scale and offset of coordinates are no numbers");
    }
  }

  // Formats 6 and on have a byte of flags before that of the class; before, the flags are the class's upper bits.
  bool is_left_out(const char* record) const {
    constexpr unsigned low_noise = 7, high_noise = 18;
    const auto byte = [&](std::size_t i) { return static_cast<unsigned>(static_cast<unsigned char>(record[i])); };
    const bool is_withheld = format_ >= 6 ? (byte(15) & 4U) != 0 : (byte(15) & 0x80U) != 0;
    const unsigned kind = format_ >= 6 ? byte(16) : byte(15) & 0x1fU;
    return is_withheld || kind == low_noise || (format_ >= 6 && kind == high_noise);
  }

  const InputFile& file_;
  std::string_view bytes_;
  std::uint8_t format_ = 0;
  std::uint64_t length_ = 0, first_ = 0, count_ = 0;
  std::array<double, 3> scale_{}, offset_{};
};

}  // namespace

bool is_las(const InputFile& file) {
  return file.bytes().starts_with("LASF");
}

PointCloud read_las(const InputFile& file) {
  if (!is_las(file)) file.fail("a LAS file begins with \"LASF\"");
  return LasReader(file).run();
}

}  // namespace scan2fea
