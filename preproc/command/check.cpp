#include "export/formats.hpp"
#include "export/units.hpp"
#include "preproc/command/console.hpp"
#include "preproc/command/expected_stages.hpp"
#include "preproc/command/figures.hpp"
#include "preproc/command/gates_asked.hpp"
#include "preproc/command/loaded_mesh.hpp"
#include "preproc/command/option_text.hpp"
#include "preproc/command/output_files.hpp"
#include "preproc/command/piped_files.hpp"
#include "preproc/command/sub_commands.hpp"
#include "preproc/mesh/error.hpp"
#include "preproc/mesh/error_text.hpp"
#include "preproc/surface/features/feature_file.hpp"
#include "preproc/surface/repair/openings.hpp"

#include <algorithm>

namespace scan2fea::command {
namespace {

struct CheckFlags {
  CommonFlags common;
  std::vector<std::filesystem::path> references;  // several are bodies
  std::optional<std::filesystem::path> leaks;
};

// The openings' borders, for viewers, and the largest as lines of text.
void tell_leaks(const std::vector<Opening>& openings, ProgressDisplay& display) {
  constexpr std::size_t most_lines = 8;
  display.line(openings.empty() ? "no openings: the surface bounds a volume"
                                : std::to_string(openings.size()) + (openings.size() == 1 ? " opening" : " openings"));
  for (std::size_t i = 0; i < std::min(openings.size(), most_lines); ++i)
    display.line("  at " + error_text(openings[i].place) + ", size " + error_text(openings[i].size) +
                 ", border of length " + error_text(openings[i].length));
  if (openings.size() > most_lines) display.line("  ... and " + std::to_string(openings.size() - most_lines) + " more");
}

FeatureLines lines_of(const std::vector<Opening>& openings) {
  FeatureLines lines;
  for (const Opening& opening : openings) {
    const auto first = static_cast<std::uint32_t>(lines.points.size());
    lines.points.insert(lines.points.end(), opening.border.begin(), opening.border.end());
    for (auto i = first; i < lines.points.size(); ++i)
      lines.segments.push_back({i, i + 1 < lines.points.size() ? i + 1 : first});
  }
  return lines;
}

std::vector<ReadFile> read_files(const CheckFlags& flags) {
  std::vector<ReadFile> files{{"mesh", flags.common.input}};
  for (const std::filesystem::path& reference : flags.references) files.push_back({"reference", reference});
  if (flags.common.config) files.push_back({"configuration", *flags.common.config});
  return files;
}

int check(CheckFlags flags) {
  const AskedGates asked = parse_gates(flags.common);
  std::vector<std::filesystem::path> inputs = inputs_of(flags.common);
  inputs.insert(inputs.end(), flags.references.begin(), flags.references.end());
  std::vector<OutputPath> files = report_outputs(flags.common);
  if (flags.leaks) files.push_back({*flags.leaks});
  require_writable(files, inputs, flags.common.force);
  std::optional<ProgressDisplay> own;
  ProgressDisplay& display = display_of(flags.common, own);
  std::vector<std::filesystem::path> read{flags.common.input};
  read.insert(read.end(), flags.references.begin(), flags.references.end());
  display.expect(expected_measuring(read, flags.common));
  display.begin("read");
  const MemoryMesh* given = flags.common.caller != nullptr ? flags.common.caller->input(0) : nullptr;
  const std::filesystem::path file =
      given != nullptr ? given->name : file_to_read(flags.common.input, flags.common.formats.from);
  const std::uint64_t first_element = given != nullptr ? given->first_element : first_element_of(file);
  const LoadedMesh mesh = loaded(given != nullptr ? mesh_in(*given) : read_mesh(file), first_element);
  const std::string unit = settled_unit(mesh.unit, flags.common.unit, flags.common.input.string());
  if (!unit.empty()) flags.common.unit = unit;
  const std::vector<Gate> gates = gates_for(asked, mesh.volume_mesh.has_value());
  display.line(describe_input(mesh.surface, flags.common));
  if (const auto doubt = implausible_size(bounding_box(mesh.surface.vertices).diagonal(), unit); doubt && !unit.empty())
    warn(shown_name(flags.common.input) + ": " + *doubt);
  const LoadedReference reference = load_references(flags.references, unit, flags.common.caller);
  Subject subject = subject_of(mesh);
  compare_with(reference, subject);
  subject.inputs = read_files(flags);
  subject.first_element = first_element;
  OutputFiles outputs;
  if (flags.leaks) {
    const std::vector<Opening> openings = find_openings(mesh.surface);
    tell_leaks(openings, display);
    outputs.add(*flags.leaks, text_of(lines_of(openings)));
  }
  const bool all_pass = report_figures(subject, flags.common, gates, display, outputs);
  outputs.commit();
  display.finish();
  return all_pass ? 0 : 1;
}

}  // namespace

SubCommand add_check(CLI::App& root) {
  const auto flags = std::make_shared<CheckFlags>();
  CLI::App* app = root.add_subcommand("check", "Figures and gates of a surface or a volume mesh");
  app->group(look_group);
  app->footer(
      "Examples:\n"
      "  scan2fea check scan.ply\n"
      "  scan2fea check part.inp --reference scan.ply --json -");
  add_common_flags(*app, flags->common);
  const OptionGroup group(*app, "Figures, gates and reports");
  app->add_option("--reference", flags->references,
                  "What the surface is compared with, usually the scan; of a cloud, its points' distances; of several "
                  "bodies, the option for each")
      ->type_name("FILE")
      ->allow_extra_args(false);
  app->add_option("--leaks", flags->leaks,
                  "Write the borders of the openings that the surface leaks through: OBJ lines")
      ->type_name("FILE");
  return {app, [flags] { return check(*flags); }, &flags->common};
}

}  // namespace scan2fea::command
