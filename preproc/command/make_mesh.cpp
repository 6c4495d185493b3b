#include "preproc/command/make_mesh.hpp"

#include "export/formats.hpp"
#include "preproc/bodies_pipeline.hpp"
#include "preproc/command/caller.hpp"
#include "preproc/command/console.hpp"
#include "preproc/command/deck_needs.hpp"
#include "preproc/command/early_end.hpp"
#include "preproc/command/expected_stages.hpp"
#include "preproc/command/figures.hpp"
#include "preproc/command/gates_asked.hpp"
#include "preproc/command/input_warnings.hpp"
#include "preproc/command/option_text.hpp"
#include "preproc/command/output_files.hpp"
#include "preproc/command/read_inputs.hpp"
#include "preproc/command/size_checks.hpp"
#include "preproc/command/stage_words.hpp"
#include "preproc/command/unused_options.hpp"
#include "preproc/command/write_mesh.hpp"
#include "preproc/mesh/error.hpp"
#include "preproc/mesh/joined.hpp"
#include "preproc/mesh/write_surface.hpp"
#include "preproc/surface/features/feature_file.hpp"

#include <chrono>
#include <cstdio>

namespace scan2fea::command {
namespace {

ExpectedWork work_of(const Scan& scan, const std::vector<Body>& bodies) {
  ExpectedWork work{.scan_triangles = 0, .is_of_bodies = !bodies.empty()};
  for (const Body& body : bodies) work.scan_triangles += static_cast<double>(body.surface.triangles.size());
  if (const auto* cloud = std::get_if<PointCloud>(&scan)) {
    work.is_cloud = true;
    work.scan_triangles = 2 * static_cast<double>(cloud->points.size());
  } else if (bodies.empty()) {
    work.scan_triangles = static_cast<double>(std::get<SurfaceMesh>(scan).triangles.size());
  }
  return work;
}

BoundingBox box_of(const Scan& scan, const std::vector<Body>& bodies) {
  const auto* cloud = std::get_if<PointCloud>(&scan);
  BoundingBox box = bounding_box(cloud != nullptr ? cloud->points : std::get<SurfaceMesh>(scan).vertices);
  for (const Body& body : bodies) {
    const BoundingBox more = bounding_box(body.surface.vertices);
    box = {.low = box.low.cwiseMin(more.low), .high = box.high.cwiseMax(more.high)};
  }
  return box;
}

// The stages know meshes and no files; a person wants to be told which of many files failed.
PipelineResult run_naming_input(Scan& scan, std::vector<Body> bodies, const MakeMeshJob& job, const Progress& progress,
                                ProgressDisplay& display) {
  const std::string input = shown_name(job.common.input);
  ExpectedWork work = work_of(scan, bodies);
  display.expect(expected_stages(job, work));
  const auto tell = [&](const StageRecord& stage) {
    for (const auto& [name, value] : stage.changes)
      if (name == "faces_after") work.triangles = value;
    if (stage.name == "simplify") display.expect(expected_stages(job, work));
    display.line(describe_stage(stage, display.is_verbose()));
    if (!job.common.quiet)
      for (const std::string& warning : stage.warnings) warn(input + ": " + warning);
  };
  if (!bodies.empty()) return run_pipeline_of_bodies(std::move(bodies), job.joining, job.pipeline, progress, tell);
  try {
    if (const auto* cloud = std::get_if<PointCloud>(&scan)) return run_pipeline(*cloud, job.pipeline, progress, tell);
    return run_pipeline(std::move(std::get<SurfaceMesh>(scan)), job.pipeline, progress, tell);
  } catch (WrongUsage&) {
    throw;
  } catch (Cancelled&) {
    throw;
  } catch (Error& error) {
    ErrorParts parts = error.parts();
    parts.where = parts.where.empty() ? input : input + ": " + parts.where;
    error.amend(std::move(parts));
    throw;
  }
}

// A program may want the mesh alone.
bool writes(const MakeMeshJob& job) {
  return !job.output.empty();
}

void require_known_format(const MakeMeshJob& job) {
  if (!writes(job)) return;
  const std::filesystem::path& output = job.output;
  const bool known = job.pipeline.tetrahedralize ? writes_volume(output) : writes_surface(output);
  if (!known)
    throw WrongUsage(
        {.what = "unknown format of the output",
         .where = output.string(),
         .value = output.extension().string(),
         .limit = {},
         .advice = job.pipeline.tetrahedralize ? known_volume_formats() : known_surface_formats_to_write()});
  if (job.pipeline.tetrahedralize) require_parts_fit(output, job.parts);
}

// What remains of the time limit is for measuring and writing, which take longer the more was made. What does not come
// to its end by itself is ended a little later, where it is a process of its own.
Progress limited(const Progress& progress, const MakeMeshJob& job) {
  constexpr double for_improvement = 0.75, for_work = 0.9, latest = 1.15;
  constexpr double three_years = 1e8;  // after three hundred the clock's ticks overflow
  const double limit = std::min(*job.time_limit, three_years);
  char seconds[32];
  std::snprintf(seconds, sizeof seconds, "%.6g s", limit);
  if (job.common.caller == nullptr)
    end_after(std::chrono::duration<double>(latest * limit),
              job.common.input.string() + ": the time limit ended the work before there was a valid mesh (limit: " +
                  seconds + "); try: a longer --time-limit, --effort low, or fewer triangles");
  const auto after = [limit, start = Progress::Clock::now()](double share) {
    return start + std::chrono::duration_cast<Progress::Clock::duration>(std::chrono::duration<double>(share * limit));
  };
  return progress.until(after(for_work), after(for_improvement));
}

void tell_what_was_left_out(const PipelineResult& result, const MakeMeshJob& job) {
  if (result.left_out.empty()) return;
  warn(shown_name(job.common.input) + ": the time limit left out " + joined(result.left_out));
}

// A cloud is thinned to what the triangles need that are asked for: two points a triangle.
void adapt_reconstruction(MakeMeshJob& job) {
  ReconstructOptions& options = job.pipeline.reconstruct;
  if (job.size.faces) options.largest_cloud = std::max(options.largest_cloud, 2 * *job.size.faces);
  if (job.pipeline.repair) options.largest_gap_of_diagonal = job.pipeline.repair->largest_hole_of_diagonal;
}

std::string describe(const Scan& scan, const CommonFlags& flags) {
  return std::visit([&](const auto& input) { return describe_input(input, flags); }, scan);
}

std::vector<std::string> warnings_of(const Scan& scan, const CommonFlags& flags) {
  return std::visit([&](const auto& input) { return input_warnings(input, flags.unit); }, scan);
}

void describe_inputs(const ReadInputs& inputs, const MakeMeshJob& job, ProgressDisplay& display) {
  for (const StageRecord& stage : inputs.stages) display.line(describe_stage(stage, display.is_verbose()));
  if (inputs.bodies.empty()) display.line(describe(inputs.scan, job.common));
  for (const Body& body : inputs.bodies) {
    CommonFlags named = job.common;
    named.input = body.name;
    display.line(describe_input(body.surface, named));
  }
  const auto tell = [&](const std::vector<std::string>& warnings) {
    for (const std::string& warning : warnings) warn(shown_name(job.common.input) + ": " + warning);
  };
  tell(inputs.notes);
  for (const StageRecord& stage : inputs.stages) tell(stage.warnings);
  tell(unused_options(job, inputs));
  tell(warnings_of(inputs.scan, job.common));
}

void parse_sets(MakeMeshJob& job) {
  for (const std::string& text : job.sets) {
    NamedSelection set = parse_selection(text, job.common.unit.value_or(""));
    std::vector<NamedSet> before;
    for (const NamedSelection& other : job.pipeline.sets) before.push_back({other.name, {}});
    if (find_set(before, set.name) < before.size())
      throw WrongUsage({.what = "two sets have the same name",
                        .where = "--set",
                        .value = set.name,
                        .limit = {},
                        .advice = "another name, or one expression with or"});
    job.pipeline.sets.push_back(std::move(set));
  }
}

// Sets that the scan came with stay.
void require_deck(const MakeMeshJob& job, const Scan& scan) {
  if (!job.deck) return;
  DeckSubject subject{.input = job.common.input.string(),
                      .sets = {},
                      .offered = {},
                      .points = nullptr,
                      .unit = job.common.unit.value_or("")};
  for (const NamedSelection& set : job.pipeline.sets) subject.sets.push_back(set.name);
  for (const NamedSet& set : job.pipeline.given_sets) {
    subject.sets.push_back(set.name);
    subject.offered.push_back(set.name);
  }
  const auto* mesh = std::get_if<SurfaceMesh>(&scan);
  subject.points = mesh != nullptr ? &mesh->vertices : &std::get<PointCloud>(scan).points;
  require_for_deck(*job.deck, subject);
}

std::vector<std::filesystem::path> files_of_mesh(const MakeMeshJob& job) {
  return job.pipeline.tetrahedralize ? files_of_volume(job.output, job.parts) : std::vector{job.output};
}

void require_writable_outputs(const MakeMeshJob& job) {
  std::vector<OutputPath> outputs = report_outputs(job.common);
  if (writes(job) && !job.common.stdout_is_data) add_outputs(files_of_mesh(job), outputs);
  if (job.deck) outputs.push_back({deck_file(job.output, *job.deck)});
  if (job.features.write) outputs.push_back({*job.features.write});
  std::vector<std::filesystem::path> inputs = inputs_of(job.common);
  if (job.features.read) inputs.push_back(*job.features.read);
  inputs.insert(inputs.end(), job.more_bodies.begin(), job.more_bodies.end());
  require_writable(outputs, inputs, job.common.force);
}

std::vector<ReadFile> read_files(const MakeMeshJob& job) {
  std::vector<ReadFile> files{{"scan", job.common.input}};
  for (const std::filesystem::path& body : job.more_bodies) files.push_back({"scan", body});
  if (job.features.read) files.push_back({"feature edges", *job.features.read});
  if (job.common.config) files.push_back({"configuration", *job.common.config});
  return files;
}

FileOptions file_options(const MakeMeshJob& job) {
  FileOptions options;
  options.provenance = name_of_input(job.common.input);
  for (const std::filesystem::path& body : job.more_bodies) options.provenance += ", " + body.filename().string();
  options.msh_version = job.msh_version;
  options.set_prefix = job.numbering.set_prefix;
  options.numbers = job.numbering.numbers;
  return options;
}

NamedSurface surface_of(const PipelineResult& result, const MakeMeshJob& job) {
  return {.mesh = result.surface, .node_sets = {}, .face_sets = result.face_sets, .unit = job.common.unit.value_or("")};
}

Notes write_result(const PipelineResult& result, const FileOptions& options, const MakeMeshJob& job) {
  const MeasuredFrom from{.reference = &result.reference(), .measured_vertices = result.measured_vertices};
  if (result.volume_mesh) return write_mesh(*result.volume_mesh, job.output, from, options);
  return write_mesh(surface_of(result, job), job.output, from, options);
}

// To a program.
void hand_over(PipelineResult result, const MakeMeshJob& job) {
  MemoryMesh made{.held = MeshFile(), .name = job.common.input, .provenance = file_options(job).provenance};
  made.measured_vertices = result.measured_vertices;
  auto& file = std::get<MeshFile>(made.held);
  if (result.volume_mesh)
    file.mesh = std::move(*result.volume_mesh);
  else
    file.mesh = surface_of(result, job);
  made.reference = std::make_shared<SurfaceMesh>(result.given ? std::move(*result.given) : std::move(result.scan));
  job.common.caller->made = std::make_shared<MemoryMesh>(std::move(made));
}

// The mesh goes there, and nothing else.
void take_stdout(const PipedOutput& piped, MakeMeshJob& job) {
  job.output = piped.file();
  job.common.stdout_is_data = piped.is_pipe();
  if (!piped.is_pipe()) return;
  const char* other = job.common.json == "-"    ? "--json -"
                      : job.common.junit == "-" ? "--junit -"
                      : job.deck                ? "--deck, which names its mesh"
                                                : nullptr;
  if (other != nullptr)
    throw WrongUsage({.what = "not with the mesh on standard output",
                      .where = {},
                      .value = other,
                      .limit = {},
                      .advice = "-o FILE"});
}

// What the flags say together, and what of it needs the names and the unit of what was read.
void settle_options(MakeMeshJob& job) {
  if (!job.enrich_domain.empty())
    job.pipeline.enrich_domain = parse_selection("domain=" + job.enrich_domain, job.common.unit.value_or(""));
  if (job.features.read) job.pipeline.simplify->given_features = read_feature_lines(*job.features.read);
  if (job.pipeline.simplify) job.pipeline.simplify->size = job.size.target();
  adapt_reconstruction(job);
  if (job.enrich) job.pipeline.enrich = job.enrich_options;
}

std::optional<std::filesystem::path> output_of(const MakeMeshJob& job) {
  if (!writes(job)) return {};
  return job.common.stdout_is_data ? "-" : job.output;
}

Subject subject_of(const PipelineResult& result, const SurfaceMesh& boundary, const Scan& scan,
                   const MakeMeshJob& job) {
  return {.surface = result.volume_mesh ? &boundary : &result.surface,
          .reference = &result.reference(),
          .solid_volume = result.solid_volume,
          .reference_is_of_bodies = !result.bodies.empty(),
          .volume_mesh = result.volume_mesh ? &*result.volume_mesh : nullptr,
          .stages = &result.stages,
          .repaired = &result.repaired,
          .cloud = std::get_if<PointCloud>(&scan),
          .outliers = &result.outliers,
          .bridges = &result.bridges,
          .primitives = &result.primitives,
          .sets = &result.sets,
          .faces = &result.faces,
          .bodies = &result.bodies,
          .contacts = &result.contacts,
          .gaps = &result.gaps,
          .touches = &result.touches,
          .face_sets = &result.face_sets,
          .inputs = read_files(job),
          .output = output_of(job),
          .first_element = writes(job) ? first_element_of(job.output, job.numbering.numbers) : 0,
          .element_numbers = {}};
}

// All that goes with the mesh; not in place before the gates have passed.
void write_all(PipelineResult& result, const MakeMeshJob& job, ProgressDisplay& display, OutputFiles& outputs) {
  FileOptions options = file_options(job);
  options.together = &outputs;
  if (result.volume_mesh)
    if (const std::string told = divide(*result.volume_mesh, job.parts, options); !told.empty()) display.line(told);
  if (job.deck) {
    const std::filesystem::path file = deck_file(job.output, *job.deck);
    outputs.add(file, deck_text(*result.volume_mesh, job.output, *job.deck, options));
    display.line("a deck: " + file.string());
  }
  if (job.features.write) outputs.add(*job.features.write, text_of(result.features));
  for (const std::string& note : write_result(result, options, job))
    if (!job.common.quiet) warn(note);
}

std::vector<WrittenFile> written_files(const OutputFiles& outputs, const MakeMeshJob& job) {
  std::vector<WrittenFile> files;
  for (const OutputFile& file : outputs) {
    const bool is_deck = job.deck && file.name() == deck_file(job.output, *job.deck);
    const bool is_lines = job.features.write && file.name() == *job.features.write;
    files.push_back({.role = is_deck    ? "deck"
                             : is_lines ? "feature edges"
                                        : "mesh",
                     .path = job.common.stdout_is_data && !is_lines ? "-" : file.name(),
                     .readable = file.readable_path()});
  }
  return files;
}

}  // namespace

void add_surface_flags(CLI::App& command, MakeMeshJob& job) {
  job.declared = &command;
  add_common_flags(command, job.common);
  add_output_flag(command, job.output);
  add_to_flag(command, job.common.formats.to);
  add_time_limit_flag(command, job.time_limit);
  add_size_flags(command, job.size);
  add_thinning_flag(command, job.largest_scan);
  add_reconstruct_flags(command, job.pipeline.reconstruct);
  add_repair_flags(command, *job.pipeline.repair);
  {
    const OptionGroup group(command, enrichment_group);
    command.add_flag("--enrich", job.enrich, "First add points where the scanner left too few (see scan2fea enrich)");
  }
  add_enrich_flags(command, job.enrich_options, job.enrich_domain);
  add_simplify_flags(command, *job.pipeline.simplify);
  add_feature_file_flags(command, job.features);
  add_set_flag(command, job.sets);
  add_face_flags(command, job.pipeline.name_faces, job.pipeline.idealise);
  add_symmetry_flag(command, job.pipeline.symmetry);
  add_effort_flag(command, job.pipeline);
}

int make_mesh(MakeMeshJob job) {
  std::optional<ProgressDisplay> own;
  ProgressDisplay& display = display_of(job.common, own);
  const Progress progress = job.time_limit ? limited(display.progress(), job) : display.progress();
  const PipedOutput piped(job.output, job.common.formats.to);
  take_stdout(piped, job);
  require_known_format(job);
  require_writable_outputs(job);
  const std::vector<Gate> gates = gates_for(parse_gates(job.common), job.pipeline.tetrahedralize.has_value());

  display.expect(expected_stages(job, expected_work(job)));
  display.begin("read");
  ReadInputs inputs = read_inputs(job, progress);
  Scan& scan = inputs.scan;
  parse_sets(job);
  require_deck(job, scan);
  describe_inputs(inputs, job, display);
  settle_options(job);
  require_lengths_within(box_of(scan, inputs.bodies), job);
  PipelineResult result = run_naming_input(scan, std::move(inputs.bodies), job, progress, display);
  result.stages.insert(result.stages.begin(), inputs.stages.begin(), inputs.stages.end());
  tell_what_was_left_out(result, job);
  for (const WeakPlace& place : result.weak_places)
    warn(shown_name(job.common.input) + ": " + place.describe() + "; a solver may refuse it");

  OutputFiles outputs, figures;
  if (result.volume_mesh) result.volume_mesh->unit = job.common.unit.value_or("");
  display.begin("write");
  if (writes(job)) {
    write_all(result, job, display, outputs);
    // What is measured is what the file holds.
    round_to_file(result.volume_mesh ? result.volume_mesh->nodes : result.surface.vertices, job.output);
  }
  if (!job.common.quiet || job.common.json || job.common.report || !gates.empty()) {
    // As `check` will find it in the file.
    const SurfaceMesh boundary = result.volume_mesh ? boundary_surface(*result.volume_mesh) : SurfaceMesh{};
    Subject subject = subject_of(result, boundary, scan, job);
    subject.written = written_files(outputs, job);
    if (!report_figures(subject, job.common, gates, display, figures)) {
      figures.commit();
      return 1;
    }
  }
  outputs.commit();
  figures.commit();
  piped.send();
  if (job.common.caller == nullptr) ends_by_itself_now();
  display.finish();
  if (job.common.caller != nullptr) hand_over(std::move(result), job);
  return 0;
}

}  // namespace scan2fea::command
