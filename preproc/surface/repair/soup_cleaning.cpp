#include "preproc/surface/repair/soup_cleaning.hpp"

#include "preproc/mesh/error.hpp"
#include "preproc/surface/repair/face_marks.hpp"
#include "preproc/surface/repair/soup_adjacency.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace scan2fea {
namespace {

class DisjointSets {
 public:
  explicit DisjointSets(std::size_t n) : parent_(n) { std::iota(parent_.begin(), parent_.end(), 0U); }
  std::uint32_t find(std::uint32_t i) {
    while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
    return i;
  }
  void unite(std::uint32_t a, std::uint32_t b) {  // the lowest index represents, whatever the order of calls
    a = find(a), b = find(b);
    if (a != b) parent_[std::max(a, b)] = std::min(a, b);
  }

 private:
  std::vector<std::uint32_t> parent_;
};

struct SortedFace {
  Triangle vertices;
  std::uint32_t face;
};

// Groups of two or more faces on the same vertices, each ascending.
std::vector<std::vector<std::uint32_t>> find_duplicates(const SurfaceMesh& mesh) {
  // Only faces whose lowest edge has a third face beside it can be duplicates; on a sound mesh there are none to sort.
  std::vector<SortedFace> candidates;
  EdgeGroups(mesh).for_each([&](const std::uint32_t* first, const std::uint32_t* last) {
    if (last - first < 2) return;
    const bool two = last - first == 2;
    if (two && start_vertex(mesh, previous_halfedge(first[0])) != start_vertex(mesh, previous_halfedge(first[1])))
      return;
    for (const std::uint32_t* h = first; h != last; ++h) {
      Triangle t = mesh.triangles[*h / 3];
      std::sort(t.begin(), t.end());
      candidates.push_back({t, *h / 3});
    }
  });
  std::sort(candidates.begin(), candidates.end(), [](const SortedFace& a, const SortedFace& b) {
    return a.vertices != b.vertices ? a.vertices < b.vertices : a.face < b.face;
  });
  std::vector<std::vector<std::uint32_t>> groups;
  for (std::size_t i = 0; i < candidates.size();) {
    std::vector<std::uint32_t> group;
    std::size_t j = i;
    for (; j < candidates.size() && candidates[j].vertices == candidates[i].vertices; ++j)
      if (group.empty() || group.back() != candidates[j].face) group.push_back(candidates[j].face);
    if (group.size() > 1) groups.push_back(std::move(group));
    i = j;
  }
  return groups;
}

}  // namespace

void check_input(const SurfaceMesh& mesh) {
  if (mesh.triangles.empty()) throw InvalidInput({"the surface has no faces", {}, {}, {}, {}});
  if (mesh.triangles.size() > std::numeric_limits<std::uint32_t>::max() / 3 - 1)
    throw InvalidInput({"too many faces", {}, std::to_string(mesh.triangles.size()), "1431655763", {}});
  for (std::size_t v = 0; v < mesh.vertices.size(); ++v)
    if (!mesh.vertices[v].allFinite())
      throw InvalidInput({"coordinate is not a finite number", "vertex " + std::to_string(v), {}, {}, {}});
  for (std::size_t f = 0; f < mesh.triangles.size(); ++f)
    for (const std::uint32_t v : mesh.triangles[f])
      if (v >= mesh.vertices.size())
        throw InvalidInput({"vertex index out of range",
                            "face " + std::to_string(f),
                            std::to_string(v),
                            std::to_string(mesh.vertices.size()) + " vertices",
                            {}});
}

void drop_collapsed_faces(SurfaceMesh& mesh, RepairResult& result) {
  std::vector<char> marks;
  for (std::uint32_t f = 0; f < mesh.triangles.size(); ++f) {
    const Triangle& t = mesh.triangles[f];
    if (t[0] != t[1] && t[1] != t[2] && t[2] != t[0]) continue;
    marks.resize(mesh.triangles.size(), 0);
    marks[f] = 1;
    const double longest = std::max((mesh.vertices[t[0]] - mesh.vertices[t[1]]).norm(),
                                    (mesh.vertices[t[0]] - mesh.vertices[t[2]]).norm());
    result.changes.push_back({RepairKind::DegenerateFace, centre_of(mesh, f), longest});
  }
  if (!marks.empty()) remove_faces(mesh, marks, result);
}

