// A mesh that somebody made, as `check` and `compare` measure it, and what it is measured against.
#pragma once

#include "preproc/command/caller.hpp"
#include "preproc/command/figures.hpp"
#include "preproc/mesh/named_sets.hpp"
#include "preproc/mesh/point_cloud.hpp"
#include "preproc/mesh/tet_mesh.hpp"

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace scan2fea::command {

// The surface, or a volume mesh and its boundary.
struct LoadedMesh {
  SurfaceMesh surface;
  std::optional<TetMesh> volume_mesh;
  std::vector<NamedSet> face_sets;             // of the surface
  std::vector<std::uint32_t> element_numbers;  // where those of the file are no row from 1 on
  std::string unit;                            // that the file says; empty where it says none
};

// Throws WrongUsage for what comes through a pipe: that is the input, and can be read once.
void require_no_pipe(const std::filesystem::path& file);

LoadedMesh load_mesh(const std::filesystem::path& file);
// Of what was read, or is in memory, whose elements are counted from this number on; 0 where the file has no numbers.
LoadedMesh loaded(MeshFile read, std::uint64_t first_element);

// With its own figures, and nothing that it is compared with. The mesh must outlive it.
Subject subject_of(const LoadedMesh& mesh);

// A cloud tells distances of its points only.
struct LoadedReference {
  std::optional<SurfaceMesh> surface;
  std::optional<PointCloud> cloud;
  std::optional<double> solid_volume;  // where the surface's triangles do not tell it
  bool is_of_bodies = false;           // see DeviationOptions
  std::string unit;                    // that the file says; empty where it says none
};

// The reference must outlive the subject.
void compare_with(const LoadedReference& reference, Subject& subject);

// Nothing of no file; one of them, or the surfaces of several bodies. Throws WrongUsage for a cloud among several, and
// where a file says another unit than `unit`, that of the mesh. Those that a program has in memory are not read.
LoadedReference load_references(const std::vector<std::filesystem::path>& files, const std::string& unit,
                                const Caller* caller = nullptr);
// Of a mesh of second order the surface is curved, in flat pieces; of one of several bodies it is all of their
// surfaces.
LoadedReference reference_of(LoadedMesh mesh);

}  // namespace scan2fea::command
