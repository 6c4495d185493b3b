#include "preproc/mesh/read_surface.hpp"

#include "preproc/mesh/byte_order.hpp"
#include "preproc/mesh/error.hpp"
#include "preproc/mesh/write_surface.hpp"
#include "tests/analytic_meshes.hpp"
#include "tests/error_from.hpp"
#include "tests/temporary_folder.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace scan2fea {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

class ReadSurface : public testing::Test {
 protected:
  SurfaceMesh read(const std::string& name, std::string_view content) const {
    return read_surface(write_text(folder_ / name, content));
  }

  // The message of the InvalidInput that reading must end in.
  std::string error_of(const std::string& name, std::string_view content) const {
    return error_of(write_text(folder_ / name, content));
  }
  static std::string error_of(const std::filesystem::path& file) {
    const auto error = error_from<InvalidInput>([&] { read_surface(file); });
    EXPECT_EQ(error.exit_code(), 3);
    return error.what();
  }

  TemporaryFolder folder_;
};

using ReadStl = ReadSurface;
using ReadObj = ReadSurface;
using ReadPly = ReadSurface;
using ReadOff = ReadSurface;

// A tetrahedron in each text format, corners in one order.
constexpr std::string_view obj_tetrahedron = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 1 4 3\n";
constexpr std::string_view off_tetrahedron =
    "OFF\n4 4 6\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n3 0 2 1\n3 0 1 3\n3 1 2 3\n3 0 3 2\n";
constexpr std::string_view ply_tetrahedron =
    "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n"
    "element face 4\nproperty list uchar int vertex_indices\nend_header\n"
    "0 0 0\n1 0 0\n0 1 0\n0 0 1\n3 0 2 1\n3 0 1 3\n3 1 2 3\n3 0 3 2\n";

void expect_tetrahedron(const SurfaceMesh& mesh) {
  EXPECT_THAT(mesh.vertices, ElementsAre(Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0), Vec3(0, 0, 1)));
  EXPECT_THAT(mesh.triangles, ElementsAre(Triangle{0, 2, 1}, Triangle{0, 1, 3}, Triangle{1, 2, 3}, Triangle{0, 3, 2}));
}

std::string replaced(std::string text, std::string_view from, std::string_view to) {
  for (std::size_t at = 0; (at = text.find(from, at)) != std::string::npos; at += to.size())
    text.replace(at, from.size(), to);
  return text;
}

template <class T>
std::string bytes_of(T value, std::endian order) {
  std::string bytes(sizeof(T), '\0');
  store(value, bytes.data(), order);
  return bytes;
}

std::string ascii_stl(const SurfaceMesh& mesh, const std::string& name) {
  std::ostringstream text;
  text << "solid " << name << "\n";
  for (const Triangle& t : mesh.triangles) {
    text << "  facet normal 0 0 nan\n    outer loop\n";
    for (const std::uint32_t v : t) text << "      vertex " << mesh.vertices[v].transpose() << "\n";
    text << "    endloop\n  endfacet\n";
  }
  text << "endsolid " << name << "\n";
  return text.str();
}

std::string binary_stl(const SurfaceMesh& mesh, std::string header) {
  header.resize(80, ' ');
  std::string bytes = header + bytes_of(static_cast<std::uint32_t>(mesh.triangles.size()), std::endian::little);
  for (const Triangle& t : mesh.triangles) {
    bytes.append(12, '\0');
    for (const std::uint32_t v : t)
      for (const double x : mesh.vertices[v]) bytes += bytes_of(static_cast<float>(x), std::endian::little);
    bytes.append(2, '\0');
  }
  return bytes;
}

// Euler's formula for closed triangle meshes of genus 0: welded wrongly, a box does not satisfy it.
void expect_closed_box(const SurfaceMesh& mesh, double volume) {
  EXPECT_EQ(mesh.vertices.size(), mesh.triangles.size() / 2 + 2);
  EXPECT_NEAR(enclosed_volume(mesh), volume, 1e-9 * volume);
}

TEST_F(ReadStl, WeldingClosesABox) {
  const SurfaceMesh box = analytic::box({2, 3, 5}, 0.5);
  expect_closed_box(read("ascii.stl", ascii_stl(box, "box")), 30);
  expect_closed_box(read("binary.stl", binary_stl(box, "box")), 30);
}

