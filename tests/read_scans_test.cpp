// Real scans are read as their headers and Euler's formula describe them.
#include "preproc/mesh/read_surface.hpp"
#include "preproc/mesh/write_surface.hpp"
#include "tests/scans.hpp"
#include "tests/temporary_folder.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <map>
#include <set>

namespace scan2fea {
namespace {

using Edge = std::pair<std::uint32_t, std::uint32_t>;

// Edges, each with its direction, that no other triangle runs along the other way.
std::vector<Edge> border_edges(const SurfaceMesh& mesh) {
  std::set<Edge> edges;
  for (const Triangle& t : mesh.triangles)
    for (std::size_t k = 0; k < 3; ++k) edges.emplace(t[k], t[(k + 1) % 3]);
  std::vector<Edge> border;
  std::ranges::copy_if(edges, std::back_inserter(border), [&](const Edge& edge) {
    return !edges.contains({edge.second, edge.first});
  });
  return border;
}

// How many rings the border consists of. No two of them share a vertex.
std::size_t count_rings(const std::vector<Edge>& border) {
  std::map<std::uint32_t, std::uint32_t> next(border.begin(), border.end());
  EXPECT_EQ(next.size(), border.size());
  std::size_t rings = 0;
  for (; !next.empty(); ++rings)
    for (auto edge = next.begin(); edge != next.end();) {
      const std::uint32_t end = edge->second;
      next.erase(edge);
      edge = next.find(end);
    }
  return rings;
}

struct Header {
  std::string magic;
  std::size_t vertices = 0, faces = 0;
};

Header read_header(const std::filesystem::path& off_file) {
  Header header;
  std::ifstream(off_file) >> header.magic >> header.vertices >> header.faces;
  return header;
}

// A connected surface of the given number of handles, none of which the reader may add or lose.
void expect_as_header_says(const SurfaceMesh& mesh, const std::string& name, std::size_t handles, std::size_t holes) {
  const Header header = read_header(scan(name));
  EXPECT_EQ(mesh.vertices.size(), header.vertices);
  EXPECT_EQ(mesh.triangles.size(), header.faces);
  const std::vector<Edge> border = border_edges(mesh);
  EXPECT_EQ(count_rings(border), holes);
  // Euler's formula, V - E + F = 2 - 2 * handles - holes, with E = (3 F + border) / 2 and all of it doubled.
  EXPECT_EQ(2 * header.vertices + 4 * handles + 2 * holes, header.faces + border.size() + 4);
}

// Triangle strips as scanners' software writes them: one list of all, -1 between two strips.
void write_strips(const SurfaceMesh& mesh, const std::filesystem::path& file) {
  std::map<Edge, std::size_t> face_at;
  for (std::size_t f = 0; f < mesh.triangles.size(); ++f)
    for (std::size_t k = 0; k < 3; ++k) face_at[{mesh.triangles[f][k], mesh.triangles[f][(k + 1) % 3]}] = f;
  std::vector<bool> written(mesh.triangles.size(), false);
  std::vector<std::int32_t> list;
  for (std::size_t start = 0; start < mesh.triangles.size(); ++start) {
    if (written[start]) continue;
    if (!list.empty()) list.push_back(-1);
    auto [a, b, c] = mesh.triangles[start];
    list.insert(list.end(), {std::int32_t(a), std::int32_t(b)});
    bool turned = false;  // every other triangle of a strip lies the other way round
    for (auto next = face_at.find({a, b}); next != face_at.end() && !written[next->second]; turned = !turned) {
      const Triangle& t = mesh.triangles[next->second];
      written[next->second] = true;
      c = *std::ranges::find_if(t, [&](std::uint32_t v) { return v != a && v != b; });
      list.push_back(std::int32_t(c));
      a = b, b = c;
      next = face_at.find(turned ? Edge(a, b) : Edge(b, a));
    }
  }
  std::ofstream out(file, std::ios::binary);
  out << "ply\nformat binary_little_endian 1.0\nelement vertex " << mesh.vertices.size()
      << "\nproperty double x\nproperty double y\nproperty double z\n"
         "element tristrips 1\nproperty list int int vertex_indices\nend_header\n";
  const auto put = [&](const auto& value) { out.write(reinterpret_cast<const char*>(&value), sizeof value); };
  for (const Vec3& p : mesh.vertices)
    for (const double coordinate : p) put(coordinate);
  put(std::int32_t(list.size()));
  for (const std::int32_t v : list) put(v);
}

// Each triangle from its smallest corner on, in order.
std::vector<Triangle> sorted(std::vector<Triangle> triangles) {
  for (Triangle& t : triangles) std::ranges::rotate(t, std::ranges::min_element(t));
  std::ranges::sort(triangles);
  return triangles;
}

TEST(ReadScans, LargeScanIsClosed) {
  const SurfaceMesh mesh = read_surface(scan("bunny00.off"));
  expect_as_header_says(mesh, "bunny00.off", 0, 0);
  EXPECT_GT(enclosed_volume(mesh), 0);
}

TEST(ReadScans, ScanWithThreeHandlesIsClosed) {
  const SurfaceMesh mesh = read_surface(scan("refined_elephant.off"));
  expect_as_header_says(mesh, "refined_elephant.off", 3, 0);
  EXPECT_GT(enclosed_volume(mesh), 0);
}

TEST(ReadScans, PartWithCreasesIsClosed) {
  const SurfaceMesh mesh = read_surface(scan("fandisk.off"));
  expect_as_header_says(mesh, "fandisk.off", 0, 0);
  EXPECT_GT(enclosed_volume(mesh), 0);
}

TEST(ReadScans, LionHasFiveHoles) {
  expect_as_header_says(read_surface(scan("lion.off")), "lion.off", 0, 5);
}

TEST(ReadScans, TriangleStripsAreTheirTriangles) {
  for (const char* name : {"armadillo.off", "lion.off"}) {
    const SurfaceMesh mesh = read_surface(scan(name));
    const TemporaryFolder folder;
    write_strips(mesh, folder / "strips.ply");
    const SurfaceMesh read = read_surface(folder / "strips.ply");
    EXPECT_EQ(read.vertices, mesh.vertices);
    EXPECT_EQ(sorted(read.triangles), sorted(mesh.triangles));  // the strips' turns are right
  }
}

TEST(ReadScans, BracketOfTheExamplesIsAClosedPartWithThreeHoles) {
  const std::filesystem::path file = SCAN2FEA_EXAMPLES "/bracket.ply";
  const SurfaceMesh mesh = read_surface(file);
  EXPECT_TRUE(border_edges(mesh).empty());
  EXPECT_EQ(2 * mesh.vertices.size() + 8, mesh.triangles.size());  // Euler's formula for genus 3
  EXPECT_GT(enclosed_volume(mesh), 0);
  EXPECT_LT(std::filesystem::file_size(file), 1'000'000u);
}

TEST(ReadScans, ScanStaysClosedThroughStl) {
  const SurfaceMesh scanned = read_surface(scan("bunny00.off"));
  const TemporaryFolder folder;
  write_surface(scanned, folder / "bunny.stl");
  const SurfaceMesh mesh = read_surface(folder / "bunny.stl");
  EXPECT_EQ(mesh.triangles.size(), scanned.triangles.size());
  EXPECT_TRUE(border_edges(mesh).empty());
}

}  // namespace
}  // namespace scan2fea
