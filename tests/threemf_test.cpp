#include "export/threemf.hpp"

#include "preproc/mesh/error.hpp"
#include "tests/temporary_folder.hpp"

#include <gtest/gtest.h>

#include <cstdlib>

namespace scan2fea {
namespace {

// The standard's way: a cube that the build takes, moved, and a component of it, mirrored.
constexpr const char* model = R"(<?xml version="1.0" encoding="UTF-8"?>
<model unit="inch" xml:lang="en-US" xmlns="http://schemas.microsoft.com/3dmanufacturing/core/2015/02">
<resources>
<object id="1" name="tetrahedron" type="model"><mesh>
<vertices><vertex x="0" y="0" z="0"/><vertex x="1" y="0" z="0"/><vertex x="0" y="1" z="0"/><vertex x="0" y="0" z="1.5e0"/></vertices>
<triangles><triangle v1="0" v2="2" v3="1"/><triangle v1="0" v2="1" v3="3"/><triangle v1="1" v2="2" v3="3"/><triangle v1="2" v2="0" v3="3"/></triangles>
</mesh></object>
<object id="2" type="model"><components>
<component objectid="1"/><component objectid="1" transform="-1 0 0 0 1 0 0 0 1 -5 0 0"/>
</components></object>
</resources>
<build><item objectid="2" transform="1 0 0 0 1 0 0 0 1 10 20 30"/></build>
</model>)";

std::filesystem::path zipped(const TemporaryFolder& folder, const std::string& text, const char* options) {
  std::filesystem::create_directories(folder / "3D");
  write_text(folder / "3D/3dmodel.model", text);
  std::filesystem::remove(folder / "part.3mf");
  const std::string command = "cd '" + folder.path().string() +
                              "' && /usr/bin/python3 -c \"import zipfile; zipfile.ZipFile('part.3mf', 'w', " + options +
                              ").write('3D/3dmodel.model')\"";
  EXPECT_EQ(std::system(command.c_str()), 0);
  return folder / "part.3mf";
}

TEST(ThreeMf, GivesAllThatTheBuildNamesInItsUnit) {
  const TemporaryFolder folder;
  for (const char* options : {"zipfile.ZIP_DEFLATED", "zipfile.ZIP_STORED"}) {
    const MeshFile read = read_3mf(zipped(folder, model, options));
    const auto& surface = std::get<NamedSurface>(read.mesh);
    EXPECT_EQ(surface.unit, "in");
    EXPECT_EQ(surface.mesh.triangles.size(), 8U);
    EXPECT_NEAR(enclosed_volume(surface.mesh), 2 * 0.25, 1e-12) << "the mirrored one is turned round";
    const BoundingBox box = bounding_box(surface.mesh.vertices);
    EXPECT_EQ(box.low, Vec3(4, 20, 30));
    EXPECT_EQ(box.high, Vec3(11, 21, 31.5));
    ASSERT_EQ(surface.face_sets.size(), 1U);
    EXPECT_EQ(surface.face_sets[0].name, "tetrahedron");
    EXPECT_EQ(surface.face_sets[0].members.size(), 8U);
  }
}

TEST(ThreeMf, RefusesWhatHasNoEnd) {
  const TemporaryFolder folder;
  const std::string endless =
      R"(<model><resources><object id="1"><components><component objectid="1"/></components></object></resources>)"
      R"(<build><item objectid="1"/></build></model>)";
  EXPECT_THROW(read_3mf(zipped(folder, endless, "zipfile.ZIP_STORED")), InvalidInput);
  const std::filesystem::path whole = zipped(folder, model, "zipfile.ZIP_DEFLATED");
  const std::string bytes = contents(whole);
  for (std::size_t length = 1; length < bytes.size(); length += 5) {
    write_text(whole, bytes.substr(0, length));
    EXPECT_THROW(read_3mf(whole), InvalidInput) << length;
  }
}

}  // namespace
}  // namespace scan2fea