TEST_F(ReadStl, NegativeZeroIsZero) {
  SurfaceMesh box = analytic::box({2, 3, 5}, 5);
  for (const std::size_t t : {0u, 5u, 7u})
    for (std::uint32_t& v : box.triangles[t]) {
      box.vertices.push_back(box.vertices[v]);
      for (double& x : box.vertices.back())
        if (x == 0) x = -0.0;
      v = static_cast<std::uint32_t>(box.vertices.size() - 1);
    }
  expect_closed_box(read("ascii.stl", ascii_stl(box, "box")), 30);
  const SurfaceMesh mesh = read("binary.stl", binary_stl(box, "box"));
  expect_closed_box(mesh, 30);
  for (const Vec3& p : mesh.vertices)
    for (const double x : p) EXPECT_FALSE(x == 0 && std::signbit(x));
}

TEST_F(ReadStl, SolidsOfOneFileAreRead) {
  SurfaceMesh second = analytic::box({1, 1, 1}, 1);
  for (Vec3& v : second.vertices) v += Vec3::Constant(10);
  const SurfaceMesh mesh =
      read("two.stl", ascii_stl(analytic::box({2, 3, 5}, 1), "solid facet") + ascii_stl(second, ""));
  EXPECT_NEAR(enclosed_volume(mesh), 31, 1e-9);
}

TEST_F(ReadStl, BinaryMayBeginWithSolid) {
  const std::string bytes = binary_stl(analytic::box({2, 3, 5}, 1), "solid exported by a CAD program");
  expect_closed_box(read("part.stl", bytes), 30);
  EXPECT_THAT(error_of("part.stl", bytes.substr(0, bytes.size() - 1)), HasSubstr("byte 80"));
}

TEST_F(ReadStl, KeywordsAndLineBreaksVary) {
  const std::string text = ascii_stl(analytic::box({2, 3, 5}, 1), "box");
  expect_closed_box(read("crlf.stl", replaced(text, "\n", "\r\n")), 30);
  expect_closed_box(read("cr.stl", replaced(text, "\n", "\r")), 30);
  expect_closed_box(read("bom.stl", "\xef\xbb\xbf" + text), 30);
  expect_closed_box(read("upper.STL", replaced(replaced(text, "vertex", "VERTEX"), "endfacet", "EndFacet")), 30);
}

TEST_F(ReadStl, AsciiKeepsDoubles) {
  const SurfaceMesh mesh =
      read("part.stl", replaced(ascii_stl(analytic::box({1, 1, 1}, 1), "box"), " 1", " 0.1000000000000000055"));
  EXPECT_EQ(bounding_box(mesh.vertices).high, Vec3::Constant(0.1));
}

TEST_F(ReadStl, TruncatedBinaryIsAnError) {
  const std::string bytes = binary_stl(analytic::box({2, 3, 5}, 1), "box");
  EXPECT_THAT(error_of("part.stl", bytes.substr(0, bytes.size() / 2)),
              testing::AllOf(HasSubstr("part.stl: byte 80"), HasSubstr("promises more triangles"), HasSubstr("124"),
                             HasSubstr("limit: 61")));
  EXPECT_THAT(error_of("part.stl", bytes.substr(0, 80) + std::string(4, '\0')), HasSubstr("no faces"));
  EXPECT_THAT(error_of("part.stl", std::string("\0\1\2", 3)), HasSubstr("84 bytes"));
  EXPECT_THAT(error_of("part.stl", bytes + bytes), HasSubstr("more triangles than its header says"));
}

TEST_F(ReadStl, TruncatedTextIsAnError) {
  const std::string text = ascii_stl(analytic::box({2, 3, 5}, 1), "box");
  EXPECT_THAT(error_of("part.stl", text.substr(0, text.find("endsolid"))), HasSubstr("before endsolid"));
  EXPECT_THAT(error_of("part.stl", text.substr(0, text.size() / 2)), HasSubstr("part.stl:"));
}

