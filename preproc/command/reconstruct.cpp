#include "preproc/command/make_mesh.hpp"
#include "preproc/command/sub_commands.hpp"

namespace scan2fea::command {

SubCommand add_reconstruct(CLI::App& root) {
  const auto job = std::make_shared<MakeMeshJob>();
  job->pipeline = {.reconstruct = {}, .repair = {}, .enrich = {}, .simplify = {}, .tetrahedralize = {}, .order = 1};
  job->pipeline.repair.emplace();
  job->takes_clouds = TakesClouds::only;
  CLI::App* app = root.add_subcommand(
      "reconstruct", "One stage: a closed surface through the points of a cloud, or of a surface's vertices");
  app->group(stage_group);
  app->footer(
      "Examples:\n"
      "  scan2fea reconstruct cloud.las -o surface.ply");
  add_common_flags(*app, job->common);
  add_output_flag(*app, job->output);
  add_to_flag(*app, job->common.formats.to);
  add_time_limit_flag(*app, job->time_limit);
  add_reconstruct_flags(*app, job->pipeline.reconstruct);
  add_repair_flags(*app, *job->pipeline.repair);
  return {app, [job] { return make_mesh(*job); }, &job->common};
}

}  // namespace scan2fea::command
