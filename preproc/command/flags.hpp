// The flags that sub-commands share. Each `add_...` declares one group of them on a sub-command and binds it to a
// field.
#pragma once

#include "preproc/pipeline.hpp"

#include <CLI/App.hpp>

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace scan2fea::command {

// What every sub-command that makes or measures a mesh knows.
struct CommonFlags {
  std::filesystem::path input;
  std::optional<std::filesystem::path> json;    // "-" is stdout
  std::optional<std::filesystem::path> report;  // a folder
  bool report_pdf = false;                      // report.pdf in it, too
  std::optional<std::filesystem::path> config;
  std::vector<std::string> require;
  std::vector<std::string> gates;              // names of sets, see limits.hpp
  std::optional<std::filesystem::path> junit;  // "-" is stdout
  std::optional<std::string> unit;
  std::uint64_t seed = 1;  // of the random points by which distances are measured
  int threads = 0;         // 0: all
  bool force = false;      // overwrite existing outputs
  bool quiet = false;
};

// A length in model units, or as a share of something the input tells.
struct RelativeLength {
  double value = 0;
  bool relative = false;
};

// "0.5" or, with the suffix, "0.1%" (returned as 0.001) or "1.6x". Throws CLI::ValidationError.
inline constexpr char no_suffix = 0;
RelativeLength parse_length(const std::string& flag, const std::string& text, char suffix);

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
void add_output_flag(CLI::App& command, std::filesystem::path& output);
void add_time_limit_flag(CLI::App& command, std::optional<double>& seconds);
void add_force_flag(CLI::App& command, bool& force);  // of all that take no common flags
void add_size_flags(CLI::App& command, SizeFlags& flags);
void add_reconstruct_flags(CLI::App& command, ReconstructOptions& options);
void add_repair_flags(CLI::App& command, RepairOptions& options);
void add_enrich_flags(CLI::App& command, EnrichOptions& options, std::string& domain);
void add_simplify_flags(CLI::App& command, SimplifyOptions& options);
void add_feature_angle_flag(CLI::App& command, FeatureOptions& features);
void add_set_flag(CLI::App& command, std::vector<std::string>& sets);
void add_face_flags(CLI::App& command, bool& name_faces, std::optional<Idealise>& idealise);
void add_symmetry_flag(CLI::App& command, std::optional<SymmetryOptions>& symmetry);
void add_feature_file_flags(CLI::App& command, FeatureFileFlags& flags);  // after add_simplify_flags
// For the stages that `options` has by then.
void add_effort_flag(CLI::App& command, PipelineOptions& options);
void add_tetrahedralize_flags(CLI::App& command, TetrahedralizeOptions& options, int& order);
void add_contact_flag(CLI::App& command, std::optional<double>& tolerance);

}  // namespace scan2fea::command