TEST_F(ReadStl, ATextFileIsAnError) {
  EXPECT_THAT(error_of("notes.stl", "\nDear colleague,\nthe scan follows.\n"),
              testing::AllOf(HasSubstr("notes.stl:2"), HasSubstr("Dear"), HasSubstr("not a keyword of STL")));
}

TEST_F(ReadStl, FacetsHaveThreeVertices) {
  const std::string text = ascii_stl(analytic::box({2, 3, 5}, 5), "box");
  const std::string vertex = "      vertex 0 0 0\n";
  EXPECT_THAT(error_of("part.stl", std::string(text).insert(text.find("    endloop"), vertex)),
              testing::AllOf(HasSubstr("part.stl:7"), HasSubstr("more than three")));
  EXPECT_THAT(error_of("part.stl", std::string(text).erase(text.find(vertex), vertex.size())),
              HasSubstr("before its third vertex"));
}

TEST_F(ReadStl, CoordinatesMustBeFinite) {
  SurfaceMesh box = analytic::box({2, 3, 5}, 5);
  box.vertices[box.triangles[1][2]][1] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THAT(error_of("part.stl", binary_stl(box, "box")), testing::AllOf(HasSubstr("byte"), HasSubstr("nan")));
  EXPECT_THAT(error_of("part.stl", ascii_stl(box, "box")), testing::AllOf(HasSubstr("part.stl:"), HasSubstr("nan")));
}

TEST_F(ReadObj, ReadsATetrahedron) {
  expect_tetrahedron(read("part.obj", obj_tetrahedron));
  expect_tetrahedron(read("part.OBJ", replaced(std::string(obj_tetrahedron), "\n", "\r\n")));
  expect_tetrahedron(read("part.obj", replaced(std::string(obj_tetrahedron), "\n", "\r")));
}

TEST_F(ReadObj, ReadsAllThatMayStandInAFile) {
  expect_tetrahedron(read("part.obj",
                          "# Blender v3 f 1 2 3\n"
                          "mtllib C:\\models\\\n"
                          "o part\n"
                          "v 0 0 0 1.0\n"
                          "v 1 0 0 0.2 0.3 0.4  # coloured\n"
                          "vt 0.5 0.5\n"
                          "vn 0 0 nan\n"
                          "\tv   0.\t+1e0 0 \n"
                          "g side front\n"
                          "usemtl steel\n"
                          "s off\n"
                          "f 1/1/1 3/1/1 2/1/1\n"
                          "f 1// 2//1 4//1\n"  // names a vertex that follows
                          "v 0 0 \\\n  1\n"
                          "f -3/-1 -2/-1 \\\r\n -1/-1 # the last\n"
                          "l 1 2\n"
                          "f 1 4 3"));
}

TEST_F(ReadObj, NegativeIndicesCountFromTheLastVertexSoFar) {
  const SurfaceMesh mesh = read("part.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf -3 -2 -1\nv 0 0 1\nf -1 -2 -3\n");
  EXPECT_THAT(mesh.triangles, ElementsAre(Triangle{0, 1, 2}, Triangle{3, 2, 1}));
}

TEST_F(ReadObj, PolygonsAreCut) {
  const SurfaceMesh mesh = read("part.obj", "v 0 0 0\nv 2 0 0\nv 3 1 0\nv 2 2 0\nv 0 2 0\nf 1 2 3 4 5\n");
  EXPECT_EQ(mesh.triangles.size(), 3u);
  EXPECT_DOUBLE_EQ(surface_area(mesh), 5);
}

TEST_F(ReadObj, IndicesMustBeInRange) {
  const std::string text(obj_tetrahedron);
  EXPECT_THAT(error_of("part.obj", text + "f 1 2 5\n"),
              testing::AllOf(HasSubstr("part.obj:9"), HasSubstr("out of range: 5"), HasSubstr("4 vertices")));
  EXPECT_THAT(error_of("part.obj", text + "f 0 1 2\n"), HasSubstr("OBJ counts from 1"));
  EXPECT_THAT(error_of("part.obj", "f -1 -1 -1\n" + text), HasSubstr("part.obj:1"));
  EXPECT_THAT(error_of("part.obj", text + "f 1 2 99999999999999999999\n"), HasSubstr("not a whole number"));
}

