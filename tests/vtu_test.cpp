#include "export/formats.hpp"
#include "export/vtk.hpp"
#include "preproc/mesh/error.hpp"
#include "tests/structured_tets.hpp"
#include "tests/temporary_folder.hpp"

#include <gmock/gmock.h>

namespace scan2fea {
namespace {

using testing::HasSubstr;

class Vtu : public testing::TestWithParam<int> {
 protected:
  TemporaryFolder folder_;
};
INSTANTIATE_TEST_SUITE_P(Order, Vtu, testing::Values(1, 2));

TEST_P(Vtu, RoundTripsToTheBit) {
  TetMesh mesh = analytic::tetrahedra_of_box({3, 2, 1}, {3, 2, 2}, GetParam());
  for (Vec3& p : mesh.nodes) p = p / 7 - Vec3(1e5, 1e-9, 0.1);
  mesh.unit = "mm";
  FileOptions options;
  options.provenance = "a--b--->\n";
  write_vtu(mesh, folder_ / "box.vtu", options);
  const TetMesh read = read_volume(folder_ / "box.vtu");
  EXPECT_EQ(read.nodes, mesh.nodes);
  EXPECT_EQ(read.tetrahedra, mesh.tetrahedra);
  EXPECT_EQ(read.mid_edge_nodes, mesh.mid_edge_nodes);
  EXPECT_EQ(read.boundary.size(), mesh.boundary.size());
}

// One tetrahedron of volume 1/6 beside a triangle, in the encodings that VTK writes.
std::string grid(const std::string& attributes, const std::string& points, const std::string& connectivity,
                 const std::string& offsets, const std::string& types, const std::string& appended = {}) {
  return "<?xml version='1.0'?>\n<!-- a <Piece> in a comment -->\n<VTKFile type=\"UnstructuredGrid\" " + attributes +
         ">\n<UnstructuredGrid><Piece NumberOfPoints=\"4\" NumberOfCells=\"2\">\n"
         "<PointData><DataArray type=\"Float32\" Name=\"offsets\" format=\"ascii\">9 9 9 9</DataArray></PointData>\n"
         "<Points><DataArray type=\"Float32\" NumberOfComponents=\"3\" " +
         points +
         "</DataArray></Points>\n"
         "<Cells><DataArray type=\"Int32\" Name=\"connectivity\" " +
         connectivity +
         "</DataArray>\n"
         "<DataArray type=\"Int32\" Name=\"offsets\" " +
         offsets +
         "</DataArray>\n"
         "<DataArray type=\"UInt8\" Name=\"types\" " +
         types +
         "</DataArray></Cells>\n"
         "</Piece></UnstructuredGrid>" +
         appended + "</VTKFile>\n";
}

const std::string ascii = "format=\"ascii\">";
const std::string points_ascii = ascii + " 0 0 0  1 0 0\n 0 1.0e0 0 0 0 1 ";
const std::string connectivity_ascii = ascii + "0 1 2 3 0 1 2";

std::string message(const std::filesystem::path& file, const std::string& text) {
  write_text(file, text);
  try {
    const TetMesh mesh = read_volume(file);
    EXPECT_EQ(mesh.tetrahedra.size(), 1U);
    EXPECT_NEAR(total_volume(mesh), 1.0 / 6, 1e-15);
  } catch (const InvalidInput& error) {
    return error.what();
  }
  return "";
}

TEST(VtuReader, ReadsAscii) {
  const TemporaryFolder folder;
  EXPECT_EQ(message(folder / "a.vtu", grid("", points_ascii, connectivity_ascii, ascii + "4 7", ascii + "10 5")), "");
}

TEST(VtuReader, ReadsBase64WithHeaderApartAndTogether) {
  const TemporaryFolder folder;
  const std::string binary = "format=\"binary\">\n ";
  // Lengths are 4 bytes: 8 bytes of offsets (4, 7), 2 bytes of types (10, 5).
  EXPECT_EQ(message(folder / "apart.vtu", grid("", points_ascii, connectivity_ascii, binary + "CAAAAA==BAAAAAcAAAA=\n",
                                               binary + "AgAAAA==CgU=\n")),
            "");
  EXPECT_EQ(message(folder / "together.vtu",
                    grid("", points_ascii, connectivity_ascii, binary + "CAAAAAQAAAAHAAAA", binary + "AgAAAAoF")),
            "");
}

TEST(VtuReader, ReadsAppendedBigEndian) {
  const TemporaryFolder folder;
  using namespace std::string_literals;
  const std::string data = "\0\0\0\x08\0\0\0\x04\0\0\0\x07\0\0\0\x02\x0a\x05"s;
  EXPECT_EQ(message(folder / "raw.vtu", grid("byte_order=\"BigEndian\"", points_ascii, connectivity_ascii,
                                             "format=\"appended\" offset=\"0\">", "format=\"appended\" offset=\"12\">",
                                             "<AppendedData encoding=\"raw\">\n_" + data + "\n</AppendedData>")),
            "");
}

TEST(VtuReader, SaysWhatIsWrong) {
  const TemporaryFolder folder;
  const auto file = folder / "bad.vtu";
  const std::string good_offsets = ascii + "4 7", good_types = ascii + "10 5";
  EXPECT_THAT(message(file, "solid part"), HasSubstr("not a VTK XML file"));
  EXPECT_THAT(message(file, "<VTKFile type='ImageData'>"), HasSubstr("ImageData"));
  EXPECT_THAT(message(file, grid("compressor=\"vtkLZMADataCompressor\"", points_ascii, connectivity_ascii, good_offsets,
                                 good_types)),
              HasSubstr("is compressed"));
  EXPECT_THAT(message(file, grid("", ascii + "0 0 0", connectivity_ascii, good_offsets, good_types)),
              HasSubstr("Points"));
  EXPECT_THAT(message(file, grid("", points_ascii, ascii + "0 1 2 4 0 1 2", good_offsets, good_types)),
              HasSubstr("cell 0: element uses node 4"));
  EXPECT_THAT(message(file, grid("", points_ascii, ascii + "0 1 2 -3 0 1 2", good_offsets, good_types)),
              HasSubstr("connectivity holds what is not a number: -3"));
  EXPECT_THAT(message(file, grid("", points_ascii, connectivity_ascii, ascii + "4 8", good_types)),
              HasSubstr("cell 1"));
  EXPECT_THAT(message(file, grid("", points_ascii, connectivity_ascii, good_offsets, ascii + "12 5")),
              HasSubstr("cell 0 is not a tetrahedron"));
  EXPECT_THAT(
      message(file, grid("", points_ascii, connectivity_ascii, "format=\"appended\" offset=\"0\">", good_types)),
      HasSubstr("truncated"));
  EXPECT_THAT(
      message(file, grid("", points_ascii, connectivity_ascii, "format=\"appended\" offset=\"70\">", good_types)),
      HasSubstr("wrong offset"));

  // Every file that is cut short is refused, wherever the cut is, but for the closing tags, which say nothing.
  write_vtu(analytic::tetrahedra_of_box({1, 1, 1}, {1, 1, 1}, 2), file);
  const std::string whole = contents(file);
  for (std::size_t length = 1; length < whole.size() - std::string("\n</AppendedData>\n</VTKFile>\n").size();
       length += 7) {
    write_text(file, whole.substr(0, length));
    EXPECT_THROW(read_volume(file), InvalidInput) << length;
  }
}

}  // namespace
}  // namespace scan2fea
