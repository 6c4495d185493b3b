#include "preproc/surface/repair/soup_cleaning.hpp"

#include "preproc/mesh/error.hpp"
#include "preproc/mesh/union_find.hpp"
#include "preproc/surface/repair/border_stitching.hpp"
#include "preproc/surface/repair/face_marks.hpp"
#include "preproc/surface/repair/soup_adjacency.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace scan2fea {
namespace {

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

// Faces that hang together across edges of two faces, in sheets; all other edges bound the sheets.
class Sheets {
 public:
  struct Sheet {
    std::uint32_t first_face;
    double area = 0;
    std::vector<std::uint32_t> edges;  // that bound it, without repetition
  };

  explicit Sheets(const SurfaceMesh& mesh) : joined_(mesh.triangles.size()), sheet_of_face_(mesh.triangles.size(), 0) {
    EdgeGroups(mesh).for_each([&](const std::uint32_t* first, const std::uint32_t* last) {
      if (last - first == 2) {
        joined_.unite(first[0] / 3, first[1] / 3);
        return;
      }
      any_odd_ |= last - first > 2 && (last - first) % 2 == 1;
      const auto at = static_cast<std::uint32_t>(around_.size());
      around_.insert(around_.end(), first, last);
      edges_.push_back({at, static_cast<std::uint32_t>(around_.size())});
    });
    // Nearly all scans end here: a wall leaves an odd number of faces at its edges.
    if (any_odd_) gather(mesh);
  }

  // Whether any edge has an odd number of faces, three or more; if not, no sheets are told.
  bool any_odd() const { return any_odd_; }

  // Those with edges, the smallest area first.
  std::vector<Sheet> by_area() const {
    std::vector<Sheet> sorted;
    for (const Sheet& sheet : sheets_)
      if (!sheet.edges.empty()) sorted.push_back(sheet);
    std::stable_sort(sorted.begin(), sorted.end(), [](const Sheet& a, const Sheet& b) { return a.area < b.area; });
    return sorted;
  }

  // Whether each edge of the sheet would have an even number of faces or none without it, and some has an odd one now.
  bool is_wall(const Sheet& sheet) const {
    bool mends = false;
    for (const std::uint32_t e : sheet.edges) {
      const std::uint32_t left = remaining_[e] - own(sheet, e);
      if (left % 2 == 1) return false;
      mends |= left > 0 && remaining_[e] % 2 == 1;
    }
    return mends;
  }

  void drop(const Sheet& sheet) {
    for (const std::uint32_t e : sheet.edges) remaining_[e] -= own(sheet, e);
    dropped_[sheet_of_face_[sheet.first_face]] = 1;
  }

  // Per face, whether its sheet was dropped.
  std::vector<char> dropped_faces() const {
    std::vector<char> marks(sheet_of_face_.size());
    for (std::size_t f = 0; f < marks.size(); ++f) marks[f] = dropped_[sheet_of_face_[f]];
    return marks;
  }

 private:
  // A range of half-edges in around_.
  struct Edge {
    std::uint32_t first, last;
  };

  void gather(const SurfaceMesh& mesh) {
    for (std::uint32_t f = 0; f < mesh.triangles.size(); ++f) {
      const std::uint32_t first = joined_.find(f);
      if (first == f) {
        sheet_of_face_[f] = static_cast<std::uint32_t>(sheets_.size());
        sheets_.push_back({f, 0, {}});
      }
      sheet_of_face_[f] = sheet_of_face_[first];
      sheets_[sheet_of_face_[f]].area += area_of(mesh, f);
    }
    dropped_.assign(sheets_.size(), 0);
    remaining_.resize(edges_.size());
    for (std::uint32_t e = 0; e < edges_.size(); ++e) {
      remaining_[e] = edges_[e].last - edges_[e].first;
      for (std::uint32_t i = edges_[e].first; i < edges_[e].last; ++i) {
        std::vector<std::uint32_t>& edges = sheets_[sheet_of_face_[around_[i] / 3]].edges;
        if (edges.empty() || edges.back() != e) edges.push_back(e);
      }
    }
  }

  // The number of the sheet's own faces at an edge.
  std::uint32_t own(const Sheet& sheet, std::uint32_t e) const {
    const std::uint32_t number = sheet_of_face_[sheet.first_face];
    return static_cast<std::uint32_t>(std::count_if(around_.begin() + edges_[e].first, around_.begin() + edges_[e].last,
                                                    [&](std::uint32_t h) { return sheet_of_face_[h / 3] == number; }));
  }

  UnionFind joined_;
  std::vector<Edge> edges_;
  std::vector<std::uint32_t> around_;
  bool any_odd_ = false;
  std::vector<std::uint32_t> sheet_of_face_;
  std::vector<Sheet> sheets_;
  std::vector<std::uint32_t> remaining_;  // per edge, its faces that were not dropped
  std::vector<char> dropped_;             // per sheet
};

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
  UnionFind patches(mesh.triangles.size());
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
  UnionFind joined(mesh.vertices.size());
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
  Sheets sheets(mesh);
  if (!sheets.any_odd()) return;
  for (const Sheets::Sheet& sheet : sheets.by_area()) {
    if (!sheets.is_wall(sheet)) continue;
    sheets.drop(sheet);
    result.changes.push_back({RepairKind::InnerWall, centre_of(mesh, sheet.first_face), sheet.area, sheet.area});
  }
  remove_faces(mesh, sheets.dropped_faces(), result);
}

void clean_soup(SurfaceMesh& mesh, RepairResult& result) {
  drop_collapsed_faces(mesh, result);
  drop_duplicate_faces(mesh, result);
  const std::size_t before = result.changes.size();
  weld_borders(mesh, result);
  stitch_borders(mesh, result);
  if (result.changes.size() != before) {
    drop_collapsed_faces(mesh, result);
    drop_duplicate_faces(mesh, result);
  }
  drop_inner_walls(mesh, result);
}

}  // namespace scan2fea
