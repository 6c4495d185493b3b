#include "export/formats.hpp"

#include "preproc/mesh/error.hpp"
#include "tests/error_from.hpp"
#include "tests/structured_tets.hpp"
#include "tests/temporary_folder.hpp"

#include <gmock/gmock.h>

namespace scan2fea {
namespace {

TEST(Formats, AreToldByTheExtensionInAnyCase) {
  EXPECT_EQ(find_format("a/part.inp")->extension, ".inp");
  EXPECT_EQ(find_format("PART.VTU")->extension, ".vtu");
  EXPECT_EQ(find_format("part.old.msh")->extension, ".msh");
  EXPECT_EQ(find_format("part.xyz"), nullptr);
  EXPECT_EQ(find_format("inp"), nullptr);
  EXPECT_FALSE(writes_volume("part.stl"));
  EXPECT_TRUE(writes_surface("part.stl"));
}

TEST(Formats, AllCarryTheSameMesh) {
  const TemporaryFolder folder;
  const TetMesh mesh = analytic::tetrahedra_of_box({3, 2, 1}, {3, 2, 2}, 2);
  for (const char* name : {"box.inp", "box.msh", "box.vtu"}) {
    write_volume(mesh, folder / name);
    const TetMesh read = read_volume(folder / name);
    EXPECT_EQ(read.tetrahedra, mesh.tetrahedra) << name;
    EXPECT_EQ(read.mid_edge_nodes, mesh.mid_edge_nodes) << name;
    EXPECT_NEAR(total_volume(read), 6, 1e-12) << name;
  }
}

TEST(Formats, AnUnknownExtensionIsWrongUsageThatListsTheKnown) {
  const TemporaryFolder folder;
  const TetMesh mesh = analytic::tetrahedra_of_box({1, 1, 1}, {1, 1, 1}, 1);
  EXPECT_THAT(error_from<WrongUsage>([&] { write_volume(mesh, folder / "box.xyz"); }).what(),
              ::testing::HasSubstr(".inp (Abaqus, CalculiX)"));
  EXPECT_THROW(read_volume(folder / "box.xyz"), WrongUsage);
}

// XDMF has the facets of part.xdmf in part_facets.xdmf, which can be a mesh that has nothing to do with it.
TEST(Formats, AMeshNamedAsFacetsIsNotPutOnTopOfAnother) {
  const TemporaryFolder folder;
  const TetMesh mesh = analytic::tetrahedra_of_box({1, 1, 1}, {1, 1, 1}, 1);
  write_volume(mesh, folder / "part.xdmf");
  write_volume(mesh, folder / "part_facets.xdmf");
  EXPECT_THAT(error_from<InvalidInput>([&] { read_volume(folder / "part.xdmf"); }).what(),
              ::testing::HasSubstr("are not triangles"));
  EXPECT_EQ(read_volume(folder / "part_facets.xdmf").tetrahedra, mesh.tetrahedra);
}

TEST(Formats, AFailureLeavesAnExistingFile) {
  const TemporaryFolder folder;
  const TetMesh mesh = analytic::tetrahedra_of_box({1, 1, 1}, {1, 1, 1}, 1);
  for (const char* name : {"box.inp", "box.msh", "box.vtu"})
    EXPECT_THROW(write_volume(mesh, folder / "missing" / name), IoError) << name;
  EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
}

TEST(Formats, WarnsOfElementsThatCalculixRefuses) {
  const TemporaryFolder folder;
  TetMesh mesh = analytic::tetrahedra_of_box({1, 1, 1}, {1, 1, 1}, 1);
  EXPECT_TRUE(write_volume(mesh, folder / "good.inp").empty());
  std::swap(mesh.tetrahedra[2][0], mesh.tetrahedra[2][1]);
  const auto warnings = write_volume(mesh, folder / "inverted.inp");
  ASSERT_EQ(warnings.size(), 1U);
  EXPECT_THAT(warnings.front(), ::testing::HasSubstr("CalculiX will refuse element 3: Jacobian determinant -1 "));
}

}  // namespace
}  // namespace scan2fea