void drop_duplicate_faces(SurfaceMesh& mesh, RepairResult& result) {
  const auto groups = find_duplicates(mesh);
  if (groups.empty()) return;
  std::vector<char> marks(mesh.triangles.size(), 0);
  std::vector<char> doubled(mesh.triangles.size(), 0);  // in a group of even size
  for (const auto& group : groups) {
    // The direction that more of them have is the one to keep.
    const auto even = [](const Triangle& t) { return (t[0] < t[1]) + (t[1] < t[2]) + (t[2] < t[0]) == 2; };
    std::size_t even_count = 0;
    for (const std::uint32_t f : group) even_count += even(mesh.triangles[f]);
    const bool keep_even =
        2 * even_count == group.size() ? even(mesh.triangles[group[0]]) : 2 * even_count > group.size();
    bool kept = false;
    for (const std::uint32_t f : group) {
      const bool keep = !kept && even(mesh.triangles[f]) == keep_even;
      kept |= keep;
      marks[f] = !keep;
      doubled[f] = group.size() % 2 == 0;
    }
  }

  // Patches of doubled faces vote by the edges that they share with single ones.
  DisjointSets patches(mesh.triangles.size());
  const EdgeGroups edges(mesh);
  edges.for_each([&](const std::uint32_t* first, const std::uint32_t* last) {
    const std::uint32_t* previous = nullptr;
    for (const std::uint32_t* h = first; h != last; ++h)
      if (doubled[*h / 3]) {
        if (previous) patches.unite(*previous / 3, *h / 3);
        previous = h;
      }
  });
  std::vector<int> votes_to_drop(mesh.triangles.size(), 0);
  edges.for_each([&](const std::uint32_t* first, const std::uint32_t* last) {
    const auto singles = std::count_if(first, last, [&](std::uint32_t h) { return !doubled[h / 3] && !marks[h / 3]; });
    if (singles == 0) return;
    for (const std::uint32_t* h = first; h != last; ++h)
      if (doubled[*h / 3]) votes_to_drop[patches.find(*h / 3)] += singles % 2 == 0 ? 1 : -1;
  });
  for (std::uint32_t f = 0; f < mesh.triangles.size(); ++f)
    if (doubled[f] && votes_to_drop[patches.find(f)] > 0) marks[f] = 1;

  log_faces(mesh, marks, RepairKind::DuplicateFace, result);
  remove_faces(mesh, marks, result);
}

void weld_borders(SurfaceMesh& mesh, RepairResult& result) {
  struct BorderEdge {
    std::uint32_t from, to;
  };
  std::vector<BorderEdge> border;
  std::vector<std::uint32_t> ends;
  EdgeGroups(mesh).for_each([&](const std::uint32_t* first, const std::uint32_t* last) {
    if (last - first != 1) return;
    border.push_back({start_vertex(mesh, *first), end_vertex(mesh, *first)});
    ends.push_back(border.back().from);
    ends.push_back(border.back().to);
  });
  if (border.empty()) return;

  const auto less = [&](std::uint32_t a, std::uint32_t b) {
    const Vec3 &p = mesh.vertices[a], &q = mesh.vertices[b];
    return std::lexicographical_compare(p.begin(), p.end(), q.begin(), q.end());
  };
  std::sort(ends.begin(), ends.end(),
            [&](std::uint32_t a, std::uint32_t b) { return less(a, b) || (!less(b, a) && a < b); });
  std::vector<std::uint32_t> place(mesh.vertices.size(), 0);  // equal for coincident ends: the lowest of them
  for (std::size_t i = 0; i < ends.size(); ++i) {
    const bool same = i > 0 && !less(ends[i - 1], ends[i]);
    place[ends[i]] = same ? place[ends[i - 1]] : ends[i];
  }

  const auto key = [&](const BorderEdge& e) { return std::minmax(place[e.from], place[e.to]); };
  std::sort(border.begin(), border.end(), [&](const BorderEdge& a, const BorderEdge& b) {
    if (key(a) != key(b)) return std::pair(key(a)) < std::pair(key(b));
    return std::pair(a.from, a.to) < std::pair(b.from, b.to);
  });
  DisjointSets joined(mesh.vertices.size());
  for (std::size_t i = 0; i < border.size(); ++i) {
    const BorderEdge& e = border[i];
    if (place[e.from] == place[e.to]) joined.unite(e.from, e.to);  // an edge of no length
    if (i == 0 || key(e) != key(border[i - 1])) continue;
    const BorderEdge& mate = border[i - 1];
    const bool parallel = place[e.from] == place[mate.from];
    joined.unite(e.from, parallel ? mate.from : mate.to);
    joined.unite(e.to, parallel ? mate.to : mate.from);
  }
  for (std::uint32_t v = 0; v < mesh.vertices.size(); ++v)
    if (joined.find(v) != v) result.changes.push_back({RepairKind::WeldedVertex, mesh.vertices[v], 0});
  for (Triangle& t : mesh.triangles)
    for (std::uint32_t& v : t) v = joined.find(v);
}

