#include "preproc/symmetry/fill_outline.hpp"

#include "preproc/mesh/error.hpp"

#include <CGAL/Constrained_Delaunay_triangulation_2.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Triangulation_face_base_with_info_2.h>
#include <CGAL/Triangulation_vertex_base_with_info_2.h>

#include <cstdint>
#include <deque>
#include <map>
#include <optional>

namespace scan2fea {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using VertexBase = CGAL::Triangulation_vertex_base_with_info_2<std::uint32_t, Kernel>;
using FaceInfo = CGAL::Triangulation_face_base_with_info_2<std::optional<bool>, Kernel>;  // whether it is inside
using FaceBase = CGAL::Constrained_triangulation_face_base_2<Kernel, FaceInfo>;
using Structure = CGAL::Triangulation_data_structure_2<VertexBase, FaceBase>;
using Triangulation =
    CGAL::Constrained_Delaunay_triangulation_2<Kernel, Structure, CGAL::No_constraint_intersection_tag>;

// From the outside inwards: across an edge of the outline it is the other side.
void mark_inside(Triangulation& triangulation) {
  std::deque<Triangulation::Face_handle> front{triangulation.infinite_face()};
  front.front()->info() = false;
  while (!front.empty()) {
    const auto face = front.front();
    front.pop_front();
    for (int k = 0; k < 3; ++k) {
      const auto beside = face->neighbor(k);
      if (beside->info()) continue;
      beside->info() = *face->info() != face->is_constrained(k);
      front.push_back(beside);
    }
  }
}

}  // namespace

std::vector<Triangle> fill_outline(const std::vector<Vec3>& vertices, std::span<const FeatureEdge> outline) {
  if (outline.empty()) return {};
  Triangulation triangulation;
  std::map<std::uint32_t, Triangulation::Vertex_handle> placed;
  const auto place = [&](std::uint32_t v) {
    auto& handle = placed[v];
    if (handle != Triangulation::Vertex_handle()) return handle;
    handle = triangulation.insert({vertices[v].y(), vertices[v].z()});
    handle->info() = v;
    return handle;
  };
  for (const auto& [a, b] : outline) {
    const auto from = place(a), to = place(b);
    try {
      triangulation.insert_constraint(from, to);
    } catch (const Triangulation::Intersection_of_constraints_exception&) {
      throw NotMeshable({.what = "the scan meets its mirror plane along a line that crosses itself",
                         .where = {},
                         .value = {},
                         .limit = {},
                         .advice = "--symmetry off",
                         .at = vertices[a]});
    }
  }
  mark_inside(triangulation);
  std::vector<Triangle> inside;
  for (const auto face : triangulation.finite_face_handles())
    if (face->info() == true)
      inside.push_back({face->vertex(0)->info(), face->vertex(2)->info(), face->vertex(1)->info()});
  return inside;
}

}  // namespace scan2fea
