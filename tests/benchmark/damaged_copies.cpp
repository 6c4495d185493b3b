// For tests/benchmark/damage_table: sound bodies, and copies of them with one kind of damage each.
//
// damaged_copies kinds                     prints the names of the kinds
// damaged_copies body NAME OUT             box, bolt, ring, lens or grid
// damaged_copies damage IN OUT KIND SEED   prints the size of the damage: how far anything was moved, or how wide what
//                                          was taken away is, in per cent of the body's diagonal; 0 where nothing is
//                                          elsewhere than before. And the diagonal, in model units
#include "preproc/mesh/read_surface.hpp"
#include "preproc/mesh/union_find.hpp"
#include "preproc/mesh/write_surface.hpp"
#include "tests/analytic_meshes.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <functional>
#include <limits>
#include <map>
#include <random>
#include <stdexcept>
#include <string>
#include <vector>

namespace {

using namespace scan2fea;
using Random = std::mt19937;

double uniform(Random& random, double low, double high) {
  return std::uniform_real_distribution<double>(low, high)(random);
}

Vec3 direction(Random& random) {
  Vec3 d;
  do d = Vec3(uniform(random, -1, 1), uniform(random, -1, 1), uniform(random, -1, 1));
  while (d.norm() > 1 || d.norm() < 0.1);
  return d.normalized();
}

std::uint32_t pick(Random& random, std::size_t count) {
  return std::uniform_int_distribution<std::uint32_t>(0, static_cast<std::uint32_t>(count) - 1)(random);
}

// So many faces around one, by rings of vertices.
std::vector<std::uint32_t> patch_around(const SurfaceMesh& mesh, std::uint32_t seed, std::size_t count) {
  std::vector<char> near(mesh.vertices.size(), 0), taken(mesh.triangles.size(), 0);
  std::vector<std::uint32_t> patch{seed};
  taken[seed] = 1;
  for (std::size_t done = 0; done < patch.size() && patch.size() < count;) {
    for (; done < patch.size(); ++done)
      for (const std::uint32_t v : mesh.triangles[patch[done]]) near[v] = 1;
    for (std::uint32_t f = 0; f < mesh.triangles.size() && patch.size() < count; ++f) {
      const Triangle& t = mesh.triangles[f];
      if (taken[f] || !(near[t[0]] || near[t[1]] || near[t[2]])) continue;
      taken[f] = 1;
      patch.push_back(f);
    }
  }
  return patch;
}

void remove(SurfaceMesh& mesh, const std::vector<char>& gone) {
  std::size_t kept = 0;
  for (std::size_t f = 0; f < gone.size(); ++f)
    if (!gone[f]) mesh.triangles[kept++] = mesh.triangles[f];
  mesh.triangles.resize(kept);
}

// The largest diagonal of a box about faces that go and share vertices.
double widest(const SurfaceMesh& mesh, const std::vector<char>& gone) {
  UnionFind holes(mesh.vertices.size());
  for (std::size_t f = 0; f < gone.size(); ++f)
    if (gone[f])
      for (const std::uint32_t v : mesh.triangles[f]) holes.unite(v, mesh.triangles[f][0]);
  std::map<std::uint32_t, std::vector<Vec3>> points;
  for (std::size_t f = 0; f < gone.size(); ++f)
    if (gone[f])
      for (const std::uint32_t v : mesh.triangles[f]) points[holes.find(v)].push_back(mesh.vertices[v]);
  double width = 0;
  for (const auto& [hole, corners] : points) width = std::max(width, bounding_box(corners).diagonal());
  return width;
}

void tear(SurfaceMesh& mesh) {
  SurfaceMesh soup;
  for (const Triangle& t : mesh.triangles) {
    const auto n = static_cast<std::uint32_t>(soup.vertices.size());
    for (const std::uint32_t v : t) soup.vertices.push_back(mesh.vertices[v]);
    soup.triangles.push_back({n, n + 1, n + 2});
  }
  mesh = std::move(soup);
}

std::vector<double> shortest_edges(const SurfaceMesh& mesh) {
  std::vector<double> shortest(mesh.vertices.size(), std::numeric_limits<double>::max());
  for (const Triangle& t : mesh.triangles)
    for (std::size_t i = 0; i < 3; ++i) {
      const std::uint32_t a = t[i], b = t[(i + 1) % 3];
      const double length = (mesh.vertices[a] - mesh.vertices[b]).norm();
      shortest[a] = std::min(shortest[a], length);
      shortest[b] = std::min(shortest[b], length);
    }
  return shortest;
}

double flipped_faces(SurfaceMesh& mesh, Random& random) {
  for (Triangle& t : mesh.triangles)
    if (uniform(random, 0, 1) < 0.05) std::swap(t[0], t[1]);
  for (int i = 0; i < 4; ++i)
    for (const std::uint32_t f : patch_around(mesh, pick(random, mesh.triangles.size()), mesh.triangles.size() / 20))
      std::swap(mesh.triangles[f][0], mesh.triangles[f][1]);
  return 0;
}

double removed_faces(SurfaceMesh& mesh, Random& random) {
  std::vector<char> gone(mesh.triangles.size(), 0);
  for (char& mark : gone) mark = uniform(random, 0, 1) < 0.01;
  gone[pick(random, gone.size())] = 1;
  const double size = widest(mesh, gone);
  remove(mesh, gone);
  return size;
}

double removed_patches(SurfaceMesh& mesh, Random& random) {
  std::vector<char> gone(mesh.triangles.size(), 0);
  for (int i = 0; i < 3; ++i)
    for (const std::uint32_t f :
         patch_around(mesh, pick(random, mesh.triangles.size()), std::max<std::size_t>(6, mesh.triangles.size() / 500)))
      gone[f] = 1;
  const double size = widest(mesh, gone);
  remove(mesh, gone);
  return size;
}

double doubled_faces(SurfaceMesh& mesh, Random& random) {
  for (std::size_t f = 0, n = mesh.triangles.size(); f < n; ++f) {
    if (uniform(random, 0, 1) > 0.05) continue;
    Triangle t = mesh.triangles[f];
    if (uniform(random, 0, 1) < 0.5) std::swap(t[1], t[2]);
    mesh.triangles.push_back(t);
  }
  return 0;
}

double doubled_shell(SurfaceMesh& mesh, Random&) {
  mesh = analytic::join(mesh, mesh);
  return 0;
}

double both_sides(SurfaceMesh& mesh, Random&) {
  mesh = analytic::join(mesh, analytic::reversed(mesh));
  return 0;
}

double shifted_copy(SurfaceMesh& mesh, Random& random) {
  const double size = 0.01 * mean_edge_length(mesh);  // more adds more than half a per cent of volume
  mesh = analytic::join(mesh, analytic::moved(mesh, size * direction(random)));
  return size;
}

double turned_copy(SurfaceMesh& mesh, Random& random) {
  const BoundingBox box = bounding_box(mesh.vertices);
  const double angle = 0.05 * mean_edge_length(mesh) / box.diagonal();
  const Eigen::AngleAxisd turn(angle, direction(random));
  SurfaceMesh copy = mesh;
  double size = 0;
  for (Vec3& p : copy.vertices) {
    const Vec3 before = p, centre = (box.low + box.high) / 2;
    p = centre + turn * (p - centre);
    size = std::max(size, (p - before).norm());
  }
  mesh = analytic::join(mesh, copy);
  return size;
}

double shifted_vertices(SurfaceMesh& mesh, Random& random) {
  const std::vector<double> shortest = shortest_edges(mesh);
  double size = 0;
  for (std::size_t v = 0; v < mesh.vertices.size(); ++v) {
    if (uniform(random, 0, 1) > 0.01) continue;
    const double distance = 0.7 * shortest[v];
    size = std::max(size, distance);
    mesh.vertices[v] += distance * direction(random);
  }
  return size;
}

double spikes(SurfaceMesh& mesh, Random& random) {
  const double size = 3 * mean_edge_length(mesh);
  for (int i = 0; i < 5; ++i) mesh.vertices[pick(random, mesh.vertices.size())] += size * direction(random);
  return size;
}

double spikes_through(SurfaceMesh& mesh, Random& random) {
  const BoundingBox box = bounding_box(mesh.vertices);
  double size = 0;
  for (int i = 0; i < 3; ++i) {
    Vec3& p = mesh.vertices[pick(random, mesh.vertices.size())];
    const Vec3 across = 1.3 * ((box.low + box.high) / 2 - p);
    size = std::max(size, 2 * across.norm());
    p += 2 * across;
  }
  return size;
}

// Vertices on edges of single faces, which their neighbours do not have, up to `off` of the edge beside it.
double t_junctions(SurfaceMesh& mesh, Random& random, double share, int most, double off) {
  const std::vector<double> shortest = shortest_edges(mesh);
  double size = 0;
  for (std::size_t f = 0, n = mesh.triangles.size(); f < n; ++f) {
    if (uniform(random, 0, 1) > share) continue;
    const std::uint32_t side = pick(random, 3);
    Triangle t = mesh.triangles[f];
    std::rotate(t.begin(), t.begin() + side, t.end());
    std::vector<double> along;  // nowhere so near that the corners could be taken for one
    const std::uint32_t count = 1 + pick(random, static_cast<std::size_t>(most));
    for (std::uint32_t i = 0; i < count; ++i) along.push_back((i + uniform(random, 0.2, 0.8)) / count);
    std::uint32_t last = t[0];
    for (std::size_t i = 0; i <= along.size(); ++i) {
      std::uint32_t next = t[1];
      if (i < along.size()) {
        const Vec3 &a = mesh.vertices[t[0]], &b = mesh.vertices[t[1]];
        const Vec3 beside = off * std::min(shortest[t[0]], shortest[t[1]]) * direction(random);
        size = std::max(size, beside.norm());
        next = static_cast<std::uint32_t>(mesh.vertices.size());
        mesh.vertices.push_back(a + along[i] * (b - a) + beside);
      }
      const Triangle part{last, next, t[2]};
      if (i == 0)
        mesh.triangles[f] = part;
      else
        mesh.triangles.push_back(part);
      last = next;
    }
  }
  return size;
}

double t_junctions_exact(SurfaceMesh& mesh, Random& random) {
  return t_junctions(mesh, random, 0.03, 1, 0);
}

double t_junctions_beside(SurfaceMesh& mesh, Random& random) {
  return t_junctions(mesh, random, 0.03, 1, 1e-4);
}

double t_junctions_many(SurfaceMesh& mesh, Random& random) {
  return t_junctions(mesh, random, 0.3, 3, 1e-6);
}

// Faces with a repeated vertex, caps on halved edges, and edges of no length.
double zero_area_faces(SurfaceMesh& mesh, Random& random) {
  for (std::size_t f = 0, n = mesh.triangles.size(); f < n; ++f) {
    if (uniform(random, 0, 1) > 0.03) continue;
    const Triangle t = mesh.triangles[f];
    const auto middle = static_cast<std::uint32_t>(mesh.vertices.size());
    const std::uint32_t kind = pick(random, 3);
    if (kind == 0) {
      mesh.triangles.push_back({t[0], t[1], t[1]});
    } else {  // in the middle of an edge, or at its end
      mesh.vertices.push_back(kind == 1 ? Vec3((mesh.vertices[t[0]] + mesh.vertices[t[1]]) / 2) : mesh.vertices[t[0]]);
      mesh.triangles[f] = {middle, t[1], t[2]};
      mesh.triangles.push_back({t[0], middle, t[2]});
      mesh.triangles.push_back({t[0], t[1], middle});
    }
  }
  return 0;
}

double float_steps(SurfaceMesh& mesh, Random& random) {
  tear(mesh);
  double size = 0;
  for (Vec3& p : mesh.vertices) {
    const Vec3 before = p;
    for (double& x : p) {
      constexpr float far = std::numeric_limits<float>::max();
      const auto rounded = static_cast<float>(x);
      const std::uint32_t step = pick(random, 3);
      x = step == 0 ? rounded : static_cast<double>(std::nextafter(rounded, step == 1 ? far : -far));
    }
    size = std::max(size, (p - before).norm());
  }
  return size;
}

double corners_apart(SurfaceMesh& mesh, Random& random) {
  double most = mean_edge_length(mesh) * 1e-3;
  for (const double length : shortest_edges(mesh)) most = std::min(most, length / 50);
  tear(mesh);
  for (Vec3& p : mesh.vertices) p += uniform(random, 0, most / 2) * direction(random);
  return most;
}

// Regions around random vertices, each a little elsewhere.
double regions_apart(SurfaceMesh& mesh, Random& random) {
  constexpr std::size_t count = 8;
  double most = mean_edge_length(mesh) * 1e-3;
  for (const double length : shortest_edges(mesh)) most = std::min(most, length / 50);
  std::vector<Vec3> seeds, moves;
  for (std::size_t i = 0; i < count; ++i) {
    seeds.push_back(mesh.vertices[pick(random, mesh.vertices.size())]);
    moves.push_back(most / 2 * direction(random));
  }
  std::map<std::pair<std::size_t, std::uint32_t>, std::uint32_t> number;
  SurfaceMesh regions;
  for (Triangle t : mesh.triangles) {
    const Vec3 centre = (mesh.vertices[t[0]] + mesh.vertices[t[1]] + mesh.vertices[t[2]]) / 3;
    std::size_t region = 0;
    for (std::size_t i = 1; i < count; ++i)
      if ((seeds[i] - centre).norm() < (seeds[region] - centre).norm()) region = i;
    for (std::uint32_t& v : t) {
      const auto [at, is_new] = number.try_emplace({region, v}, static_cast<std::uint32_t>(regions.vertices.size()));
      if (is_new) regions.vertices.push_back(mesh.vertices[v] + moves[region]);
      v = at->second;
    }
    regions.triangles.push_back(t);
  }
  mesh = std::move(regions);
  return most;
}

double specks(SurfaceMesh& mesh, Random& random) {
  const BoundingBox box = bounding_box(mesh.vertices);
  for (int i = 0; i < 60; ++i) {
    SurfaceMesh speck =
        analytic::sphere(box.diagonal() * uniform(random, 1e-3, 1e-2), static_cast<int>(pick(random, 2)));
    if (i % 3 == 0) speck.triangles.resize(speck.triangles.size() / 2);
    mesh =
        analytic::join(mesh, analytic::moved(speck, (box.low + box.high) / 2 +
                                                        uniform(random, 0.6, 1) * box.diagonal() * direction(random)));
  }
  return 0;
}

double everything(SurfaceMesh& mesh, Random& random) {
  double size = removed_faces(mesh, random);
  for (const auto& damage : {t_junctions_beside, doubled_faces, zero_area_faces, specks, flipped_faces})
    size = std::max(size, damage(mesh, random));
  return size;
}

struct Kind {
  const char* name;
  double (*damage)(SurfaceMesh&, Random&);
};
constexpr Kind kinds[]{{"flipped faces", flipped_faces},
                       {"removed faces", removed_faces},
                       {"removed patches", removed_patches},
                       {"doubled faces", doubled_faces},
                       {"doubled shell", doubled_shell},
                       {"both sides", both_sides},
                       {"shifted copy", shifted_copy},
                       {"turned copy", turned_copy},
                       {"shifted vertices", shifted_vertices},
                       {"spikes", spikes},
                       {"spikes through", spikes_through},
                       {"T-junctions", t_junctions_exact},
                       {"T-junctions beside", t_junctions_beside},
                       {"T-junctions, many", t_junctions_many},
                       {"zero-area faces", zero_area_faces},
                       {"float steps", float_steps},
                       {"corners apart", corners_apart},
                       {"regions apart", regions_apart},
                       {"specks", specks},
                       {"several at once", everything}};

SurfaceMesh body(const std::string& name) {
  if (name == "box") return analytic::box({30, 20, 10}, 1);
  if (name == "bolt") return analytic::cylinder(5, 40, 48, 50);
  if (name == "ring") return analytic::torus(20, 5, 120, 40);
  if (name == "lens") return analytic::lens(60, 80, 20);
  if (name == "grid") return analytic::slab_with_holes(3, 0.2);
  throw std::runtime_error("no body " + name);
}

double damaged(SurfaceMesh& mesh, const std::string& name, unsigned seed) {
  for (const Kind& kind : kinds)
    if (name == kind.name) {
      Random random(seed);
      return kind.damage(mesh, random);
    }
  throw std::runtime_error("no kind " + name);
}

int run(const std::vector<std::string>& arguments) {
  if (arguments.size() == 1 && arguments[0] == "kinds") {
    for (const Kind& kind : kinds) std::printf("%s\n", kind.name);
  } else if (arguments.size() == 3 && arguments[0] == "body") {
    write_surface(body(arguments[1]), arguments[2]);
  } else if (arguments.size() == 5 && arguments[0] == "damage") {
    SurfaceMesh mesh = read_surface(arguments[1]);
    const double diagonal = bounding_box(mesh.vertices).diagonal();
    const double size = damaged(mesh, arguments[3], static_cast<unsigned>(std::stoul(arguments[4])));
    write_surface(mesh, arguments[2]);
    std::printf("%.17g %.17g\n", 100 * size / diagonal, diagonal);
  } else {
    std::fprintf(stderr, "damaged_copies kinds | body NAME OUT | damage IN OUT KIND SEED\n");
    return 2;
  }
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  try {
    return run({argv + 1, argv + argc});
  } catch (const std::exception& e) {
    std::fprintf(stderr, "damaged_copies: %s\n", e.what());
    return 1;
  }
}
