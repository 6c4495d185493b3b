#include "export/msh.hpp"

#include "export/formats.hpp"
#include "preproc/mesh/error.hpp"
#include "tests/binary_msh.hpp"
#include "tests/error_from.hpp"
#include "tests/structured_tets.hpp"
#include "tests/temporary_folder.hpp"

#include <gmock/gmock.h>

namespace scan2fea {
namespace {

using testing::HasSubstr;

struct Case {
  MshVersion version;
  int order;
};

// For the test's name, which otherwise shows the bytes of the struct.
void PrintTo(const Case& c, std::ostream* out) {
  *out << (c.version == MshVersion::v2_2 ? "2.2" : "4.1") << " order " << c.order;
}

class Msh : public testing::TestWithParam<Case> {
 protected:
  TetMesh box() const { return analytic::tetrahedra_of_box({3, 2, 1}, {3, 2, 2}, GetParam().order); }
  void SetUp() override { options_.msh_version = GetParam().version; }
  FileOptions options_;
  TemporaryFolder folder_;
};
INSTANTIATE_TEST_SUITE_P(VersionAndOrder, Msh,
                         testing::Values(Case{MshVersion::v2_2, 1}, Case{MshVersion::v2_2, 2},
                                         Case{MshVersion::v4_1, 1}, Case{MshVersion::v4_1, 2}));

TEST_P(Msh, RoundTrips) {
  TetMesh mesh = box();
  for (Vec3& p : mesh.nodes) p = p / 7 - Vec3(100, 1e-3, 0.1);
  write_msh(mesh, folder_ / "box.msh", options_);
  const TetMesh read = read_volume(folder_ / "box.msh");
  ASSERT_EQ(read.nodes.size(), mesh.nodes.size());
  for (std::size_t n = 0; n < mesh.nodes.size(); ++n)
    EXPECT_LE((read.nodes[n] - mesh.nodes[n]).norm(), 1e-15 * mesh.nodes[n].norm());
  EXPECT_EQ(read.tetrahedra, mesh.tetrahedra);
  EXPECT_EQ(read.mid_edge_nodes, mesh.mid_edge_nodes);
}

TEST_P(Msh, HoldsTheGroupsAndTheVersion) {
  write_msh(box(), folder_ / "box.msh", options_);
  const std::string text = contents(folder_ / "box.msh");
  EXPECT_THAT(text,
              HasSubstr(GetParam().version == MshVersion::v2_2 ? "$MeshFormat\n2.2 0 8\n" : "$MeshFormat\n4.1 0 8\n"));
  EXPECT_THAT(text, HasSubstr("2 1 \"SALL\"\n3 2 \"EALL\"\n"));
}

TEST_P(Msh, IsTheSameFileEveryTime) {
  write_msh(box(), folder_ / "a.msh", options_);
  write_msh(box(), folder_ / "b.msh", options_);
  EXPECT_EQ(contents(folder_ / "a.msh"), contents(folder_ / "b.msh"));
}

TEST(MshWriter, TakesAnExtensionInUpperCase) {
  const TemporaryFolder folder;
  write_msh(analytic::tetrahedra_of_box({1, 1, 1}, {1, 1, 1}, 1), folder / "BOX.MSH");
  EXPECT_EQ(read_volume(folder / "BOX.MSH").tetrahedra.size(), 6U);
}

TEST(MshReader, ReadsBinaryOfBothByteOrders) {
  const TemporaryFolder folder;
  for (const MshVersion version : {MshVersion::v2_2, MshVersion::v4_1})
    for (const std::endian order : {std::endian::little, std::endian::big}) {
      const std::string text = binary_mesh(version, order);
      write_text(folder / "binary.msh", text);
      const TetMesh mesh = read_volume(folder / "binary.msh");
      EXPECT_EQ(mesh.nodes.size(), 4U);
      EXPECT_EQ(mesh.tetrahedra.size(), 1U);
      EXPECT_NEAR(total_volume(mesh), 1.0 / 6, 1e-15);
      for (std::size_t length = 1; length < text.size() - 1; ++length) {
        write_text(folder / "binary.msh", text.substr(0, length));
        EXPECT_THROW(read_volume(folder / "binary.msh"), InvalidInput) << length;
      }
    }
}

TEST(MshReader, SaysWhereAFileIsWrong) {
  const TemporaryFolder folder;
  const auto message = [&](const std::string& text) -> std::string {
    write_text(folder / "bad.msh", text);
    return error_from<InvalidInput>([&] { read_volume(folder / "bad.msh"); }).what();
  };
  const std::string nodes =
      "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n4\n1 0 0 0\n2 1 0 0\n3 0 1 0\n4 0 0 1\n$EndNodes\n$Elements\n1\n";
  const std::string end = "$EndElements\n";
  write_text(folder / "good.msh", nodes + "1 4 2 0 1 1 2 3 4\n" + end);
  EXPECT_NO_THROW(read_volume(folder / "good.msh"));
  EXPECT_THAT(message(nodes + "1 4 2 0 1 1 2 3 5\n" + end), HasSubstr("bad.msh: element 1: element uses node 5"));
  EXPECT_THAT(message(nodes + "1 2 2 0 1 1 2 3\n" + end), HasSubstr("holds no tetrahedra"));
  EXPECT_THAT(message(nodes + "1 5 2 0 1 1 2 3 4 1 2 3 4\n" + end),
              HasSubstr("bad.msh:13: element is not a tetrahedron"));
  EXPECT_THAT(message(nodes + "1 4 2 0 1 1 2 3\n" + end), HasSubstr("bad.msh:14"));
  EXPECT_THAT(message(nodes + "1 4 2 0 1 1 2 3 4\n"), HasSubstr("section has no end"));
  EXPECT_THAT(message("$MeshFormat\n4 0 8\n$EndMeshFormat\n"), HasSubstr("bad.msh:2: a version of MSH"));
  EXPECT_THAT(message("Point(1) = {0, 0, 0};\n"), HasSubstr("not a Gmsh mesh file"));
  EXPECT_THAT(message(""), HasSubstr("empty"));
  EXPECT_THROW(read_msh(folder.path()), InvalidInput);
  EXPECT_THROW(read_volume(folder / "missing.msh"), InvalidInput);
}

}  // namespace
}  // namespace scan2fea
