#include "preproc/command/read_inputs.hpp"

#include "export/formats.hpp"
#include "export/surface_files.hpp"
#include "export/units.hpp"
#include "preproc/command/body_inputs.hpp"
#include "preproc/command/caller.hpp"
#include "preproc/command/console.hpp"
#include "preproc/command/large_scans.hpp"
#include "preproc/mesh/error.hpp"
#include "preproc/mesh/read_surface.hpp"

#include <chrono>
#include <string>
#include <utility>

namespace scan2fea::command {
namespace {

// The unit is what the file says or the user, who must not contradict one another.
NamedScan with_unit(NamedSurface surface, const std::filesystem::path& input, MakeMeshJob& job) {
  const std::string unit = settled_unit(surface.unit, job.common.unit, input.string());
  if (!unit.empty()) job.common.unit = unit;
  return surface;
}

// As if it had been read from a file.
NamedScan scan_in(const MemoryMesh& given, MakeMeshJob& job) {
  const auto* cloud = std::get_if<PointCloud>(&given.held);
  if (cloud != nullptr && job.takes_clouds != TakesClouds::no) return *cloud;
  NamedSurface surface = surface_in(given);
  if (job.takes_clouds != TakesClouds::only) return with_unit(std::move(surface), given.name, job);
  PointCloud points;
  points.points = std::move(surface.mesh.vertices);
  return points;
}

NamedScan read_scan_file(const std::filesystem::path& file, const MakeMeshJob& job, const Progress& progress,
                         ReadInputs& inputs) {
  if (!job.largest_scan) return read_named_scan(file);
  const Progress::Clock::time_point start = Progress::Clock::now();
  ThinnedScan read = read_thinned_scan(file, thinning_limit(job), progress);
  if (read.thinning) {
    const std::chrono::duration<double> seconds = Progress::Clock::now() - start;
    inputs.thinned.push_back(*read.thinning);
    const std::string scan = job.more_bodies.empty() ? "the scan" : "the scan " + file.filename().string();
    inputs.stages.push_back(describe(*read.thinning, scan, seconds.count()));
  }
  return std::move(read.scan);
}

// The input, and then more bodies: in the formats of meshes, too, with the names that come with a surface.
NamedScan read_file(std::size_t place, MakeMeshJob& job, const Progress& progress, ReadInputs& inputs) {
  if (job.common.caller != nullptr)
    if (const MemoryMesh* given = job.common.caller->input(place)) return scan_in(*given, job);
  const std::filesystem::path& input = place == 0 ? job.common.input : job.more_bodies[place - 1];
  const std::filesystem::path file = file_to_read(input, place == 0 ? job.common.formats.from : std::nullopt);
  if (job.takes_clouds == TakesClouds::only) return read_cloud(file);
  const FileFormat* format = find_format(file);
  MeshFile read;
  if (format != nullptr && format->read != read_plain_surface) {
    read = read_mesh(file);
    if (const auto* volume = std::get_if<TetMesh>(&read.mesh)) read.mesh = named_boundary(*volume, read.warnings);
  } else if (job.takes_clouds == TakesClouds::no) {
    read.mesh = read_named_surface(file);
  } else {
    NamedScan scan = read_scan_file(file, job, progress, inputs);
    if (auto* cloud = std::get_if<PointCloud>(&scan)) return std::move(*cloud);
    read.mesh = std::get<NamedSurface>(std::move(scan));
  }
  for (const std::string& warning : read.warnings) warn(shown_name(input) + ": " + warning);
  return with_unit(std::get<NamedSurface>(std::move(read.mesh)), input, job);
}

Scan read_input(MakeMeshJob& job, const Progress& progress, ReadInputs& inputs) {
  NamedScan read = read_file(0, job, progress, inputs);
  if (auto* cloud = std::get_if<PointCloud>(&read)) return std::move(*cloud);
  auto& surface = std::get<NamedSurface>(read);
  job.pipeline.given_sets = std::move(surface.face_sets);
  return std::move(surface.mesh);
}

[[noreturn]] void refuse_cloud(const std::filesystem::path& file) {
  throw WrongUsage({.what = "a point cloud among several bodies",
                    .where = file.string(),
                    .value = {},
                    .limit = {},
                    .advice = "scan2fea reconstruct, first"});
}

// The surfaces of more files, added to the first one's, with their sets.
void add_to_one_body(MakeMeshJob& job, const Progress& progress, ReadInputs& inputs) {
  for (std::size_t i = 0; i < job.more_bodies.size(); ++i) {
    const NamedScan read = read_file(i + 1, job, progress, inputs);
    const auto* more = std::get_if<NamedSurface>(&read);
    auto* mesh = std::get_if<SurfaceMesh>(&inputs.scan);
    if (more == nullptr || mesh == nullptr) refuse_cloud(more == nullptr ? job.more_bodies[i] : job.common.input);
    const auto triangles = static_cast<std::uint32_t>(mesh->triangles.size());
    append(*mesh, more->mesh);
    for (const NamedSet& set : more->face_sets) {
      std::vector<NamedSet>& sets = job.pipeline.given_sets;
      std::vector<std::uint32_t>& members = sets[find_or_add_set(sets, set.name)].members;
      for (const std::uint32_t f : set.members) members.push_back(triangles + f);
    }
  }
}

// Of the files, where there are several, or else of the groups of the only one; none where that is one body.
std::vector<Body> read_bodies(MakeMeshJob& job, const Progress& progress, ReadInputs& inputs) {
  const auto* mesh = std::get_if<SurfaceMesh>(&inputs.scan);
  Notes& notes = inputs.notes;
  if (job.one_body) return {};
  if (job.more_bodies.empty())
    return mesh == nullptr ? std::vector<Body>() : bodies_of_groups(*mesh, job.pipeline.given_sets, notes);
  std::vector<std::filesystem::path> files{name_of_input(job.common.input)};
  files.insert(files.end(), job.more_bodies.begin(), job.more_bodies.end());
  const std::vector<std::string> names = body_names(files, notes);
  std::vector<Body> bodies;
  for (std::size_t b = 0; b < files.size(); ++b) {
    const NamedScan read = b == 0 ? NamedScan() : read_file(b, job, progress, inputs);
    const auto* surface = std::get_if<NamedSurface>(&read);
    if (b == 0 ? mesh == nullptr : surface == nullptr) refuse_cloud(files[b]);
    bodies.push_back({names[b], b == 0 ? *mesh : surface->mesh});
  }
  return bodies;
}

double triangles_of(const ReadInputs& inputs) {
  double triangles = 0;
  for (const Body& body : inputs.bodies) triangles += static_cast<double>(body.surface.triangles.size());
  const auto* mesh = std::get_if<SurfaceMesh>(&inputs.scan);
  return inputs.bodies.empty() && mesh != nullptr ? static_cast<double>(mesh->triangles.size()) : triangles;
}

}  // namespace

ReadInputs read_inputs(MakeMeshJob& job, const Progress& progress) {
  ReadInputs inputs;
  inputs.scan = read_input(job, progress, inputs);
  if (job.one_body) add_to_one_body(job, progress, inputs);
  inputs.bodies = read_bodies(job, progress, inputs);
  if (!inputs.thinned.empty()) adapt_to_thinned(inputs.thinned, triangles_of(inputs), job);
  return inputs;
}

}  // namespace scan2fea::command
