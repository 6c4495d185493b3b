#include "export/partition.hpp"

#include "preproc/mesh/element_faces.hpp"
#include "preproc/mesh/error.hpp"
#include "preproc/mesh/union_find.hpp"
#include "tests/error_from.hpp"
#include "tests/part_with_sets.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <set>

namespace scan2fea {
namespace {

std::vector<std::uint32_t> sizes_of(const std::vector<std::uint32_t>& part, std::size_t parts) {
  std::vector<std::uint32_t> sizes(parts, 0);
  for (const std::uint32_t p : part) ++sizes.at(p);
  return sizes;
}

// Into how many pieces, that hang together by faces, the elements of the parts fall.
std::size_t pieces_of(const std::vector<Tetrahedron>& tetrahedra, const std::vector<std::uint32_t>& part) {
  const auto across = element_neighbours(tetrahedra);
  UnionFind pieces(tetrahedra.size());
  for (std::uint32_t t = 0; t < tetrahedra.size(); ++t)
    for (const std::uint32_t other : across[t])
      if (other != no_element && part[other] == part[t]) pieces.unite(t, other);
  std::set<std::uint32_t> roots;
  for (std::uint32_t t = 0; t < tetrahedra.size(); ++t) roots.insert(pieces.find(t));
  return roots.size();
}

// A plate with a round hole.
std::vector<Tetrahedron> frame() {
  const TetMesh box = analytic::tetrahedra_of_box({4, 4, 1}, {20, 20, 5}, 1);
  std::vector<Tetrahedron> left;
  for (const Tetrahedron& t : box.tetrahedra) {
    Vec3 centre = Vec3::Zero();
    for (const std::uint32_t n : t) centre += box.nodes[n] / 4;
    if (std::hypot(centre.x() - 2, centre.y() - 2) > 1.2) left.push_back(t);
  }
  return left;
}

TEST(Partition, PartsAreBalancedAndHangTogether) {
  for (const std::vector<Tetrahedron>& tetrahedra :
       {analytic::tetrahedra_of_box({3, 2, 1}, {15, 10, 8}, 1).tetrahedra,
        analytic::tetrahedra_of_box({100, 2, 1}, {300, 6, 3}, 1).tetrahedra, frame()})
    for (const std::size_t parts : {2U, 3U, 8U, 31U, 100U}) {
      const std::vector<std::uint32_t> part = partition(tetrahedra, parts);
      ASSERT_EQ(part.size(), tetrahedra.size());
      const std::vector<std::uint32_t> sizes = sizes_of(part, parts);
      const double mean = static_cast<double>(tetrahedra.size()) / static_cast<double>(parts);
      EXPECT_GT(std::ranges::min(sizes), 0U);
      EXPECT_LE(std::ranges::max(sizes), std::ceil(largest_part_of_mean * mean)) << parts << " of " << part.size();
      EXPECT_EQ(pieces_of(tetrahedra, part), parts) << part.size();
    }
}

// Far fewer faces lie between parts than between blocks of the given order, or at random.
TEST(Partition, CutsFewFaces) {
  const TetMesh box = analytic::tetrahedra_of_box({1, 1, 1}, {16, 16, 16}, 1);
  const std::vector<std::uint32_t> part = partition(box.tetrahedra, 2);
  const auto across = element_neighbours(box.tetrahedra);
  std::size_t cut = 0;
  for (std::size_t t = 0; t < across.size(); ++t)
    for (const std::uint32_t other : across[t]) cut += other != no_element && part[other] != part[t];
  // A plane through the middle cuts two triangles a cube, counted from both sides.
  EXPECT_LT(static_cast<double>(cut) / 2, 1.5 * 2 * 16 * 16);
}

TEST(Partition, OfBodiesApartIsBalanced) {
  TetMesh two = analytic::tetrahedra_of_box({1, 1, 1}, {6, 6, 6}, 1);
  const auto nodes = static_cast<std::uint32_t>(two.nodes.size());
  const std::size_t of_one = two.tetrahedra.size();
  for (std::size_t t = 0; t < of_one / 2; ++t) {
    Tetrahedron moved = two.tetrahedra[t];
    for (std::uint32_t& n : moved) n += nodes;
    two.tetrahedra.push_back(moved);
  }
  for (const std::size_t parts : {2U, 5U}) {
    const std::vector<std::uint32_t> sizes = sizes_of(partition(two.tetrahedra, parts), parts);
    const double mean = static_cast<double>(two.tetrahedra.size()) / static_cast<double>(parts);
    EXPECT_LE(std::ranges::max(sizes), std::ceil(largest_part_of_mean * mean));
  }
}

TEST(Partition, IsTheSameAgain) {
  const std::vector<Tetrahedron> tetrahedra = frame();
  const std::vector<std::uint32_t> first = partition(tetrahedra, 7);
  std::srand(99);  // of which METIS's random numbers are made
  EXPECT_EQ(partition(tetrahedra, 7), first);
  const int next = std::rand();
  std::srand(99);
  EXPECT_EQ(std::rand(), next) << "the process's random numbers are others than without";
}

TEST(Partition, OfOnePartAndOfAsManyAsElements) {
  const std::vector<Tetrahedron> tetrahedra = analytic::tetrahedra_of_box({1, 1, 1}, {3, 2, 2}, 1).tetrahedra;
  EXPECT_EQ(partition(tetrahedra, 1), std::vector<std::uint32_t>(tetrahedra.size(), 0));
  for (std::size_t parts = 2; parts <= tetrahedra.size(); ++parts) {
    const std::vector<std::uint32_t> sizes = sizes_of(partition(tetrahedra, parts), parts);
    EXPECT_GT(std::ranges::min(sizes), 0U) << parts;
    if (tetrahedra.size() / parts < 16) {
      EXPECT_LE(std::ranges::max(sizes) - std::ranges::min(sizes), 1U) << parts;
    }
  }
  const auto error = error_from<WrongUsage>([&] { partition(tetrahedra, tetrahedra.size() + 1); });
  EXPECT_THAT(error.what(), testing::HasSubstr("more parts than tetrahedra"));
  EXPECT_THAT(error.what(), testing::HasSubstr("(limit: 72)"));
  EXPECT_THROW(partition(tetrahedra, 0), WrongUsage);
}

TEST(Partition, RefusesMoreThanNumbersOf32BitsCount) {
  EXPECT_NO_THROW(require_partition(536870911, 1000));
  const auto error = error_from<WrongUsage>([] { require_partition(536870912, 1000); });
  EXPECT_THAT(error.what(), testing::HasSubstr("536870912 (limit: 536870911)"));
}

class OrderByParts : public testing::TestWithParam<int> {};
INSTANTIATE_TEST_SUITE_P(Order, OrderByParts, testing::Values(1, 2));

TEST_P(OrderByParts, IsTheSameMeshInAnotherOrder) {
  const TetMesh before = analytic::part_with_sets(GetParam(), {8, 4, 2});
  TetMesh mesh = before;
  const std::vector<std::uint32_t> sizes = order_by_parts(mesh, 5);
  EXPECT_EQ(mesh.nodes, before.nodes);
  EXPECT_NE(mesh.tetrahedra, before.tetrahedra);
  const auto sorted = [](auto elements) {
    std::ranges::sort(elements);
    return elements;
  };
  EXPECT_EQ(sorted(mesh.tetrahedra), sorted(before.tetrahedra));
  EXPECT_EQ(sorted(mesh.mid_edge_nodes), sorted(before.mid_edge_nodes));
  EXPECT_NEAR(total_volume(mesh), 8, 1e-12);
  for (std::size_t s = 0; s < mesh.element_sets.size(); ++s) {
    EXPECT_TRUE(std::ranges::is_sorted(mesh.element_sets[s].members));
    EXPECT_NEAR(volume_of(mesh, mesh.element_sets[s].members), 4, 1e-12);
    EXPECT_EQ(mesh.element_sets[s].members.size(), before.element_sets[s].members.size());
  }
  for (std::size_t f = 0; f < mesh.boundary.size(); ++f)
    EXPECT_EQ(boundary_triangle(mesh, mesh.boundary[f]), boundary_triangle(before, before.boundary[f]));

  const std::vector<MeshPart> parts = parts_of(mesh, sizes);
  ASSERT_EQ(parts.size(), 5U);
  std::size_t elements = 0, faces = 0;
  std::vector<int> times(mesh.nodes.size(), 0);
  for (const MeshPart& part : parts) {
    EXPECT_EQ(part.first_element, elements);
    elements += part.elements;
    faces += part.faces.size();
    for (const std::uint32_t n : part.nodes) ++times[n];
    for (const std::uint32_t f : part.faces) {
      EXPECT_GE(mesh.boundary[f].tetrahedron, part.first_element);
      EXPECT_LT(mesh.boundary[f].tetrahedron, elements);
    }
  }
  EXPECT_EQ(elements, mesh.tetrahedra.size());
  EXPECT_EQ(faces, mesh.boundary.size());
  EXPECT_EQ(std::ranges::count(times, 0), 0);
  EXPECT_EQ(shared_nodes(mesh.nodes.size(), parts),
            static_cast<std::size_t>(std::ranges::count_if(times, [](int t) { return t > 1; })));
  EXPECT_THROW(parts_of(mesh, std::vector<std::uint32_t>{1, 2}), WrongUsage);
}

}  // namespace
}  // namespace scan2fea
