#include "export/msh.hpp"

#include "preproc/mesh/error.hpp"
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

class Msh : public testing::TestWithParam<Case> {
 protected:
  TetMesh box() const { return analytic::tetrahedra_of_box({3, 2, 1}, {3, 2, 2}, GetParam().order); }
  TemporaryFolder folder_;
};
INSTANTIATE_TEST_SUITE_P(VersionAndOrder, Msh,
                         testing::Values(Case{MshVersion::v2_2, 1}, Case{MshVersion::v2_2, 2},
                                         Case{MshVersion::v4_1, 1}, Case{MshVersion::v4_1, 2}));

TEST_P(Msh, RoundTrips) {
  TetMesh mesh = box();
  for (Vec3& p : mesh.nodes) p = p / 7 - Vec3(100, 1e-3, 0.1);
  write_msh(mesh, folder_ / "box.msh", {.version = GetParam().version});
  const TetMesh read = read_msh(folder_ / "box.msh");
  ASSERT_EQ(read.nodes.size(), mesh.nodes.size());
  for (std::size_t n = 0; n < mesh.nodes.size(); ++n)
    EXPECT_LE((read.nodes[n] - mesh.nodes[n]).norm(), 1e-15 * mesh.nodes[n].norm());
  EXPECT_EQ(read.tetrahedra, mesh.tetrahedra);
  EXPECT_EQ(read.mid_edge_nodes, mesh.mid_edge_nodes);
}

TEST_P(Msh, HoldsTheGroupsAndTheVersion) {
  write_msh(box(), folder_ / "box.msh", {.version = GetParam().version});
  const std::string text = contents(folder_ / "box.msh");
  EXPECT_THAT(text,
              HasSubstr(GetParam().version == MshVersion::v2_2 ? "$MeshFormat\n2.2 0 8\n" : "$MeshFormat\n4.1 0 8\n"));
  EXPECT_THAT(text, HasSubstr("2 1 \"SALL\"\n3 2 \"EALL\"\n"));
}

TEST_P(Msh, IsTheSameFileEveryTime) {
  write_msh(box(), folder_ / "a.msh", {.version = GetParam().version});
  write_msh(box(), folder_ / "b.msh", {.version = GetParam().version});
  EXPECT_EQ(contents(folder_ / "a.msh"), contents(folder_ / "b.msh"));
}

TEST(MshWriter, TakesAnExtensionInUpperCase) {
  const TemporaryFolder folder;
  write_msh(analytic::tetrahedra_of_box({1, 1, 1}, {1, 1, 1}, 1), folder / "BOX.MSH");
  EXPECT_EQ(read_msh(folder / "BOX.MSH").tetrahedra.size(), 6U);
}

TEST(MshReader, RunsNoScripts) {
  const TemporaryFolder folder;
  const std::string script = "SystemCall \"touch " + (folder / "ran").string() + "\";\n";
  write_text(folder / "script.msh", script);
  EXPECT_THROW(read_msh(folder / "script.msh"), InvalidInput);
  write_msh(analytic::tetrahedra_of_box({1, 1, 1}, {1, 1, 1}, 1), folder / "box.msh");
  write_text(folder / "box.msh.opt", script);
  EXPECT_EQ(read_msh(folder / "box.msh").tetrahedra.size(), 6U);
  EXPECT_FALSE(std::filesystem::exists(folder / "ran"));
}

TEST(MshReader, RefusesWhatIsNotATetrahedralMesh) {
  const TemporaryFolder folder;
  write_text(folder / "empty.msh", "");
  EXPECT_THROW(read_msh(folder / "empty.msh"), InvalidInput);
  EXPECT_THROW(read_msh(folder.path()), InvalidInput);
  EXPECT_THROW(read_msh(folder / "missing.msh"), InvalidInput);
  write_text(folder / "triangle.msh",
             "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n3\n1 0 0 0\n2 1 0 0\n3 0 1 0\n$EndNodes\n"
             "$Elements\n1\n1 2 2 0 1 1 2 3\n$EndElements\n");
  EXPECT_THROW(read_msh(folder / "triangle.msh"), InvalidInput);
}

}  // namespace
}  // namespace scan2fea
