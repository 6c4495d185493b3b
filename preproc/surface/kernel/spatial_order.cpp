#include "preproc/surface/kernel/spatial_order.hpp"

#include "preproc/mesh/morton_code.hpp"
#include "preproc/surface/kernel/parallel_blocks.hpp"

#include <algorithm>

namespace scan2fea {
namespace {

// Calls act(first, last) on each range of items of the same key.
template <class Item, class Key, class Act>
void for_equal(std::vector<Item>& items, const Key& key, const Act& act) {
  for (auto first = items.begin(); first != items.end();) {
    const auto last = std::find_if(first + 1, items.end(), [&](const Item& i) { return key(i) != key(*first); });
    if (last - first > 1) act(first, last);
    first = last;
  }
}

// The vertices in Morton order, those of a cell by their coordinates, by two passes of counting sort over 15 bits each.
std::vector<std::uint32_t> morton_order(const std::vector<Vec3>& points) {
  const BoundingBox box = bounding_box(points);
  const double extent = (box.high - box.low).maxCoeff();
  const double scale = extent > 0 ? 1023.0 / extent : 0.0;
  std::vector<std::uint32_t> key(points.size());
  for_each_block(points.size(), [&](std::size_t first, std::size_t last) {
    for (std::size_t v = first; v < last; ++v) {
      const Vec3 at = (points[v] - box.low) * scale;
      key[v] = static_cast<std::uint32_t>(  // of 30 bits, ten per axis
          morton_code(static_cast<std::uint32_t>(at[0]), static_cast<std::uint32_t>(at[1]),
                      static_cast<std::uint32_t>(at[2])));
    }
  });
  std::vector<std::uint32_t> order(points.size()), sorted(points.size());
  for (std::uint32_t v = 0; v < order.size(); ++v) order[v] = v;
  constexpr std::uint32_t bits = 15, mask = (1U << bits) - 1;
  for (std::uint32_t shift = 0; shift < 2 * bits; shift += bits) {
    std::vector<std::uint32_t> start(mask + 2, 0);
    for (const std::uint32_t k : key) ++start[((k >> shift) & mask) + 1];
    for (std::size_t i = 1; i < start.size(); ++i) start[i] += start[i - 1];
    for (const std::uint32_t v : order) sorted[start[(key[v] >> shift) & mask]++] = v;
    order.swap(sorted);
  }
  const auto before = [&](std::uint32_t a, std::uint32_t b) {
    return std::ranges::lexicographical_compare(points[a], points[b]);
  };
  for_equal(
      order, [&](std::uint32_t v) { return key[v]; },
      [&](auto first, auto last) { std::stable_sort(first, last, before); });
  return order;
}

// By the smallest of their vertices, which is a counting sort and becomes the first, then by the others.
void order_triangles(SurfaceMesh& mesh) {
  for (Triangle& t : mesh.triangles) std::rotate(t.begin(), std::min_element(t.begin(), t.end()), t.end());
  const auto key = [](const Triangle& t) { return t[0]; };
  std::vector<std::uint32_t> start(mesh.vertices.size() + 1, 0);
  for (const Triangle& t : mesh.triangles) ++start[key(t) + 1];
  for (std::size_t v = 0; v < mesh.vertices.size(); ++v) start[v + 1] += start[v];
  std::vector<Triangle> sorted(mesh.triangles.size());
  for (const Triangle& t : mesh.triangles) sorted[start[key(t)]++] = t;
  for_equal(sorted, key, [](auto first, auto last) { std::sort(first, last); });
  mesh.triangles = std::move(sorted);
}

}  // namespace

std::vector<std::uint32_t> order_along_curve(SurfaceMesh& mesh) {
  const std::vector<std::uint32_t> order = morton_order(mesh.vertices);
  std::vector<std::uint32_t> place(order.size());
  std::vector<Vec3> vertices(order.size());
  for_each_block(order.size(), [&](std::size_t first, std::size_t last) {
    for (std::size_t i = first; i < last; ++i) {
      place[order[i]] = static_cast<std::uint32_t>(i);
      vertices[i] = mesh.vertices[order[i]];
    }
  });
  mesh.vertices = std::move(vertices);
  for_each_block(mesh.triangles.size(), [&](std::size_t first, std::size_t last) {
    for (std::size_t f = first; f < last; ++f)
      for (std::uint32_t& v : mesh.triangles[f]) v = place[v];
  });
  order_triangles(mesh);
  return place;
}

}  // namespace scan2fea
