#include "export/formats.hpp"
#include "preproc/command/flags.hpp"
#include "preproc/command/output_files.hpp"
#include "preproc/command/progress_display.hpp"
#include "preproc/command/sub_commands.hpp"
#include "preproc/mesh/error.hpp"
#include "preproc/mesh/read_surface.hpp"
#include "preproc/mesh/write_surface.hpp"

namespace scan2fea::command {
namespace {

struct ConvertFlags {
  std::filesystem::path input;
  std::filesystem::path output;
  bool force = false;
  std::optional<std::string> unit;
  MshVersion msh_version = MshVersion::v4_1;
  bool quiet = false;
};

int convert(const ConvertFlags& flags) {
  require_writable({{flags.output}}, {flags.input}, flags.force);
  ProgressDisplay display(flags.quiet);
  const bool volume_in = volume_format(flags.input).has_value();
  const bool volume_out = volume_format(flags.output).has_value();
  if (volume_out && !volume_in)
    throw WrongUsage({.what = "a surface holds no tetrahedra to write",
                      .where = flags.input.string(),
                      .value = {},
                      .limit = {},
                      .advice = "scan2fea tetrahedralize, or scan2fea run"});
  if (volume_in && volume_out) {
    const VolumeFileOptions options{.unit = flags.unit.value_or(""),
                                    .provenance = flags.input.filename().string(),
                                    .msh_version = flags.msh_version};
    for (const std::string& warning : write_volume(read_volume(flags.input), flags.output, options).warnings)
      display.line("warning: " + warning);
  } else if (volume_in) {
    write_surface(boundary_surface(read_volume(flags.input)), flags.output);
    display.line("the boundary was written; " + flags.output.string() + " holds no tetrahedra");
  } else {
    write_surface(read_surface(flags.input), flags.output);
  }
  return 0;
}

}  // namespace

SubCommand add_convert(CLI::App& root) {
  const auto flags = std::make_shared<ConvertFlags>();
  CLI::App* app =
      root.add_subcommand("convert", "Between all formats; a volume mesh into a surface gives its boundary");
  app->add_option("input", flags->input, "What to read")->required()->type_name("FILE");
  add_output_flag(*app, flags->output);
  add_force_flag(*app, flags->force);
  app->add_option("--unit", flags->unit, "Length unit, recorded in what is written")
      ->check(CLI::IsMember({"um", "mm", "cm", "m", "in", "ft"}))
      ->type_name("UNIT");
  add_msh_version_flag(*app, flags->msh_version);
  app->add_flag("--quiet", flags->quiet, "No messages but errors");
  return {app, [flags] { return convert(*flags); }};
}

}  // namespace scan2fea::command
