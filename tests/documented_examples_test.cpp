// Formats for which Debian has no reader: files as their makers' manuals show them and as their programs write them are
// read, so that what we write and read is the same language.
#include "export/formats.hpp"
#include "preproc/mesh/error.hpp"
#include "tests/part_with_sets.hpp"
#include "tests/temporary_folder.hpp"

#include <gmock/gmock.h>

#include <sstream>

namespace scan2fea {
namespace {

class DocumentedExamples : public testing::Test {
 protected:
  MeshFile read(const std::string& name, const std::string& text) {
    write_text(folder_ / name, text);
    return read_mesh(folder_ / name);
  }
  TemporaryFolder folder_;
};

// Two tetrahedra that share a face, nodes at corners of a unit cube: together a half.
void expect_the_two(const TetMesh& mesh) {
  EXPECT_EQ(mesh.tetrahedra.size(), 2U);
  EXPECT_EQ(mesh.boundary.size(), 6U);
  EXPECT_NEAR(total_volume(mesh), 0.5, 1e-12);
  for (const Tetrahedron& t : mesh.tetrahedra) {
    const Vec3 &a = mesh.nodes[t[0]], &b = mesh.nodes[t[1]], &c = mesh.nodes[t[2]], &d = mesh.nodes[t[3]];
    EXPECT_GT((b - a).cross(c - a).dot(d - a), 0) << "of the orientation that solvers want";
  }
}

// As the SU2 manual's "Mesh File" chapter: comments, indices behind elements and points, markers.
TEST_F(DocumentedExamples, Su2) {
  const MeshFile file =
      read("box.su2",
           "%\n% Problem dimension\n%\nNDIME= 3\n%\n% Inner element connectivity\n%\nNELEM= 2\n"
           "10\t0\t1\t2\t3\t0\n10 1 4 2 3 1\n%\n% Node coordinates\n%\nNPOIN= 5\n"
           "0.00000000000000 0.0 0.0 0\n1.0 0.0 0.0 1\n0.0 1.0 0.0 2\n0.0 0.0 1.0 3\n1.0 1.0 1.0 4\n"
           "%\n% Boundary elements\n%\nNMARK= 2\nMARKER_TAG= lower\nMARKER_ELEMS= 2\n5 0 2 1\n5 0 1 3\n"
           "MARKER_TAG= upper\nMARKER_ELEMS= 1\n5 1 4 3\n");
  const auto& mesh = std::get<TetMesh>(file.mesh);
  expect_the_two(mesh);
  ASSERT_EQ(mesh.face_sets.size(), 2U);
  EXPECT_EQ(mesh.face_sets[0].name, "lower");
  EXPECT_EQ(mesh.face_sets[0].members.size(), 2U);
  EXPECT_EQ(mesh.face_sets[1].members.size(), 1U);
  EXPECT_EQ(file.warnings, Notes{});
}

// As ElmerGrid writes it: names by heads, parents of boundary elements.
TEST_F(DocumentedExamples, Elmer) {
  write_text(folder_ / "mesh.nodes", "1 -1 0 0 0\n2 -1 1 0 0\n3 -1 0 1 0\n4 -1 0 0 1\n5 -1 1 1 1\n");
  write_text(folder_ / "mesh.elements", "1 1 504 1 2 3 4\n2 2 504 2 5 3 4\n");
  write_text(folder_ / "mesh.boundary", "1 1 1 0 303 1 3 2\n2 1 1 0 303 1 2 4\n3 2 2 0 303 2 5 4\n");
  write_text(folder_ / "mesh.names",
             "! ----- names for bodies -----\n$ steel = 1\n$ copper = 2\n! ----- names for boundaries -----\n"
             "$ lower = 1\n$ upper = 2\n");
  const MeshFile file = read("mesh.header", "5 2 3\n2\n504 2\n303 3\n");
  const auto& mesh = std::get<TetMesh>(file.mesh);
  expect_the_two(mesh);
  ASSERT_EQ(mesh.element_sets.size(), 2U);
  EXPECT_EQ(mesh.element_sets[1], (NamedSet{"copper", {1}}));
  ASSERT_EQ(mesh.face_sets.size(), 2U);
  EXPECT_EQ(mesh.face_sets[0].name, "lower");
  EXPECT_EQ(mesh.face_sets[0].members.size(), 2U);
}

// As CDWRITE writes it (ANSYS Mechanical APDL Command Reference: NBLOCK, EBLOCK, CMBLOCK): coordinates that are zero at
// the end of a line are left out, a component's ranges end with a negative number, SOLID185 has tetrahedra as
// degenerate bricks.
TEST_F(DocumentedExamples, Cdb) {
  const MeshFile file =
      read("part.cdb",
           "/COM,ANSYS RELEASE 2021 R1\n/UNITS,BIN\n/PREP7\n/NOPR\nET,        1,185\n"
           "NBLOCK,6,SOLID,        5,        5\n(3i9,6e21.13e3)\n"
           "        1        0        0\n"
           "        2        0        0 1.0000000000000E+000\n"
           "        3        0        0 0.0000000000000E+000 1.0000000000000E+000\n"
           "        4        0        0 0.0000000000000E+000 0.0000000000000E+000 1.0000000000000E+000\n"
           "        5        0        0 1.0000000000000E+000 1.0000000000000E+000 1.0000000000000E+000\n"
           "N,R5.3,LOC,       -1,\nEBLOCK,19,SOLID,        2,        2\n(19i9)\n"
           "        1        1        1        1        0        0        0        0        8        0        1"
           "        1        2        3        3        4        4        4        4\n"
           "        1        1        1        1        0        0        0        0        4        0        2"
           "        2        5        3        4\n       -1\n"
           "CMBLOCK,PINS    ,NODE,       3  ! users node component definition\n(8i10)\n         1         3        -5\n"
           "CMBLOCK,TOP     ,ELEM,       1\n(8i10)\n         2\n/GO\nFINISH\n");
  const auto& mesh = std::get<TetMesh>(file.mesh);
  expect_the_two(mesh);
  EXPECT_EQ(mesh.unit, "in");
  EXPECT_EQ(mesh.node_sets, (std::vector<NamedSet>{{"PINS", {0, 2, 3, 4}}}));
  EXPECT_EQ(mesh.element_sets, (std::vector<NamedSet>{{"TOP", {1}}}));
}

// As document U3.01.00 of Code_Aster describes it: a title, names of all kinds, comments, a group's name as a parameter
// or as the first word, sub-files with parameters.
TEST_F(DocumentedExamples, CodeAster) {
  const MeshFile file =
      read("part.mail",
           "TITRE\n CUBE = TEST % of all\nFINSF\n%\nCOOR_3D   NOM=INDEFINI  NBOBJ=5\n A 0. 0. 0.\n B 1.D0 0. 0.\n"
           " C 0. 1. 0.\n NO4\n 0. 0. 1.\n E 1. 1. 1.\nFINSF\nTETRA4\n T1 A B C NO4\n T2 B E\n C NO4\nFINSF\n"
           "TRIA3\n F1 A C B\nFINSF\nSEG2\n S1 A B\nFINSF\nGROUP_MA NOM = LOWER\n F1\nFINSF\nGROUP_NO\n PINS A E\n"
           "FINSF\nGROUP_MA\n BODY T2\nFINSF\nFIN\n");
  const auto& mesh = std::get<TetMesh>(file.mesh);
  expect_the_two(mesh);
  ASSERT_EQ(mesh.face_sets.size(), 1U);
  EXPECT_EQ(mesh.face_sets[0].name, "LOWER");
  EXPECT_EQ(mesh.face_sets[0].members.size(), 1U);
  EXPECT_EQ(mesh.node_sets, (std::vector<NamedSet>{{"PINS", {0, 4}}}));
  EXPECT_EQ(mesh.element_sets, (std::vector<NamedSet>{{"BODY", {1}}}));
}

// Free and small fields, continuations with and without marks, exponents without a letter, ranges (MSC Nastran Quick
// Reference Guide: "Format of Bulk Data Entries", SET1, PLOAD4).
TEST_F(DocumentedExamples, Nastran) {
  const MeshFile file = read(
      "part.bdf",
      "SOL 101\nCEND\nTITLE = GRID\nBEGIN BULK\nGRID,1,,0.,0.,0.\nGRID           2              1.      0.      0.\n"
      "GRID    3               0.      1.      0.\nGRID*                  4                              0.\n"
      "*                     1.\nGRID    5               1.      1.+0     10.-1\n"
      "CTETRA  11      1       1       2       3       4\nCTETRA,12,2,2,5,3,4\n$ a comment\n"
      "SET1    7       1       THRU    3       5\nPLOAD4  9       12      2.5                             2       3\n"
      "PSOLID  1       1\nPSOLID  2       1\nENDDATA\nGRID,6,,9.,9.,9.\n");
  const auto& mesh = std::get<TetMesh>(file.mesh);
  expect_the_two(mesh);
  EXPECT_EQ(mesh.node_sets, (std::vector<NamedSet>{{"SET_7", {0, 1, 2, 4}}}));
  EXPECT_EQ(mesh.element_sets, (std::vector<NamedSet>{{"PROPERTY_1", {0}}, {"PROPERTY_2", {1}}}));
  ASSERT_EQ(mesh.face_sets.size(), 1U);
  ASSERT_EQ(mesh.face_sets[0].members.size(), 1U);
  const Triangle face = boundary_triangle(mesh, mesh.boundary[mesh.face_sets[0].members[0]]);
  EXPECT_THAT(face, testing::UnorderedElementsAre(1U, 4U, 3U)) << "the face of element 12 opposite to node 3";
}

// The middle of each edge is where the format's own numbering of edges says.
TEST_F(DocumentedExamples, NodesInTheMiddleOfEdgesStandInTheFormatsOrder) {
  const TetMesh mesh = analytic::part_with_sets(2);
  for (const char* name : {"mesh.header", "part.cdb", "part.mail"}) {
    write_volume(mesh, folder_ / name);
    const std::string text =
        contents(folder_ / (std::string(name) == "mesh.header" ? std::string("mesh.elements") : name));
    // The first element's ten nodes: its corners, then 12 23 13 14 24 34 in all three manuals.
    std::string numbers = std::string(name) == "part.cdb"    ? text.substr(text.find("(19i9)\n") + 7 + 99)
                          : std::string(name) == "part.mail" ? text.substr(text.find(" M1 ") + 4)
                                                             : text.substr(text.find("510") + 3);
    std::replace(numbers.begin(), numbers.end(), 'N', ' ');
    std::istringstream words(numbers);
    std::array<std::size_t, 10> n{};
    for (std::size_t& node : n) words >> node;
    constexpr std::array<std::array<std::size_t, 2>, 6> edges{{{0, 1}, {1, 2}, {0, 2}, {0, 3}, {1, 3}, {2, 3}}};
    for (std::size_t e = 0; e < 6; ++e) {
      const Vec3 middle = (mesh.nodes.at(n[edges[e][0]] - 1) + mesh.nodes.at(n[edges[e][1]] - 1)) / 2;
      EXPECT_LE((mesh.nodes.at(n[4 + e] - 1) - middle).norm(), 1e-12) << name << ", edge " << e;
    }
  }
}

}  // namespace
}  // namespace scan2fea