TEST_F(ReadObj, BadNumbersAreErrors) {
  const std::string text(obj_tetrahedron);
  for (const char* bad : {"nan", "inf", "-infinity", "1e999", "1,5", "1.0f", "0x10", "abc", "1.5.2"})
    EXPECT_THAT(error_of("part.obj", text + "\nv 0 " + bad + " 0\n"),
                testing::AllOf(HasSubstr("part.obj:10"), HasSubstr("not a finite number: " + std::string(bad))));
  EXPECT_THAT(error_of("part.obj", text + "v 0 0\nv 1 1 1\n"), HasSubstr("part.obj:9: a number is missing"));
  EXPECT_THAT(error_of("part.obj", text + "v 0 0"), HasSubstr("file ends"));
  EXPECT_THAT(error_of("part.obj", text + "f 1 2\n"), HasSubstr("too few corners"));
  EXPECT_THAT(error_of("part.obj", text + "f 1 2 x\n"), HasSubstr("not a whole number: x"));
}

TEST_F(ReadPly, ReadsATetrahedron) {
  expect_tetrahedron(read("part.ply", ply_tetrahedron));
  expect_tetrahedron(read("part.ply", replaced(std::string(ply_tetrahedron), "\n", "\r\n")));
  expect_tetrahedron(read("part.ply", replaced(std::string(ply_tetrahedron), "\n", "\r")));
}

// The tetrahedron with properties of all types, in an odd order, among elements that mean nothing here.
// Two squares and a triangle, the first square with the label 7.
std::string labelled_ply(const std::string& property, const std::string& labels) {
  std::istringstream values(labels);
  std::string a, b, c;
  values >> a >> b >> c;
  return "ply\nformat ascii 1.0\nelement vertex 7\nproperty float x\nproperty float y\nproperty float z\n"
         "element face 3\nproperty " +
         property +
         "\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n2 0 0\n2 1 0\n3 0 0\n" + a +
         " 4 0 1 2 3\n" + b + " 4 1 4 5 2\n" + c + " 3 4 6 5\n";
}

TEST_F(ReadSurface, PlyLabelsAreSets) {
  const auto sets = [&](const std::string& text) {
    return read_named_surface(write_text(folder_ / "part.ply", text)).face_sets;
  };
  const std::vector<NamedSet> parts = sets(labelled_ply("int label", "7 -1 7"));
  ASSERT_EQ(parts.size(), 2U);
  EXPECT_EQ(parts[0], named_set("label_-1", {2, 3}));
  EXPECT_EQ(parts[1], named_set("label_7", {0, 1, 4}));
  EXPECT_EQ(sets(labelled_ply("uchar object_id", "0 1 2")).size(), 3U);
  EXPECT_TRUE(sets(labelled_ply("int label", "1 1 1")).empty()) << "one label for all tells nothing";
  EXPECT_TRUE(sets(labelled_ply("float label", "1 2 3")).empty()) << "no whole numbers";
  EXPECT_TRUE(sets(labelled_ply("int quality", "1 2 3")).empty());
}

std::string elaborate_ply(std::endian order, std::string_view line_break) {
  std::string text = replaced(
      std::string("ply\nformat ") + (order == std::endian::big ? "binary_big_endian" : "binary_little_endian") +
          " 1.0\ncomment made up\nobj_info x\nelement camera 2\nproperty list ushort double poses\nproperty char id\n"
          "element vertex 4\nproperty uchar red\nproperty double z\nproperty list uchar short neighbours\n"
          "property float32 y\nproperty int8 x\n"
          "element nothing 3\n"
          "element face 4\nproperty float64 quality\nproperty list uint8 uint16 vertex_index\nproperty uint flags\n"
          "end_header\n",
      "\n", line_break);
  const auto put = [&](auto value) { text += bytes_of(value, order); };
  for (int camera = 0; camera < 2; ++camera) {
    put(std::uint16_t{2});
    put(std::numeric_limits<double>::quiet_NaN());
    put(1e300);
    put(std::int8_t{-1});
  }
  for (const Vec3& p : {Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0), Vec3(0, 0, 1)}) {
    put(std::uint8_t{255});
    put(p[2]);
    put(std::uint8_t{1});
    put(std::int16_t{-5});
    put(static_cast<float>(p[1]));
    put(static_cast<std::int8_t>(p[0]));
  }
  for (const Triangle& t : {Triangle{0, 2, 1}, Triangle{0, 1, 3}, Triangle{1, 2, 3}, Triangle{0, 3, 2}}) {
    put(0.5);
    put(std::uint8_t{3});
    for (const std::uint32_t v : t) put(static_cast<std::uint16_t>(v));
    put(std::uint32_t{7});
  }
  return text;
}

