#include "tests/fuzz/soup_of_bytes.hpp"

#include <array>
#include <cmath>
#include <initializer_list>

namespace scan2fea::fuzz {
namespace {

class Soup {
 public:
  explicit Soup(Bytes& bytes) : bytes_(bytes) {}

  SurfaceMesh build() {
    // Bodies are what makes a soup interesting; what happens to them comes after.
    while (!bytes_.empty() && mesh_.triangles.size() < most_triangles) step(bytes_.below(16));
    if (as_float_) round_to_float();
    return std::move(mesh_);
  }

 private:
  void step(std::size_t kind) {
    switch (kind) {
      case 0:
      case 1:
        return add_box();
      case 2:
        return add_cone(2 + bytes_.below(4));
      case 3:
        return add_body({grid(), grid(), grid(), grid()}, {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {0, 3, 2}});
      case 4:
        return add_body({grid(), grid(), grid()}, {{0, 1, 2}});
      case 5:
        as_float_ = true;
        return;
      default:
        if (!mesh_.triangles.empty()) damage(kind);
    }
  }

  void damage(std::size_t kind) {
    const std::size_t f = bytes_.below(mesh_.triangles.size());
    Triangle& t = mesh_.triangles[f];
    switch (kind) {
      case 6:
        mesh_.triangles.erase(mesh_.triangles.begin() + static_cast<std::ptrdiff_t>(f));
        return;
      case 7:
        std::swap(t[0], t[1]);
        return;
      case 8:  // the same face again, of the same vertices
        mesh_.triangles.push_back(Triangle(t));
        return;
      case 9:  // a face torn off the others
        for (std::uint32_t& v : t) v = add_vertex(mesh_.vertices[v]);
        return;
      case 10:  // one corner torn off, and moved
        t[0] = add_vertex(mesh_.vertices[t[0]] + noise());
        return;
      case 11:
        mesh_.vertices[t[0]] += noise();
        return;
      case 12:  // a vertex on an edge, used on one side only
        return split(f, 0.5 * (mesh_.vertices[t[0]] + mesh_.vertices[t[1]]));
      case 13:
        return split(f, 0.5 * (mesh_.vertices[t[0]] + mesh_.vertices[t[1]]) + noise());
      case 14:  // a corner put onto that of another face
        t[0] = mesh_.triangles[bytes_.below(mesh_.triangles.size())][0];
        return;
      default:
        mesh_.vertices[t[0]] = grid();
    }
  }

  void split(std::size_t f, const Vec3& place) {
    const std::uint32_t v = add_vertex(place);
    const Triangle t = mesh_.triangles[f];
    mesh_.triangles[f] = {t[0], v, t[2]};
    mesh_.triangles.push_back({v, t[1], t[2]});
  }

  // An axis-aligned box of whole numbers.
  void add_box() {
    const Vec3 low = grid(), size = Vec3::Ones() + grid();
    std::array<Vec3, 8> corners;
    for (std::size_t c = 0; c < 8; ++c)
      corners[c] = low + size.cwiseProduct(Vec3(c & 1 ? 1 : 0, c & 2 ? 1 : 0, c & 4 ? 1 : 0));
    add_body({corners.begin(), corners.end()}, {{0, 2, 3},
                                                {0, 3, 1},
                                                {4, 5, 7},
                                                {4, 7, 6},
                                                {0, 1, 5},
                                                {0, 5, 4},
                                                {2, 6, 7},
                                                {2, 7, 3},
                                                {0, 4, 6},
                                                {0, 6, 2},
                                                {1, 3, 7},
                                                {1, 7, 5}});
  }

  // Two pyramids base to base over a polygon of 1 + n corners.
  void add_cone(std::size_t n) {
    std::vector<Vec3> points{grid(), grid()};
    const Vec3 centre = 0.5 * (points[0] + points[1]);
    const auto corners = static_cast<std::uint32_t>(n + 1);
    for (std::uint32_t k = 0; k < corners; ++k) {
      const double angle = 2 * std::acos(-1.0) * k / corners;
      points.push_back(centre + Vec3(std::cos(angle), std::sin(angle), 0));
    }
    std::vector<Triangle> faces;
    for (std::uint32_t k = 0; k < corners; ++k) {
      const std::uint32_t a = 2 + k, b = 2 + (k + 1) % corners;
      faces.push_back({0, b, a});
      faces.push_back({1, a, b});
    }
    add_body(points, faces);
  }

  void add_body(const std::vector<Vec3>& points, const std::vector<Triangle>& faces) { append(mesh_, {points, faces}); }

  std::uint32_t add_vertex(const Vec3& place) {
    mesh_.vertices.push_back(place);
    return static_cast<std::uint32_t>(mesh_.vertices.size() - 1);
  }

  // A point of 5 x 5 x 5.
  Vec3 grid() {
    const std::size_t k = bytes_.below(125);
    return {static_cast<double>(k % 5), static_cast<double>(k / 5 % 5), static_cast<double>(k / 25)};
  }

  // From rounding of doubles to a visible step, along one axis.
  Vec3 noise() {
    const std::size_t k = bytes_.below(192);
    const double amount = std::ldexp(k % 2 ? 1.0 : -1.0, -static_cast<int>(k / 6) - 2);
    Vec3 step = Vec3::Zero();
    step[static_cast<Eigen::Index>(k / 2 % 3)] = amount;
    return step;
  }

  // As a file of 32-bit floats holds a part in inches, far from its origin.
  void round_to_float() {
    for (Vec3& p : mesh_.vertices)
      for (double& c : p) c = static_cast<float>(c / 25.4 + 100);
  }

  Bytes& bytes_;
  SurfaceMesh mesh_;
  bool as_float_ = false;
};

}  // namespace

SurfaceMesh soup_of(Bytes& bytes) {
  return Soup(bytes).build();
}

}  // namespace scan2fea::fuzz
