#include "export/inp.hpp"

#include "export/formats.hpp"
#include "export/smallest_determinant.hpp"
#include "preproc/mesh/error.hpp"
#include "tests/error_from.hpp"
#include "tests/structured_tets.hpp"
#include "tests/temporary_folder.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <map>
#include <set>
#include <sstream>

namespace scan2fea {
namespace {

using testing::HasSubstr;

class Inp : public testing::TestWithParam<int> {
 protected:
  TetMesh box() const { return analytic::tetrahedra_of_box({3, 2, 1}, {3, 2, 2}, GetParam()); }
  TemporaryFolder folder_;
};
INSTANTIATE_TEST_SUITE_P(Order, Inp, testing::Values(1, 2));

TEST_P(Inp, RoundTripsToTheBit) {
  TetMesh mesh = box();
  for (Vec3& p : mesh.nodes) p = p / 3 + Vec3(1e-7, 100, -0.3);  // digits in plenty, but no more than fit
  write_inp(mesh, folder_ / "box.inp");
  const TetMesh read = read_volume(folder_ / "box.inp");
  EXPECT_EQ(read.nodes, mesh.nodes);
  EXPECT_EQ(read.tetrahedra, mesh.tetrahedra);
  EXPECT_EQ(read.mid_edge_nodes, mesh.mid_edge_nodes);
}

// Rows of integers of the block whose keyword line is `keyword`.
std::vector<std::vector<long>> block(const std::string& text, const std::string& keyword) {
  std::istringstream lines(text);
  std::vector<std::vector<long>> rows;
  bool inside = false;
  for (std::string line; std::getline(lines, line);) {
    if (line.starts_with("*")) {
      inside = line == keyword;
      continue;
    }
    if (!inside) continue;
    std::replace(line.begin(), line.end(), ',', ' ');
    std::istringstream fields(line);
    rows.emplace_back();
    for (long number; fields >> number;) rows.back().push_back(number);
  }
  return rows;
}

TEST_P(Inp, SurfaceIsExactlyTheBoundaryAndFacesOutwards) {
  const TetMesh mesh = box();
  write_inp(mesh, folder_ / "box.inp");
  const std::string text = contents(folder_ / "box.inp");

  // Abaqus's definition of the faces, written out once more: not the table that the writer uses.
  const std::map<int, std::array<std::size_t, 3>> corners_of_face{
      {1, {0, 1, 2}}, {2, {0, 3, 1}}, {3, {1, 3, 2}}, {4, {2, 3, 0}}};
  std::set<std::set<std::uint32_t>> faces;
  double volume = 0;
  for (const auto& [face, corners] : corners_of_face) {
    const std::string s = "S" + std::to_string(face);
    EXPECT_NE(text.find("\nSALL_" + s + ", " + s + "\n"), std::string::npos);
    for (const auto& row : block(text, "*ELSET, ELSET=SALL_" + s))
      for (const long element : row) {
        const Tetrahedron& t = mesh.tetrahedra.at(static_cast<std::size_t>(element - 1));
        const auto a = t[corners[0]], b = t[corners[1]], c = t[corners[2]];
        EXPECT_TRUE(faces.insert({a, b, c}).second) << "face listed twice";
        // Abaqus's faces are clockwise seen from outside, so this sums to minus six volumes.
        volume -= mesh.nodes[a].dot(mesh.nodes[b].cross(mesh.nodes[c])) / 6;
      }
  }
  EXPECT_EQ(faces.size(), mesh.boundary.size());
  EXPECT_NEAR(volume, 6, 1e-12);
}

TEST_P(Inp, NodesOfTheSurfaceAreThoseOnTheBox) {
  const TetMesh mesh = box();
  write_inp(mesh, folder_ / "box.inp");
  std::set<long> listed;
  for (const auto& row : block(contents(folder_ / "box.inp"), "*NSET, NSET=SALL_NODES"))
    listed.insert(row.begin(), row.end());
  std::set<long> expected;
  for (std::size_t n = 0; n < mesh.nodes.size(); ++n) {
    const Vec3& p = mesh.nodes[n];
    if ((p.array() == 0).any() || (p.array() == Eigen::Array3d(3, 2, 1)).any())
      expected.insert(static_cast<long>(n) + 1);
  }
  EXPECT_EQ(listed, expected);
}

TEST_P(Inp, KeepsToTheWidthsThatCalculixReads) {
  TetMesh mesh = box();
  for (Vec3& p : mesh.nodes) p = (p - Vec3::Constant(0.77)) * 1.2345678901234567e-4;
  FileOptions options;
  options.provenance = std::string(500, 'x');
  write_inp(mesh, folder_ / "box.inp", options);
  std::istringstream lines(contents(folder_ / "box.inp"));
  bool nodes = false;
  for (std::string line; std::getline(lines, line);) {
    ASSERT_LE(line.size(), 132U);
    if (line.starts_with("*")) {
      nodes = line.starts_with("*NODE");
      continue;
    }
    if (!nodes) continue;
    std::istringstream fields(line);
    for (std::string field; std::getline(fields, field, ',');) {
      field.erase(0, field.find_first_not_of(' '));
      ASSERT_LE(field.size(), 20U);
    }
  }
}

TEST(InpHeader, NamesUnitAndBoxAndCannotBeBrokenOutOf) {
  const TemporaryFolder folder;
  TetMesh mesh = analytic::tetrahedra_of_box({3, 2, 1}, {1, 1, 1}, 1);
  mesh.unit = "mm";
  FileOptions options;
  options.provenance = "scan.ply\n*NODE\n1, 0, 0, 0";
  write_inp(mesh, folder / "box.inp", options);
  const std::string text = contents(folder / "box.inp");
  EXPECT_THAT(text, HasSubstr("\n** unit of length: mm\n"));
  EXPECT_THAT(text, HasSubstr("\n** bounding box, high: 3 2 1\n"));
  EXPECT_EQ(read_volume(folder / "box.inp").nodes.size(), 8U);
}

TEST(InpReader, ReadsWhatOtherProgramsWrite) {
  const TemporaryFolder folder;
  write_text(folder / "other.inp",
             "*Heading\r\n a title, with words\r\n** comment\r\n"
             "*Node , nset = all\r\n"
             "  70,  +1.0D+00, 0.0\r\n"  // the third coordinate is left out
             "  5, 0., 1., 0.\r\n\r\n  900, , , 2.5E+00\r\n  8,0,0,0\r\n 77, 9, 9, 9\r\n"
             "*NODE PRINT, NSET=all\r\nU\r\n"
             "*ELEMENT, TYPE=T3D2, ELSET=bars\r\n 1, 5, 8\r\n"
             "*element,\r\n type=c3d4\r\n"
             " 12, 8, 70,\r\n 5, 900\r\n"
             "*STEP\r\n*STATIC\r\n*END STEP");
  const TetMesh mesh = read_volume(folder / "other.inp");
  ASSERT_EQ(mesh.tetrahedra.size(), 1U);
  EXPECT_EQ(mesh.nodes.size(), 4U);  // 77 is not used
  EXPECT_NEAR(total_volume(mesh), 2.5 / 6, 1e-15);
  EXPECT_EQ(mesh.boundary.size(), 4U);
}

TEST(InpReader, SaysWhereAFileIsWrong) {
  const TemporaryFolder folder;
  const std::string nodes = "*NODE\n1,0,0,0\n2,1,0,0\n3,0,1,0\n4,0,0,1\n";
  const auto message = [&](const std::string& text) -> std::string {
    write_text(folder / "bad.inp", text);
    return error_from<InvalidInput>([&] { read_volume(folder / "bad.inp"); }).what();
  };
  EXPECT_THAT(message(""), HasSubstr("empty"));
  EXPECT_THAT(message("solid part\n"), HasSubstr("holds no tetrahedra"));
  EXPECT_THAT(message("*INCLUDE, INPUT=mesh.inp\n"), HasSubstr("*INCLUDE"));
  EXPECT_THAT(message(nodes + "*ELEMENT, TYPE=C3D4\n1,1,2,3,5\n"), HasSubstr("bad.inp:7: element uses node 5"));
  EXPECT_THAT(message(nodes + "*ELEMENT, TYPE=C3D4\n1,1,2,3,3\n"), HasSubstr("bad.inp:7: element uses a node twice"));
  EXPECT_THAT(message(nodes + "*ELEMENT, TYPE=C3D4\n1,1,2,3\n"), HasSubstr("bad.inp:7: element has too few nodes"));
  EXPECT_THAT(message(nodes + "*ELEMENT, TYPE=C3D4\n1,1,2,x,4\n"), HasSubstr("bad.inp:7"));
  EXPECT_THAT(message(nodes + "*ELEMENT, TYPE=C3D8\n1,1,2,3,4,1,2,3,4\n"),
              HasSubstr("bad.inp:6: elements are not tetrahedra: C3D8"));
  EXPECT_THAT(message(nodes + "*ELEMENT\n1,1,2,3,4\n"), HasSubstr("bad.inp:6"));
  EXPECT_THAT(message(nodes + "4,0,0,2\n*ELEMENT, TYPE=C3D4\n1,1,2,3,4\n"),
              HasSubstr("bad.inp:6: node 4 is defined twice"));
  EXPECT_THAT(message("*NODE\n1,0,zero,0\n"), HasSubstr("bad.inp:2: not a number: zero"));
  EXPECT_THAT(message("*NODE\n1,0,nan,0\n2,1,0,0\n3,0,1,0\n4,0,0,1\n*ELEMENT, TYPE=C3D4\n1,1,2,3,4\n"),
              HasSubstr("bad.inp:2: coordinate is not a finite number"));
  EXPECT_THROW(read_inp(folder.path()), InvalidInput);
  EXPECT_THROW(read_volume(folder / "missing.inp"), InvalidInput);
}

TEST(SmallestDeterminant, IsSixVolumesOfStraightTetrahedra) {
  // All six tetrahedra of a cube have a sixth of its volume.
  for (const int order : {1, 2})
    EXPECT_NEAR(smallest_determinant(analytic::tetrahedra_of_box({4, 2, 1}, {2, 2, 2}, order)).value, 1, 1e-12);
}

TEST(SmallestDeterminant, FindsTheElementThatAMovedMidEdgeNodeInverts) {
  TetMesh mesh = analytic::tetrahedra_of_box({1, 1, 1}, {1, 1, 1}, 2);
  const Tetrahedron& t = mesh.tetrahedra[3];
  // The node of edge 12 goes beyond the opposite corners, inverting the map there.
  mesh.nodes[mesh.mid_edge_nodes[3][0]] = 2 * mesh.nodes[t[3]] - mesh.nodes[t[0]];
  EXPECT_LT(smallest_determinant(mesh).value, 0);
}

}  // namespace
}  // namespace scan2fea