TEST_F(ReadPly, BothByteOrdersAndAllTypes) {
  for (const auto order : {std::endian::little, std::endian::big})
    for (const char* line_break : {"\n", "\r\n", "\r"})
      expect_tetrahedron(read("part.ply", elaborate_ply(order, line_break)));
}

TEST_F(ReadPly, BodyMayBeginWithALineFeed) {
  std::string text =
      "ply\rformat binary_little_endian 1.0\relement vertex 3\rproperty uchar x\rproperty uchar y\r"
      "property uchar z\relement face 1\rproperty list uchar uchar vertex_indices\rend_header\r";
  text += "\n\n\n";  // the point (10, 10, 10)
  text += std::string("\0\0\0\1\0\0\3\0\1\2", 10);
  EXPECT_EQ(read("part.ply", text).vertices[0], Vec3(10, 10, 10));
}

TEST_F(ReadPly, FacesMayComeBeforeVertices) {
  expect_tetrahedron(read("part.ply",
                          "ply\nformat ascii 1.0\nelement face 4\nproperty list uchar int vertex_indices\n"
                          "element vertex 4\nproperty float x\nproperty float y\nproperty float z\nend_header\n"
                          "3 0 2 1\n3 0 1 3\n3 1 2 3\n3 0 3 2\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n"));
}

TEST_F(ReadPly, StripsTurnEveryOtherTriangleAndRestart) {
  const SurfaceMesh mesh = read("part.ply",
                                "ply\nformat ascii 1.0\nelement vertex 6\nproperty float x\nproperty float y\n"
                                "property float z\nelement tristrips 1\nproperty list int int vertex_indices\n"
                                "end_header\n0 0 0\n1 0 0\n0 1 0\n1 1 0\n0 2 0\n1 2 0\n"
                                "12 0 1 2 3 -1 2 3 4 5 5 -1 -1\n");
  EXPECT_THAT(mesh.triangles, ElementsAre(Triangle{0, 1, 2}, Triangle{2, 1, 3}, Triangle{2, 3, 4}, Triangle{4, 3, 5}));
}

TEST_F(ReadPly, PolygonsAreCut) {
  const SurfaceMesh mesh = read("part.ply", replaced(replaced(std::string(ply_tetrahedron), "face 4", "face 2"),
                                                     "3 0 2 1\n3 0 1 3\n3 1 2 3\n3 0 3 2\n", "4 0 1 2 3 3 0 1 2"));
  EXPECT_EQ(mesh.triangles.size(), 3u);
}

TEST_F(ReadPly, FacesWithoutPropertiesAreNone) {
  // However many the header promises: four thousand million need no bytes.
  const std::string header =
      "ply\nformat binary_little_endian 1.0\nelement vertex 1\nproperty double x\nproperty double y\n"
      "property double z\nelement face 4294967295\nend_header\n";
  EXPECT_THAT(error_of("part.ply", header + std::string(24, '\0')), HasSubstr("no faces"));
}

TEST_F(ReadPly, PromisesBeyondTheFileAreErrors) {
  const std::string text(ply_tetrahedron);
  EXPECT_THAT(error_of("part.ply", replaced(text, "vertex 4", "vertex 4000000000")),
              testing::AllOf(HasSubstr("part.ply:3"), HasSubstr("promises more"), HasSubstr("4000000000")));
  EXPECT_THAT(error_of("part.ply", replaced(text, "face 4", "face 9000000000000000000")), HasSubstr("part.ply:7"));
  EXPECT_THAT(error_of("part.ply", replaced(text, "face 4", "face 5")), HasSubstr("file ends"));
  EXPECT_THAT(error_of("part.ply", replaced(text, "3 1 2 3", "2000000000 1 2 3")),
              testing::AllOf(HasSubstr("part.ply:16"), HasSubstr("list promises more")));
  const std::string bytes = elaborate_ply(std::endian::little, "\n");
  for (std::size_t size = bytes.find("end_header") + 10; size < bytes.size(); ++size)
    EXPECT_THAT(error_of("part.ply", bytes.substr(0, size)), HasSubstr("file"));
}

