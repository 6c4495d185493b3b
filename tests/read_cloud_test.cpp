#include "preproc/mesh/read_cloud.hpp"

#include "preproc/mesh/byte_order.hpp"
#include "preproc/mesh/error.hpp"
#include "preproc/mesh/lzf.hpp"
#include "preproc/mesh/write_surface.hpp"
#include "tests/analytic_meshes.hpp"
#include "tests/cloud_files.hpp"
#include "tests/error_from.hpp"
#include "tests/temporary_folder.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <limits>
#include <string>

namespace scan2fea {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

class ReadCloud : public testing::Test {
 protected:
  PointCloud read(const std::string& name, std::string_view content) const {
    return read_cloud(write_text(folder_ / name, content));
  }
  ErrorParts failure(const std::string& name, std::string_view content) const {
    return error_from<InvalidInput>([&] { read(name, content); }).parts();
  }

  const std::vector<Vec3> corners_{{0, 0, 0}, {1.5, 0, 0}, {0, -2, 0}, {0, 0, 3e-3}};
  TemporaryFolder folder_;
};

using PointRows = ReadCloud;

TEST_F(PointRows, AllSeparatorsAndLineEnds) {
  for (const char* text : {"0 0 0\n1.5 0 0\n0 -2 0\n0 0 3e-3\n", "0\t0\t0\r\n1.5\t0\t0\r\n0\t-2\t0\r\n0\t0\t.003",
                           "0,0,0\n1.5,0,0\n0,-2,0\n0,0,0.003\n", "0, 0, 0\n+1.5, 0, 0\n0, -2, 0\n0, 0, 3E-3\n",
                           "0;0;0;\n1.5;0;0;\n0;-2;0;\n0;0;0.003;\n", "  0 0 0  \n\n1.5 0 0\n0 -2.0 0\n0 0 3e-3\n\n",
                           "0 0 0\r1.5 0 0\r0 -2 0\r0 0 3e-3\r",
                           "\xef\xbb\xbf"
                           "0 0 0\n1.5 0 0\n0 -2 0\n0 0 3e-3"}) {
    const PointCloud cloud = read("part.xyz", text);
    EXPECT_EQ(cloud.points, corners_) << text;
    EXPECT_THAT(cloud.normals, IsEmpty());
  }
}

TEST_F(PointRows, ScannersOfColumnsAndComments) {
  const PointCloud named = read("part.csv",
                                "x,y,z,Scanner X,Scanner_Y,scanner_z\n0,0,0,9,1,2\n1.5,0,0,9,1,2\n0,-2,0,8,1,2\n"
                                "0,0,0.003,,1,2\n");
  EXPECT_EQ(named.points, corners_);
  ASSERT_EQ(named.scanners.size(), 4U);
  EXPECT_EQ(named.scanners[2], Vec3(8, 1, 2));
  EXPECT_FALSE(named.scanners[3].allFinite());
  const PointCloud told =
      read("part.xyz", "0 0 0\n# scanner 1 2 3\n1.5 0 0\n# Scanner\n0 -2 0\n# scanner: 4, 5, 6\n0 0 3e-3\n");
  ASSERT_EQ(told.scanners.size(), 4U);
  EXPECT_FALSE(told.scanners[0].allFinite());
  EXPECT_EQ(told.scanners[2], Vec3(1, 2, 3));
  EXPECT_EQ(told.scanners[3], Vec3(4, 5, 6));
  EXPECT_THAT(read("part.xyz", "# scanner of the house\n0 0 0\n1.5 0 0\n0 -2 0\n0 0 3e-3\n").scanners, IsEmpty());
}

TEST_F(PointRows, CommentsTitlesAndCounts) {
  for (const char* text :
       {"# made by hand\n0 0 0\n1.5 0 0\n// half\n0 -2 0\n0 0 3e-3\n", "4\n0 0 0\n1.5 0 0\n0 -2 0\n0 0 3e-3\n",
        "2\n0 0 0\n1.5 0 0\n2\n0 -2 0\n0 0 3e-3\n", "Scan of a part\n0 0 0\n1.5 0 0\n0 -2 0\n0 0 3e-3\n"})
    EXPECT_EQ(read("part.pts", text).points, corners_) << text;
}

TEST_F(PointRows, NamesTellTheColumns) {
  EXPECT_EQ(read("part.csv", "id,Z,x [mm],\"Y\"\n1,0,0,0\n2,0,1.5,0\n3,0,0,-2\n4,0.003,0,0\n").points, corners_);
  EXPECT_EQ(read("part.txt", "//X Y Z R G B\n0 0 0 1 2 3\n1.5 0 0 1 2 3\n0 -2 0 1 2 3\n0 0 3e-3 1 2 3\n").points,
            corners_);
  const PointCloud cloud = read("part.csv",
                                "\"Points:0\",\"Points:1\",\"Points:2\",nx,ny,nz\n0,0,0,2,0,0\n"
                                "1.5,0,0,0,0,-1\n0,-2,0,nan,0,0\n0,0,3e-3,0,3,4\n");
  EXPECT_EQ(cloud.points, corners_);
  EXPECT_THAT(cloud.normals, ElementsAre(Vec3(1, 0, 0), Vec3(0, 0, -1), Vec3(0, 0, 0), Vec3(0, 0.6, 0.8)));
}

TEST_F(PointRows, UnitColumnsAreNormalsAndColoursAreNot) {
  const PointCloud cloud = read("part.pwn", "0 0 0 1 0 0\n1.5 0 0 0 1 0\n0 -2 0 0 0 -1\n0 0 3e-3 0 0.6 0.8\n");
  EXPECT_EQ(cloud.points, corners_);
  ASSERT_EQ(cloud.normals.size(), 4);
  EXPECT_NEAR((cloud.normals[3] - Vec3(0, 0.6, 0.8)).norm(), 0, 1e-6);
  EXPECT_EQ(read("part.pts", "4\n0 0 0 17 1 0 0\n1.5 0 0 17 0 1 0\n0 -2 0 17 0 0 1\n0 0 3e-3 17 0 0 -1").normals.size(),
            4);
  EXPECT_THAT(read("part.txt", "0 0 0 255 0 0\n1.5 0 0 3 4 5\n0 -2 0 1 0 0\n0 0 3e-3 9 9 9\n").normals, IsEmpty());
  EXPECT_THAT(read("part.pts", "0 0 0 -12 255 0 0\n1.5 0 0 5 3 4 5\n0 -2 0 7 1 0 0\n0 0 3e-3 8 9 9 9\n").normals,
              IsEmpty());
}

TEST_F(PointRows, BadNumbersAreNamedWithTheirLine) {
  ErrorParts parts = failure("part.xyz", "0 0 0\n0 0 one\n");
  EXPECT_THAT(parts.where, HasSubstr("part.xyz:2"));
  EXPECT_EQ(parts.value, "one");
  EXPECT_EQ(failure("part.xyz", "0 0 0\n1 nan 0\n0 0 0\n0 0 0\n").value, "nan");
  EXPECT_EQ(failure("part.xyz", "nan nan nan\n").value, "nan");
  EXPECT_EQ(failure("part.xyz", "0 0 0\n1e999 0 0\n").value, "1e999");
  EXPECT_THAT(failure("part.xyz", "0 0 0\n1 2\n").what, HasSubstr("missing"));
  EXPECT_THAT(failure("part.csv", "0,0,0\n1,,2\n").what, HasSubstr("missing"));
  EXPECT_THAT(failure("part.xyz", "foo bar baz\nfoo bar baz\n").what, HasSubstr("number"));
  EXPECT_THAT(failure("part.csv", "x,y,colour\n1,2,3\n").what, HasSubstr("names no columns"));
}

TEST_F(PointRows, DecimalCommasAreRefused) {
  for (const char* text : {"1,5 2,5 3,5\n", "1,5;2,5;3,5\n", "1,5\t2,5\t3,5\n"})
    EXPECT_THAT(failure("part.txt", text).limit, HasSubstr("decimal point")) << text;
}

TEST_F(PointRows, PromisesAreHeldAgainstTheFile) {
  EXPECT_THAT(failure("part.pts", "1000000000\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n").what, HasSubstr("promises more"));
  EXPECT_THAT(failure("part.pts", "5\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n           ").what, HasSubstr("missing"));
}

TEST_F(ReadCloud, TooFewOrNone) {
  EXPECT_THAT(failure("part.xyz", "").what, HasSubstr("empty"));
  EXPECT_THAT(failure("part.xyz", "\n\n").what, HasSubstr("too few"));
  EXPECT_EQ(failure("part.xyz", "0 0 0\n1 0 0\n0 1 0\n").value, "3");
  EXPECT_THAT(failure("part.unknown", "0 0 0\n").what, HasSubstr("neither the content"));
}

TEST_F(ReadCloud, PtxTurnsMovesAndKnowsItsScanners) {
  const std::string head = "2\n2\n1 2 3\n1 0 0\n0 1 0\n0 0 1\n0 1 0 0\n-1 0 0 0\n0 0 1 0\n1 2 3 1\n";
  const PointCloud cloud = read("part.ptx", head + "0 0 0 0.5\n1 0 0 0.5\n0 1 0 0.5 1 2 3\n0 0 1 0.5\n" + head +
                                                "0 0 0 0\n0 0 0 0\n0 0 0 0\n5 0 0 0.5\n");
  EXPECT_THAT(cloud.points, ElementsAre(Vec3(1, 3, 3), Vec3(0, 2, 3), Vec3(1, 2, 4), Vec3(1, 7, 3)));
  EXPECT_EQ(cloud.left_out, 4);
  EXPECT_EQ(cloud.scanners, std::vector<Vec3>(4, Vec3(1, 2, 3)));
  EXPECT_THAT(failure("part.ptx", "1000000\n1000000\n" + head.substr(4)).what, HasSubstr("promises more"));
  EXPECT_THAT(failure("part.ptx", head + "1 0 0 0\n                          ").what, HasSubstr("missing"));
}

std::string pcd_header(const std::string& data, const std::string& points = "5") {
  return "# .PCD v0.7 - Point Cloud Data file format\nVERSION 0.7\nFIELDS x y z rgb normal_x normal_y normal_z\n"
         "SIZE 4 4 8 1 4 4 4\nTYPE F F F U F F F\nCOUNT 1 1 1 3 1 1 1\nWIDTH " +
         points + "\nHEIGHT 1\nVIEWPOINT 7 8 9 1 0 0 0\nPOINTS " + points + "\nDATA " + data + "\n";
}

TEST_F(ReadCloud, PcdInAllThreeForms) {
  const std::string nan = bytes(std::numeric_limits<float>::quiet_NaN());
  std::string by_points, by_fields[7];
  const auto add = [&](std::size_t field, const std::string& value) {
    by_points += value;
    by_fields[field] += value;
  };
  for (const Vec3& p : corners_) {
    add(0, bytes(static_cast<float>(p.x())));
    add(1, bytes(static_cast<float>(p.y())));
    add(2, bytes(p.z()));
    add(3, "abc");
    for (std::size_t k = 4; k < 7; ++k) add(k, bytes(k == 5 ? 2.0F : 0.0F));
  }
  for (std::size_t k = 0; k < 7; ++k) add(k, k == 2 ? bytes(0.0) : k == 3 ? "abc" : nan);
  std::string fields;
  for (const std::string& field : by_fields) fields += field;
  const std::string packed = lzf_literals(fields);
  const std::string text =
      "0 0 0 1 2 3 0 2 0\n1.5 0 0 1 2 3 0 2 0\n0 -2 0 1 2 3 0 2 0\n0 0 3e-3 1 2 3 0 2 0\n"
      "nan nan nan 1 2 3 nan nan nan\n";
  for (const std::string& content :
       {pcd_header("ascii") + text, pcd_header("binary") + by_points,
        pcd_header("binary_compressed") + bytes(static_cast<std::uint32_t>(packed.size())) +
            bytes(static_cast<std::uint32_t>(fields.size())) + packed}) {
    const PointCloud cloud = read("part.pcd", content);
    EXPECT_EQ(cloud.points, corners_);
    EXPECT_EQ(cloud.normals, std::vector<Vec3>(4, Vec3(0, 1, 0)));
    EXPECT_EQ(cloud.scanners, std::vector<Vec3>(1, Vec3(7, 8, 9)));
    EXPECT_EQ(cloud.left_out, 1);
    EXPECT_EQ(read("by_content.xyz", content).points, corners_);
  }
}

TEST_F(ReadCloud, PcdPromisesAreHeldAgainstTheFile) {
  for (const char* data : {"ascii", "binary", "binary_compressed"})
    EXPECT_THAT(failure("part.pcd", pcd_header(data, "1000000000") + std::string(200, '1')).what,
                testing::AnyOf(HasSubstr("promises more"), HasSubstr("ends inside")));
  EXPECT_THAT(
      failure("part.pcd", "VERSION 0.7\nFIELDS x y\nSIZE 4 4\nTYPE F F\nCOUNT 1 1\nWIDTH 1\nHEIGHT 1\nDATA ascii\n")
          .what,
      HasSubstr("lack a coordinate"));
}

TEST(Lzf, LiteralsCopiesAndDamage) {
  EXPECT_EQ(lzf_decompressed(std::string("\2abc", 4), 3), "abc");
  // "abc", then 9 bytes from 3 before: a copy that overlaps itself.
  EXPECT_EQ(lzf_decompressed(std::string("\2abc\xe0\0\2", 7), 12), "abcabcabcabc");
  EXPECT_EQ(lzf_decompressed(std::string("\2abc", 4), 4), std::nullopt);
  EXPECT_EQ(lzf_decompressed(std::string("\2abc", 4), 2), std::nullopt);
  EXPECT_EQ(lzf_decompressed(std::string("\5ab", 3), 6), std::nullopt);
  EXPECT_EQ(lzf_decompressed(std::string("\0a\x20\7", 4), 4), std::nullopt);  // from before the beginning
  EXPECT_EQ(lzf_decompressed("abc", 1'000'000'000), std::nullopt);
}

TEST_F(ReadCloud, LasScalesAndLeavesOutNoise) {
  for (const int minor : {2, 4})
    for (const int format : {0, 3, 6, 7}) {
      const PointCloud cloud = read("part.las", las_file(corners_, minor, format));
      ASSERT_EQ(cloud.points.size(), 4);
      for (std::size_t i = 0; i < 4; ++i) EXPECT_NEAR((cloud.points[i] - corners_[i]).norm(), 0, 1e-9);
      EXPECT_EQ(cloud.left_out, 2);  // one is noise, one withheld
    }
}

TEST_F(ReadCloud, LasDamagedOrCompressed) {
  std::string file = las_file(corners_, 2, 0);
  EXPECT_THAT(failure("part.las", file.substr(0, 100)).what, HasSubstr("header"));
  EXPECT_THAT(failure("part.las", file.substr(0, file.size() - 1)).what, HasSubstr("promises more"));
  file.replace(107, 4, bytes(std::uint32_t{1'000'000'000}));
  EXPECT_THAT(failure("part.las", file).what, HasSubstr("promises more"));
  file[104] = static_cast<char>(0x80);
  EXPECT_THAT(failure("part.laz", file).what, HasSubstr("LAZ"));
  EXPECT_THAT(failure("part.las", "0 0 0\n1 0 0\n").what, HasSubstr("LASF"));
}

TEST_F(ReadCloud, PointsOfSurfaceFormats) {
  EXPECT_EQ(read("part.off", "OFF 4 0 0\n0 0 0\n1.5 0 0\n0 -2 0\n0 0 3e-3\n").points, corners_);
  const PointCloud obj = read("part.obj",
                              "v 0 0 0\nvn 0 0 2\nv 1.5 0 0\nvn 1 0 0\nv 0 -2 0\nvn 1 0 0\nv 0 0 3e-3\n"
                              "vn 0 -1 0\n");
  EXPECT_EQ(obj.points, corners_);
  EXPECT_THAT(obj.normals, ElementsAre(Vec3(0, 0, 1), Vec3(1, 0, 0), Vec3(1, 0, 0), Vec3(0, -1, 0)));
  const PointCloud ply = read("part.ply",
                              "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\n"
                              "property float z\nproperty uchar red\nproperty float nx\nproperty float ny\n"
                              "property float nz\nend_header\n0 0 0 9 0 0 2\n1.5 0 0 9 1 0 0\n0 -2 0 9 nan nan nan\n"
                              "0 0 3e-3 9 0 1 0\n");
  EXPECT_EQ(ply.points, corners_);
  EXPECT_THAT(ply.normals, ElementsAre(Vec3(0, 0, 1), Vec3(1, 0, 0), Vec3(0, 0, 0), Vec3(0, 1, 0)));
  EXPECT_THAT(failure("part.ply",
                      "ply\nformat ascii 1.0\nelement vertex 1000000000\nproperty float x\nproperty float y\n"
                      "property float z\nend_header\n0 0 0\n")
                  .what,
              HasSubstr("promises more"));
}

TEST_F(ReadCloud, AScanIsASurfaceWhereItHasFaces) {
  write_surface(analytic::sphere(1, 0), folder_ / "ball.ply");
  EXPECT_TRUE(std::holds_alternative<SurfaceMesh>(read_scan(folder_ / "ball.ply")));
  EXPECT_EQ(read_cloud(folder_ / "ball.ply").points.size(), 12);
  const auto file = write_text(folder_ / "ball.off", "OFF 4 0 0\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n");
  EXPECT_TRUE(std::holds_alternative<PointCloud>(read_scan(file)));
  EXPECT_THAT(
      error_from<InvalidInput>([&] { read_scan(write_text(folder_ / "none.off", "OFF 0 0 0\n")); }).parts().what,
      HasSubstr("no faces"));
}

}  // namespace
}  // namespace scan2fea
