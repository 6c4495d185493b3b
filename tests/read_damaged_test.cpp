// Whatever happened to a file on its way, reading it ends in InvalidInput or in a mesh that can be worked on.
#include "preproc/mesh/error.hpp"
#include "preproc/mesh/read_surface.hpp"
#include "preproc/mesh/write_surface.hpp"
#include "tests/analytic_meshes.hpp"
#include "tests/temporary_folder.hpp"

#include <gtest/gtest.h>

#include <cctype>
#include <random>

namespace scan2fea {
namespace {

class ReadDamaged : public testing::TestWithParam<const char*> {
 protected:
  std::string whole_file() const {
    const std::string name = GetParam();
    if (name == "ascii.stl")
      return "solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\nendfacet\n"
             "facet normal 0 0 1\nouter loop\nvertex 1 0 0\nvertex 1 1 0\nvertex 0 1 0\nendloop\nendfacet\nendsolid\n";
    if (name == "ascii.ply")
      return "ply\nformat ascii 1.0\nelement vertex 5\nproperty float x\nproperty float y\nproperty float z\n"
             "property list uchar int ring\nelement face 2\nproperty list uchar int vertex_indices\nelement tristrips "
             "1\n"
             "property list int int vertex_indices\nend_header\n0 0 0 1 7\n1 0 0 0\n0 1 0 2 1 1\n0 0 1 0\n1 1 1 0\n"
             "4 0 2 1 3\n3 0 1 3\n5 0 1 2 3 -1\n";
    if (name == "forms.obj")
      return "# forms\nv 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nv 1 1 1\ng a\nf 1/2/3 2//1 \\\n 3\nf -1 -2 -3 -4\nf 1 2 3 4 "
             "5\n";
    if (name == "forms.off")
      return "COFF 5 2 0\n0 0 0 1\n1 0 0 1\n# c\n0 1 0\n0 0 1\n1 1 1\n3 0 1 2 255\n5 0 1 2 3 4\n";
    write_surface(analytic::sphere(1, 0), folder_ / name);
    return contents(folder_ / name);
  }

  void read(const std::string& content) const {
    try {
      const SurfaceMesh mesh = read_surface(write_text(folder_ / GetParam(), content));
      ASSERT_FALSE(mesh.triangles.empty());
      for (const Vec3& p : mesh.vertices) ASSERT_TRUE(p.allFinite());
      for (const Triangle& t : mesh.triangles)
        for (const std::uint32_t v : t) ASSERT_LT(v, mesh.vertices.size());
    } catch (const InvalidInput& error) {
      ASSERT_FALSE(error.parts().what.empty());
      ASSERT_FALSE(error.parts().where.empty());
    }
  }

  TemporaryFolder folder_;
};

TEST_P(ReadDamaged, Truncated) {
  const std::string whole = whole_file();
  for (std::size_t size = 0; size < whole.size(); ++size) ASSERT_NO_FATAL_FAILURE(read(whole.substr(0, size))) << size;
}

TEST_P(ReadDamaged, BytesChanged) {
  const std::string whole = whole_file();
  std::mt19937 generator(1);
  const auto any = [&](std::size_t count) {
    return std::uniform_int_distribution<std::size_t>(0, count - 1)(generator);
  };
  // Bytes that mean something to some reader are worth more than any.
  const std::string telling = std::string("\0\xff\x7f\x80", 4) + "0123456789-+.eE/\\# \t\r\nvfn";
  for (int round = 0; round < 2000; ++round) {
    std::string damaged = whole;
    for (std::size_t change = 0; change <= any(4); ++change) {
      const std::size_t at = any(damaged.size());
      switch (any(4)) {
        case 0:
          damaged[at] = static_cast<char>(any(256));
          break;
        case 1:
          damaged[at] = telling[any(telling.size())];
          break;
        case 2:
          damaged.insert(at, 1, telling[any(telling.size())]);
          break;
        default:
          if (damaged.size() > 1) damaged.erase(at, 1);
      }
    }
    ASSERT_NO_FATAL_FAILURE(read(damaged)) << "round " << round;
  }
}

TEST_P(ReadDamaged, PiecesMixed) {
  const std::string whole = whole_file();
  std::mt19937 generator(2);
  const auto any = [&](std::size_t count) {
    return std::uniform_int_distribution<std::size_t>(0, count - 1)(generator);
  };
  for (int round = 0; round < 500; ++round) {
    std::string damaged = whole;
    const std::string piece = whole.substr(any(whole.size()), any(100));
    damaged.replace(any(damaged.size()), any(100), piece);
    ASSERT_NO_FATAL_FAILURE(read(damaged)) << "round " << round;
  }
}

INSTANTIATE_TEST_SUITE_P(Files, ReadDamaged,
                         testing::Values("ascii.stl", "binary.stl", "forms.obj", "ascii.ply", "binary.ply",
                                         "forms.off"),
                         [](const auto& test) {
                           std::string name = test.param;
                           std::erase_if(name, [](unsigned char c) { return !std::isalnum(c); });
                           return name;
                         });

}  // namespace
}  // namespace scan2fea