TEST_F(ReadPly, BadHeadersAreErrors) {
  const std::string text(ply_tetrahedron);
  EXPECT_THAT(error_of("part.ply", "plywood"), HasSubstr("begins with \"ply\""));
  EXPECT_THAT(error_of("part.ply", "ply"), HasSubstr("inside its header"));
  EXPECT_THAT(error_of("part.ply", replaced(text, "ascii", "binary")), HasSubstr("part.ply:2: not a format of PLY"));
  EXPECT_THAT(error_of("part.ply", replaced(text, "format ascii 1.0\n", "")), HasSubstr("names no format"));
  EXPECT_THAT(error_of("part.ply", replaced(text, "float y", "half y")),
              HasSubstr("part.ply:5: not a type of PLY: half"));
  EXPECT_THAT(error_of("part.ply", replaced(text, "float y", "float v")), HasSubstr("lack a coordinate: y"));
  EXPECT_THAT(error_of("part.ply", replaced(text, "element vertex", "element points")), HasSubstr("no vertices"));
  EXPECT_THAT(error_of("part.ply", replaced(text, "vertex 4", "vertex -4")), HasSubstr("negative"));
  EXPECT_THAT(error_of("part.ply", replaced(text, "uchar int", "float int")), HasSubstr("not a whole number"));
  EXPECT_THAT(error_of("part.ply", replaced(text, "uchar int", "uchar float")), HasSubstr("not whole numbers"));
}

TEST_F(ReadPly, BadValuesAreErrors) {
  const std::string text(ply_tetrahedron);
  EXPECT_THAT(error_of("part.ply", replaced(text, "3 1 2 3", "3 1 2 4")),
              testing::AllOf(HasSubstr("part.ply:16"), HasSubstr("out of range: 4"), HasSubstr("4 vertices")));
  EXPECT_THAT(error_of("part.ply", replaced(text, "3 1 2 3", "3 1 2 -3")), HasSubstr("out of range: -3"));
  EXPECT_THAT(error_of("part.ply", replaced(text, "0 1 0", "0 nan 0")), HasSubstr("part.ply:12"));
  EXPECT_THAT(error_of("part.ply", replaced(text, "3 1 2 3", "2 1 2")), HasSubstr("too few corners"));
  std::string bytes = elaborate_ply(std::endian::big, "\n");
  const std::string one = bytes_of(1.0, std::endian::big);
  bytes.replace(bytes.rfind(one), one.size(), bytes_of(std::numeric_limits<double>::infinity(), std::endian::big));
  EXPECT_THAT(error_of("part.ply", bytes),
              testing::AllOf(HasSubstr("byte"), HasSubstr("not a finite coordinate: inf")));
}

TEST_F(ReadOff, ReadsATetrahedron) {
  const std::string text(off_tetrahedron);
  expect_tetrahedron(read("part.off", text));
  expect_tetrahedron(read("part.off", replaced(text, "\n", "\r\n")));
  expect_tetrahedron(read("part.off", replaced(text, "OFF\n", "OFF ")));
  expect_tetrahedron(read("part.off", replaced(text, "OFF\n", "")));
  expect_tetrahedron(read("part.off", replaced(text, "4 4 6", "4 4")));
}

TEST_F(ReadOff, ColoursNormalsAndCommentsArePassedOver) {
  expect_tetrahedron(read("part.off",
                          "# written by\n\nCNOFF # with both\n# counts\n4 4 0\n\n0 0 0 0 0 1 255 0 0 255\n"
                          "1 0 0 0 0 1 1 0 0 1 # second\n# third\n0 1 0 0 0 1 1 0 0 1\n0 0 1 0 0 1 1 0 0 1\n"
                          "3 0 2 1 255 0 0\n3 0 1 3 0.1 0.2 0.3 1\n3 1 2 3 7\n\n3 0 3 2\n"));
}