void drop_inner_walls(SurfaceMesh& mesh, RepairResult& result) {
  // Edges as ranges of half-edges; patches are joined across edges of two faces.
  struct Edge {
    std::uint32_t first, last;
  };
  std::vector<Edge> irregular;  // edges of one face, or of more than two
  std::vector<std::uint32_t> around;
  DisjointSets patches(mesh.triangles.size());
  bool any_odd = false;
  EdgeGroups(mesh).for_each([&](const std::uint32_t* first, const std::uint32_t* last) {
    if (last - first == 2) return patches.unite(first[0] / 3, first[1] / 3);
    any_odd |= last - first > 2 && (last - first) % 2 == 1;
    const auto at = static_cast<std::uint32_t>(around.size());
    around.insert(around.end(), first, last);
    irregular.push_back({at, static_cast<std::uint32_t>(around.size())});
  });
  if (!any_odd) return;

  struct Patch {
    std::uint32_t id;
    double area = 0;
    std::vector<std::uint32_t> edges;  // into `irregular`, without repetition
  };
  std::vector<std::uint32_t> number(mesh.triangles.size(), 0);
  std::vector<Patch> sheets;
  for (std::uint32_t f = 0; f < mesh.triangles.size(); ++f) {
    if (patches.find(f) == f) number[f] = static_cast<std::uint32_t>(sheets.size()), sheets.push_back({f, 0, {}});
    number[f] = number[patches.find(f)];
    sheets[number[f]].area += area_of(mesh, f);
  }
  std::vector<std::uint32_t> remaining(irregular.size());
  for (std::uint32_t e = 0; e < irregular.size(); ++e) {
    remaining[e] = irregular[e].last - irregular[e].first;
    for (std::uint32_t i = irregular[e].first; i < irregular[e].last; ++i) {
      auto& edges = sheets[number[around[i] / 3]].edges;
      if (edges.empty() || edges.back() != e) edges.push_back(e);
    }
  }
  const auto own = [&](const Patch& sheet, std::uint32_t e) {
    return static_cast<std::uint32_t>(std::count_if(around.begin() + irregular[e].first,
                                                    around.begin() + irregular[e].last,
                                                    [&](std::uint32_t h) { return patches.find(h / 3) == sheet.id; }));
  };
  const auto is_wall = [&](const Patch& sheet) {
    bool mends = false;
    for (const std::uint32_t e : sheet.edges) {
      const std::uint32_t left = remaining[e] - own(sheet, e);
      if (left % 2 == 1) return false;
      mends |= left > 0 && remaining[e] % 2 == 1;
    }
    return mends;
  };

  std::vector<const Patch*> by_area;
  for (const Patch& sheet : sheets)
    if (!sheet.edges.empty()) by_area.push_back(&sheet);
  std::stable_sort(by_area.begin(), by_area.end(), [](const Patch* a, const Patch* b) { return a->area < b->area; });
  std::vector<char> dropped(sheets.size(), 0);
  for (const Patch* sheet : by_area) {
    if (!is_wall(*sheet)) continue;
    for (const std::uint32_t e : sheet->edges) remaining[e] -= own(*sheet, e);
    dropped[number[sheet->id]] = 1;
    result.changes.push_back({RepairKind::InnerWall, centre_of(mesh, sheet->id), sheet->area});
  }
  std::vector<char> marks(mesh.triangles.size(), 0);
  for (std::uint32_t f = 0; f < mesh.triangles.size(); ++f) marks[f] = dropped[number[f]];
  remove_faces(mesh, marks, result);
}

std::vector<Vec3> drop_unused_vertices(SurfaceMesh& mesh) {
  std::vector<char> used(mesh.vertices.size(), 0);
  for (const Triangle& t : mesh.triangles)
    for (const std::uint32_t v : t) used[v] = 1;
  if (std::find(used.begin(), used.end(), 0) == used.end()) return {};
  std::vector<std::uint32_t> new_index(mesh.vertices.size());
  std::vector<Vec3> unused;
  std::uint32_t kept = 0;
  for (std::size_t v = 0; v < mesh.vertices.size(); ++v) {
    if (!used[v]) {
      unused.push_back(mesh.vertices[v]);
      continue;
    }
    new_index[v] = kept;
    mesh.vertices[kept++] = mesh.vertices[v];
  }
  mesh.vertices.resize(kept);
  for (Triangle& t : mesh.triangles)
    for (std::uint32_t& v : t) v = new_index[v];
  return unused;
}

}  // namespace scan2fea
