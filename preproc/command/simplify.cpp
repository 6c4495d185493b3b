#include "preproc/command/make_mesh.hpp"
#include "preproc/command/sub_commands.hpp"

namespace scan2fea::command {

SubCommand add_simplify(CLI::App& root) {
  const auto job = std::make_shared<MakeMeshJob>();
  job->pipeline = {.reconstruct = {}, .repair = {}, .enrich = {}, .simplify = {}, .tetrahedralize = {}, .order = 1};
  job->pipeline.simplify.emplace();
  CLI::App* app = root.add_subcommand("simplify", "One stage: fewer and better triangles on a repaired surface");
  app->group(stage_group);
  app->footer(
      "Examples:\n"
      "  scan2fea simplify closed.ply -o part.ply --faces 5000");
  add_common_flags(*app, job->common);
  add_output_flag(*app, job->output);
  add_to_flag(*app, job->common.formats.to);
  add_time_limit_flag(*app, job->time_limit);
  add_size_flags(*app, job->size);
  add_simplify_flags(*app, *job->pipeline.simplify);
  add_feature_file_flags(*app, job->features);
  add_effort_flag(*app, job->pipeline);
  return {app, [job] { return make_mesh(*job); }, &job->common};
}

}  // namespace scan2fea::command