TEST_F(ReadOff, BadFilesAreErrors) {
  const std::string text(off_tetrahedron);
  EXPECT_THAT(error_of("part.off", replaced(text, "OFF", "4OFF")), HasSubstr("three dimensions"));
  EXPECT_THAT(error_of("part.off", replaced(text, "OFF", "OFF BINARY")), HasSubstr("binary OFF"));
  EXPECT_THAT(error_of("part.off", "OFF\n"), HasSubstr("before its counts"));
  EXPECT_THAT(error_of("part.off", replaced(text, "4 4 6", "900000000 4 6")), HasSubstr("part.off:2"));
  EXPECT_THAT(error_of("part.off", replaced(text, "4 4 6", "-4 4 6")), HasSubstr("-4"));
  EXPECT_THAT(error_of("part.off", replaced(text, "4 4 6", "4 5 6")), HasSubstr("before its last face"));
  EXPECT_THAT(error_of("part.off", replaced(text, "3 1 2 3", "3 1 2 4")),
              testing::AllOf(HasSubstr("part.off:9"), HasSubstr("out of range: 4")));
  EXPECT_THAT(error_of("part.off", replaced(text, "3 1 2 3", "4 1 2 3")), HasSubstr("part.off:9"));
  EXPECT_THAT(error_of("part.off", replaced(text, "3 1 2 3", "2 1 2")), HasSubstr("too few corners"));
  EXPECT_THAT(error_of("part.off", replaced(text, "0 1 0", "0 inf 0")), HasSubstr("part.off:5"));
}

TEST_F(ReadSurface, ContentTellsMoreThanTheExtension) {
  expect_tetrahedron(read("part.obj", ply_tetrahedron));
  expect_tetrahedron(read("part.stl", off_tetrahedron));
  expect_tetrahedron(read("scan", ply_tetrahedron));
  expect_closed_box(read("part.ply", binary_stl(analytic::box({2, 3, 5}, 1), "box")), 30);
}

TEST_F(ReadSurface, UnknownExtensionsAreErrors) {
  EXPECT_THAT(error_of("part.step", "ISO-10303-21;"), testing::AllOf(HasSubstr(".step"), HasSubstr(".stl, .obj")));
  EXPECT_THAT(error_of("part", obj_tetrahedron), HasSubstr(".stl, .obj"));
}

TEST_F(ReadSurface, FilesThatCannotBeReadAreErrors) {
  EXPECT_THAT(error_of(folder_ / "missing.stl"), testing::AllOf(HasSubstr("missing.stl"), HasSubstr("no such file")));
  EXPECT_THAT(error_of(folder_.path()), HasSubstr("directory"));
  for (const char* name : {"empty.stl", "empty.obj", "empty.ply", "empty.off", "empty"})
    EXPECT_THAT(error_of(name, ""), HasSubstr("empty"));
}

TEST_F(ReadSurface, FilesWithoutFacesAreErrors) {
  EXPECT_THAT(error_of("points.obj", "v 0 0 0\nv 1 0 0\n"),
              testing::AllOf(HasSubstr("no faces"), HasSubstr("2 vertices")));
  EXPECT_THAT(error_of("notes.obj", "Dear colleague,\n"), HasSubstr("no faces"));
  EXPECT_THAT(error_of("solid.stl", "solid\nendsolid\n"), HasSubstr("no faces"));
  EXPECT_THAT(error_of("points.off", "OFF 1 0 0\n0 0 0\n"), HasSubstr("no faces"));
}

TEST_F(ReadSurface, UnusedVerticesAreKept) {
  EXPECT_EQ(read("part.obj", std::string(obj_tetrahedron) + "v 9 9 9\n").vertices.size(), 5u);
}

TEST_F(ReadSurface, NamesReachTheTerminalAsPlainText) {
  EXPECT_EQ(error_of("evil\x1b[31m\n.obj", "v 0 0 \x1b[2J\n").find('\x1b'), std::string::npos);
}

}  // namespace
}  // namespace scan2fea
