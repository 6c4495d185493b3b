// Real scans are read as their headers and their makers describe them.
#include "preproc/mesh/read_surface.hpp"
#include "preproc/mesh/write_surface.hpp"
#include "tests/scans.hpp"
#include "tests/temporary_folder.hpp"

#include <gtest/gtest.h>

#include <algorithm>

namespace scan2fea {
namespace {

// Edges, each with its direction, that no other triangle runs along the other way.
std::size_t border_edges(const SurfaceMesh& mesh) {
  std::vector<std::pair<std::uint32_t, std::uint32_t>> edges;
  for (const Triangle& t : mesh.triangles)
    for (std::size_t k = 0; k < 3; ++k) edges.emplace_back(t[k], t[(k + 1) % 3]);
  std::ranges::sort(edges);
  return static_cast<std::size_t>(std::ranges::count_if(
      edges, [&](const auto& edge) { return !std::ranges::binary_search(edges, std::pair(edge.second, edge.first)); }));
}

#define READ_OR_SKIP(mesh, name)                                                                \
  const auto scan = find_scan(name);                                                            \
  if (!scan) GTEST_SKIP() << "no " << name << "; set SCAN2FEA_DATA to the folder of the scans"; \
  const SurfaceMesh mesh = read_surface(*scan)

TEST(ReadScans, IgeaOfTriangleStripsIsClosed) {
  READ_OR_SKIP(mesh, "igea.ply");
  EXPECT_EQ(mesh.vertices.size(), 134'345u);  // its header
  EXPECT_EQ(border_edges(mesh), 0u);
  EXPECT_GT(enclosed_volume(mesh), 0);  // the strips' turns are right
}

TEST(ReadScans, HorseIsClosed) {
  READ_OR_SKIP(mesh, "horse.ply");
  EXPECT_EQ(mesh.vertices.size(), 48'485u);  // its header
  EXPECT_EQ(mesh.triangles.size(), 96'966u);
  EXPECT_EQ(border_edges(mesh), 0u);
}

TEST(ReadScans, FandiskIsClosed) {
  READ_OR_SKIP(mesh, "fandisk.obj");
  EXPECT_EQ(border_edges(mesh), 0u);
  EXPECT_GT(enclosed_volume(mesh), 0);
}

TEST(ReadScans, BunnyIsOpen) {
  READ_OR_SKIP(mesh, "stanford-bunny.obj");
  EXPECT_EQ(mesh.vertices.size(), 35'947u);
  EXPECT_GT(border_edges(mesh), 0u);
}

TEST(ReadScans, BracketOfTheExamplesIsAClosedPartWithThreeHoles) {
  const std::filesystem::path file = SCAN2FEA_EXAMPLES "/bracket.ply";
  const SurfaceMesh mesh = read_surface(file);
  EXPECT_EQ(border_edges(mesh), 0u);
  EXPECT_EQ(2 * mesh.vertices.size() + 8, mesh.triangles.size());  // Euler's formula for genus 3
  EXPECT_GT(enclosed_volume(mesh), 0);
  EXPECT_LT(std::filesystem::file_size(file), 1'000'000u);
}

TEST(ReadScans, HorseStaysClosedThroughStl) {
  READ_OR_SKIP(horse, "horse.ply");
  const TemporaryFolder folder;
  write_surface(horse, folder / "horse.stl");
  const SurfaceMesh mesh = read_surface(folder / "horse.stl");
  EXPECT_EQ(mesh.triangles.size(), horse.triangles.size());
  EXPECT_EQ(border_edges(mesh), 0u);
}

}  // namespace
}  // namespace scan2fea
