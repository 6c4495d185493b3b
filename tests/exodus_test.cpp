#include "export/exodus.hpp"

#include "export/netcdf.hpp"
#include "preproc/mesh/error.hpp"
#include "tests/error_from.hpp"
#include "tests/part_with_sets.hpp"
#include "tests/temporary_folder.hpp"

#include <gmock/gmock.h>

#include <cstdlib>
#include <fstream>

namespace scan2fea {
namespace {

using testing::HasSubstr;

// What netCDF's own library would make of them is told by other_readers_test.
TEST(Netcdf, IsReadBackAsItWasWritten) {
  const TemporaryFolder folder;
  NetcdfWriter writer;
  const std::size_t three = writer.dimension("three", 3), row = writer.dimension("row", 5),
                    time = writer.dimension("time", 0);
  writer.attribute({"title", std::string("odd")});
  writer.variable("time", {time}, std::vector<double>{});
  writer.variable("names", {three, row}, std::string("ab\0\0\0cd   efghi", 15));
  writer.variable("reals", {three}, std::vector<double>{1.5, -2, 1e300}, {{"elem_type", std::string("TET")}});
  writer.variable("integers", {three}, std::vector<std::int32_t>{7, -1, 2147483647});
  {
    std::ofstream file(folder / "part.nc", std::ios::binary);
    writer.write(file);
  }
  const InputFile file(folder / "part.nc");
  const NetcdfReader reader(file);
  EXPECT_EQ(reader.dimension("three"), 3U);
  EXPECT_EQ(reader.dimension("four"), std::nullopt);
  EXPECT_THAT(reader.rows("names"), testing::ElementsAre("ab", "cd", "efghi"));
  EXPECT_THAT(reader.reals("reals"), testing::ElementsAre(1.5, -2, 1e300));
  EXPECT_THAT(reader.integers("integers"), testing::ElementsAre(7, -1, 2147483647));
  EXPECT_THAT(reader.reals("integers"), testing::ElementsAre(7, -1, 2147483647));
  EXPECT_EQ(reader.text_attribute("reals", "elem_type"), "TET");
  EXPECT_EQ(reader.shape("time"), std::nullopt) << "records are not read";
  EXPECT_THROW(reader.integers("reals"), InvalidInput);
}

TEST(Exodus, KeepsTheOrderOfElementsAcrossBlocks) {
  const TemporaryFolder folder;
  TetMesh mesh = analytic::part_with_sets(1);
  std::vector<std::uint32_t> even, odd;  // as mixed as can be
  for (std::uint32_t t = 0; t < mesh.tetrahedra.size(); ++t) (t % 2 == 0 ? even : odd).push_back(t);
  odd.pop_back();  // in no body
  mesh.element_sets = {named_set("EVEN", even), named_set("ODD", odd), named_set("BOTH", {0, 1, 2})};
  EXPECT_EQ(write_exodus(mesh, folder / "part.exo"), Notes{});
  const MeshFile read = read_exodus(folder / "part.exo");
  const auto& found = std::get<TetMesh>(read.mesh);
  EXPECT_EQ(found.tetrahedra, mesh.tetrahedra);
  EXPECT_EQ(found.element_sets, mesh.element_sets);
  EXPECT_EQ(found.node_sets, mesh.node_sets);
  EXPECT_EQ(found.unit, "mm");
  EXPECT_TRUE(read.warnings.empty());
}

TEST(Exodus, TellsWhatIsNotRead) {
  const TemporaryFolder folder;
  const auto error_of = [&](const std::string& bytes) {
    return std::string(error_from<InvalidInput>([&] { read_exodus(write_text(folder / "part.exo", bytes)); }).what());
  };
  EXPECT_THAT(error_of("\x89HDF\r\n\x1a\n"), HasSubstr("nccopy"));
  EXPECT_THAT(error_of("solid of a CAD program"), HasSubstr("not netCDF"));
  EXPECT_THAT(error_of("CDF\x02"), HasSubstr("ends inside its header"));
  write_exodus(analytic::part_with_sets(2), folder / "whole.exo");
  const std::string whole = contents(folder / "whole.exo");
  EXPECT_THAT(error_of(whole.substr(0, whole.size() / 2)), HasSubstr("promises more values"));
  std::string hexahedra = whole;
  for (std::size_t at = 0; (at = hexahedra.find("TETRA10", at)) != std::string::npos;)
    hexahedra.replace(at, 7, "HEX8\0\0\0", 7);
  EXPECT_THAT(error_of(hexahedra), HasSubstr("no tetrahedra of 4 or 10 nodes"));
}

// Made by netCDF's library, without names and maps, in one of its versions: as other programs write.
TEST(Exodus, OfOthersIsRead) {
  const TemporaryFolder folder;
  for (const std::string version : {"NETCDF3_CLASSIC", "NETCDF3_64BIT_OFFSET", "NETCDF3_64BIT_DATA", "NETCDF4"}) {
    const std::string script =
        "import netCDF4\n"
        "f = netCDF4.Dataset('" +
        (folder / "other.e").string() + "', 'w', format='" + version +
        "')\n"
        "for name, size in (('num_nodes', 5), ('num_dim', 3), ('num_elem', 2), ('num_el_blk', 2), ('a', 1), ('b', 4),\n"
        "                   ('num_side_sets', 1)):\n"
        "    f.createDimension(name, size)\n"
        "f.createVariable('coord', 'f8', ('num_dim', 'num_nodes'))[:] = [[0, 1, 0, 0, 1], [0, 0, 1, 0, 1], [0, 0, 0, "
        "1, 1]]\n"
        "for name, nodes in (('connect1', [1, 2, 3, 4]), ('connect2', [2, 3, 4, 5])):\n"
        "    v = f.createVariable(name, 'i4', ('a', 'b'))\n"
        "    v.elem_type = 'tetra4'\n"
        "    v[:] = [nodes]\n"
        "f.createVariable('eb_prop1', 'i4', ('num_el_blk',))[:] = [10, 20]\n"
        "f.createVariable('ss_prop1', 'i4', ('num_side_sets',))[:] = [7]\n"
        "f.createVariable('elem_ss1', 'i4', ('a',))[:] = [1]\n"
        "f.createVariable('side_ss1', 'i4', ('a',))[:] = [4]\n";  // 132 of the first, in the plane z = 0
    write_text(folder / "make.py", script);
    const int status = std::system(("/usr/bin/python3 '" + (folder / "make.py").string() + "' 2> /dev/null").c_str());
    if (status != 0) GTEST_SKIP() << "python3-netcdf4 is not installed";
    if (version == "NETCDF4") {
      EXPECT_THAT(error_from<InvalidInput>([&] { read_exodus(folder / "other.e"); }).what(), HasSubstr("nccopy"));
      continue;
    }
    const MeshFile read = read_exodus(folder / "other.e");
    const auto& mesh = std::get<TetMesh>(read.mesh);
    EXPECT_NEAR(total_volume(mesh), 0.5, 1e-12) << version;
    ASSERT_EQ(mesh.element_sets.size(), 2U);
    EXPECT_EQ(mesh.element_sets[1], named_set("block_20", {1}));
    ASSERT_EQ(mesh.face_sets.size(), 1U);
    EXPECT_EQ(mesh.face_sets[0].name, "side_set_7");
    ASSERT_EQ(mesh.face_sets[0].members.size(), 1U);
    for (const std::uint32_t n : boundary_triangle(mesh, mesh.boundary[mesh.face_sets[0].members[0]]))
      EXPECT_EQ(mesh.nodes[n].z(), 0);
  }
}

}  // namespace
}  // namespace scan2fea
