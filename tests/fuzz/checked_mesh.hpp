// What every mesh that was read can be relied on for.
#pragma once

#include "export/mesh_file.hpp"
#include "tests/fuzz/finding.hpp"

namespace scan2fea::fuzz {

inline void require_sound_sets(const std::vector<NamedSet>& sets, std::size_t members) {
  for (const NamedSet& set : sets) {
    require(!set.name.empty(), "a set without a name");
    for (std::size_t i = 0; i < set.members.size(); ++i) {
      require(set.members[i] < members, "a member of a set out of range");
      require(i == 0 || set.members[i] > set.members[i - 1], "members of a set that are not in order");
    }
  }
}

inline void require_sound(const TetMesh& mesh) {
  require(!mesh.tetrahedra.empty(), "a mesh without tetrahedra");
  require(mesh.mid_edge_nodes.empty() || mesh.mid_edge_nodes.size() == mesh.tetrahedra.size(),
          "mid-edge nodes of some elements only");
  for (const Vec3& p : mesh.nodes) require(p.allFinite(), "a coordinate that is not finite");
  const auto require_nodes = [&](const auto& element) {
    for (const auto node : element) require(node < mesh.nodes.size(), "a node out of range");
  };
  for (const auto& corners : mesh.tetrahedra) require_nodes(corners);
  for (const auto& mid_edges : mesh.mid_edge_nodes) require_nodes(mid_edges);
  require_sound_sets(mesh.node_sets, mesh.nodes.size());
  require_sound_sets(mesh.face_sets, mesh.boundary.size());
  require_sound_sets(mesh.element_sets, mesh.tetrahedra.size());
}

inline void require_sound(const NamedSurface& surface) {
  require(!surface.mesh.triangles.empty(), "a surface without faces");
  for (const Vec3& p : surface.mesh.vertices) require(p.allFinite(), "a coordinate that is not finite");
  for (const Triangle& t : surface.mesh.triangles)
    for (const std::uint32_t v : t) require(v < surface.mesh.vertices.size(), "an index out of range");
  require_sound_sets(surface.node_sets, surface.mesh.vertices.size());
  require_sound_sets(surface.face_sets, surface.mesh.triangles.size());
}

}  // namespace scan2fea::fuzz
