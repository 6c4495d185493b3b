// The flags that sub-commands share. Each `add_...` declares one group of them on a sub-command and binds it to a
// field.
#pragma once

#include "preproc/command/option_values.hpp"
#include "preproc/command/piped_files.hpp"
#include "preproc/command/progress_display.hpp"
#include "preproc/pipeline.hpp"

#include <CLI/App.hpp>

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace scan2fea::command {

// What every sub-command that makes or measures a mesh knows.
struct CommonFlags : DisplayFlags {
  std::filesystem::path input;                  // "-" is stdin
  std::optional<std::filesystem::path> json;    // "-" is stdout
  std::optional<std::filesystem::path> report;  // a folder
  bool report_pdf = false;                      // report.pdf in it, too
  std::optional<std::filesystem::path> config;
  std::vector<std::string> require;
  std::vector<std::string> gates;              // names of sets, see limits.hpp
  std::optional<std::filesystem::path> junit;  // "-" is stdout
  std::optional<std::string> unit;
  std::uint64_t seed = 1;       // of the random points by which distances are measured
  int threads = 0;              // 0: all
  bool force = false;           // overwrite existing outputs
  PipeFlags formats;            // of what comes and goes through pipes
  bool stdout_is_data = false;  // then no table of figures goes there
};

// The size flags; at most one is set.
struct SizeFlags {
  std::optional<std::size_t> faces;
  std::optional<double> ratio;
  std::optional<double> edge_length;
  std::optional<RelativeLength> deviation;

  TargetSize target() const;  // with no flag the library's default
};

// Feature edges in and out, see feature_file.hpp.
struct FeatureFileFlags {
  std::optional<std::filesystem::path> write;
  std::optional<std::filesystem::path> read;
};

void add_unit_flag(CLI::App& command, std::optional<std::string>& unit);  // its short name, whatever the user writes
void add_common_flags(CLI::App& command, CommonFlags& flags);
void add_figure_flags(CLI::App& command, CommonFlags& flags);  // of these
void add_output_flag(CLI::App& command, std::filesystem::path& output);
void add_time_limit_flag(CLI::App& command, std::optional<double>& seconds);
void add_force_flag(CLI::App& command, bool& force);             // of all that take no common flags
void add_display_flags(CLI::App& command, DisplayFlags& flags);  // the same
void add_size_flags(CLI::App& command, SizeFlags& flags);
void add_thinning_flag(CLI::App& command, std::optional<std::size_t>& largest_scan);  // which it sets
// Groups of options that count for some inputs only.
inline constexpr const char *clouds_group = "Clouds", *enrichment_group = "Enrichment",
                            *bodies_group = "Several bodies";

void add_reconstruct_flags(CLI::App& command, ReconstructOptions& options);
void add_repair_flags(CLI::App& command, RepairOptions& options);
void add_enrich_flags(CLI::App& command, EnrichOptions& options, std::string& domain);
void add_simplify_flags(CLI::App& command, SimplifyOptions& options);
void add_method_flags(CLI::App& command, SimplifyOptions& options);  // of these
void add_feature_angle_flag(CLI::App& command, FeatureOptions& features);
void add_set_flag(CLI::App& command, std::vector<std::string>& sets);
void add_face_flags(CLI::App& command, bool& name_faces, std::optional<Idealise>& idealise);
void add_slide_flag(CLI::App& command, std::optional<SlideOptions>& slide);
void add_layers_flag(CLI::App& command, std::vector<LayerOptions>& layers);
void add_symmetry_flag(CLI::App& command, std::optional<SymmetryOptions>& symmetry);
void add_feature_file_flags(CLI::App& command, FeatureFileFlags& flags);  // after add_simplify_flags
// For the stages that `options` has by then.
void add_effort_flag(CLI::App& command, PipelineOptions& options);
void add_tetrahedralize_flags(CLI::App& command, TetrahedralizeOptions& options, int& order);
void add_contact_flag(CLI::App& command, std::optional<double>& tolerance);

}  // namespace scan2fea::command
