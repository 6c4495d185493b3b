#include "preproc/command/make_mesh.hpp"
#include "preproc/command/sub_commands.hpp"

namespace scan2fea::command {

SubCommand add_enrich(CLI::App& root) {
  const auto job = std::make_shared<MakeMeshJob>();
  job->pipeline = {.reconstruct = {}, .repair = {}, .enrich = {}, .simplify = {}, .tetrahedralize = {}, .order = 1};
  job->pipeline.enrich.emplace();
  CLI::App* app = root.add_subcommand("enrich", "One stage: add points where the scanner left too few");
  app->group(stage_group);
  app->footer(
      "Examples:\n"
      "  scan2fea enrich scan.ply -o dense.ply");
  add_common_flags(*app, job->common);
  add_output_flag(*app, job->output);
  add_to_flag(*app, job->common.formats.to);
  add_time_limit_flag(*app, job->time_limit);
  add_enrich_flags(*app, *job->pipeline.enrich, job->enrich_domain);
  return {app, [job] { return make_mesh(*job); }, &job->common};
}

}  // namespace scan2fea::command
