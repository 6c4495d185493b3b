// Measures what a sub-command made or read, evaluates the gates, and writes the reports that were asked for.
#pragma once

#include "preproc/command/flags.hpp"
#include "preproc/command/output_files.hpp"
#include "preproc/command/progress_display.hpp"
#include "preproc/command/provenance.hpp"
#include "quality/gates.hpp"
#include "quality/report.hpp"

namespace scan2fea::command {

// What is measured; a reference is what the surface is compared with. `solid_volume` is what `volume_of_solid` of the
// reference gives, where it is known; it is found where it is needed.
struct Subject {
  const SurfaceMesh* surface = nullptr;
  const SurfaceMesh* reference = nullptr;
  std::optional<double> solid_volume;
  bool reference_is_of_bodies = false;  // see DeviationOptions
  const TetMesh* volume_mesh = nullptr;
  const std::vector<StageRecord>* stages = nullptr;
  const RepairResult* repaired = nullptr;
  const PointCloud* cloud = nullptr;             // what the surface is a surface of
  const std::vector<Vec3>* outliers = nullptr;   // of it
  const std::vector<Bridge>* bridges = nullptr;  // of its first surface
  const std::vector<Primitive>* primitives = nullptr;
  const std::vector<MadeSet>* sets = nullptr;
  const SurfaceFaces* faces = nullptr;  // of the scan
  const std::vector<MadeBody>* bodies = nullptr;
  const std::vector<MadeContact>* contacts = nullptr;
  const std::vector<MadeGap>* gaps = nullptr;
  const std::vector<MadeTouch>* touches = nullptr;
  const std::vector<NamedSet>* face_sets = nullptr;  // of the surface; a volume mesh has its own
  std::vector<ReadFile> inputs = {};
  std::optional<std::filesystem::path> output = {};  // the mesh
  std::vector<WrittenFile> written = {};             // it, in all of its files, and what goes with it
  std::uint64_t first_element = 1;                   // the number of the first one in the file
  std::vector<std::uint32_t> element_numbers = {};   // where those of the file are no row from the first on
  Json compared = {};                                // of `compare`, both meshes' figures
};

// The box of what triangles use, its diagonal, and how many vertices and triangles the mesh has; or of points.
Json extent_of(const SurfaceMesh& mesh);
Json extent_of(const std::vector<Vec3>& points);

// All figures but those of single elements, without gates.
Json measure(const Subject& subject, const CommonFlags& flags, const Progress& progress = {});

// Returns whether all gates pass. Stages --json, --junit and --report; says which gates failed.
bool report_figures(const Subject& subject, const CommonFlags& flags, const std::vector<Gate>& gates,
                    ProgressDisplay& display, OutputFiles& outputs);

// Of figures that were measured: adds what they do not say, where they come from and which elements are worst, as far
// as the gates or a file ask for it, evaluates the gates, and stages --json, --junit and --report.
std::vector<GateResult> finish_report(Json& report, const Subject& subject, const CommonFlags& flags,
                                      const std::vector<Gate>& gates, OutputFiles& outputs);

// "scan.ply: 48485 vertices, 96966 triangles, 12.3 x 4.5 x 6.7 mm": a wrong unit is the commonest mistake.
std::string describe_input(const SurfaceMesh& mesh, const CommonFlags& flags);
std::string describe_input(const PointCloud& cloud, const CommonFlags& flags);

}  // namespace scan2fea::command
