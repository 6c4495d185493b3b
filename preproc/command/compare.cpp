#include "export/formats.hpp"
#include "export/units.hpp"
#include "preproc/command/expected_stages.hpp"
#include "preproc/command/figures.hpp"
#include "preproc/command/gates_asked.hpp"
#include "preproc/command/loaded_mesh.hpp"
#include "preproc/command/option_text.hpp"
#include "preproc/command/output_files.hpp"
#include "preproc/command/sub_commands.hpp"

#include <nlohmann/json.hpp>

namespace scan2fea::command {
namespace {

struct CompareFlags {
  CommonFlags common;  // whose input is the first mesh
  std::filesystem::path second;
  std::optional<std::filesystem::path> reference;
};

// One of the two, against the scan where there is one.
Json column(const LoadedMesh& mesh, const std::filesystem::path& file, const CompareFlags& flags,
            const LoadedReference& reference) {
  CommonFlags common = flags.common;
  common.input = file;
  Subject subject = subject_of(mesh);
  compare_with(reference, subject);
  return measure(subject, common);
}

int compare(CompareFlags flags) {
  const AskedGates asked = parse_gates(flags.common);
  require_no_pipe(flags.second);
  std::vector<std::filesystem::path> inputs = inputs_of(flags.common);
  inputs.push_back(flags.second);
  if (flags.reference) inputs.push_back(*flags.reference);
  require_writable(report_outputs(flags.common), inputs, flags.common.force);
  ProgressDisplay display(flags.common);
  display.expect(expected_measuring({flags.common.input, flags.second}, flags.common));
  display.begin("read");
  const LoadedMesh first = load_mesh(file_to_read(flags.common.input, flags.common.formats.from)),
                   second = load_mesh(flags.second);
  const std::vector<Gate> gates = gates_for(asked, second.volume_mesh.has_value());
  const std::string unit =
      settled_unit(first.unit.empty() ? second.unit : first.unit, flags.common.unit, flags.common.input.string());
  require_same_unit(unit, second.unit, flags.second.string());
  if (!unit.empty()) flags.common.unit = unit;
  LoadedReference scan;
  if (flags.reference) scan = load_references({*flags.reference}, unit);

  // The second one as `check --reference` measures it against the first.
  const LoadedReference as_reference = reference_of(first);
  Subject subject = subject_of(second);
  compare_with(as_reference, subject);
  subject.inputs = {{"first mesh", flags.common.input}, {"second mesh", flags.second}};
  if (flags.reference) subject.inputs.push_back({"reference", *flags.reference});
  if (flags.common.config) subject.inputs.push_back({"configuration", *flags.common.config});
  subject.first_element = first_element_of(flags.second);
  subject.compared = {{"first", column(first, flags.common.input, flags, scan)},
                      {"second", column(second, flags.second, flags, scan)}};
  if (scan.surface) subject.compared["reference"] = extent_of(*scan.surface);
  flags.common.input = flags.second;
  OutputFiles outputs;
  const bool all_pass = report_figures(subject, flags.common, gates, display, outputs);
  outputs.commit();
  display.finish();
  return all_pass ? 0 : 1;
}

}  // namespace

SubCommand add_compare(CLI::App& root) {
  const auto flags = std::make_shared<CompareFlags>();
  CLI::App* app =
      root.add_subcommand("compare", "Two meshes side by side: before and after, or of two ways to make one");
  app->group(look_group);
  app->footer(
      "Examples:\n"
      "  scan2fea compare before.inp after.inp --reference scan.ply --report both");
  add_common_flags(*app, flags->common);
  app->get_option("input")->description("The first mesh, from which the second is measured");
  app->add_option("second", flags->second, "The second mesh")->required()->type_name("FILE");
  const OptionGroup group(*app, "Figures, gates and reports");
  app->add_option("--reference", flags->reference, "What both are measured from, too, usually the scan")
      ->type_name("FILE");
  return {app, [flags] { return compare(*flags); }};
}

}  // namespace scan2fea::command
