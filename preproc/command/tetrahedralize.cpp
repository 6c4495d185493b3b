#include "preproc/command/make_mesh.hpp"
#include "preproc/command/sub_commands.hpp"
#include "preproc/command/written_file_flags.hpp"

namespace scan2fea::command {

SubCommand add_tetrahedralize(CLI::App& root) {
  const auto job = std::make_shared<MakeMeshJob>();
  job->pipeline = {.reconstruct = {}, .repair = {}, .enrich = {}, .simplify = {}, .tetrahedralize = {}, .order = 1};
  job->pipeline.tetrahedralize.emplace();
  CLI::App* app =
      root.add_subcommand("tetrahedralize", "One stage: fill a closed surface with tetrahedra, its triangles kept");
  app->group(stage_group);
  app->footer(
      "Examples:\n"
      "  scan2fea tetrahedralize part.ply -o part.msh --order 2");
  add_common_flags(*app, job->common);
  add_output_flag(*app, job->output);
  add_to_flag(*app, job->common.formats.to);
  add_time_limit_flag(*app, job->time_limit);
  add_effort_flag(*app, job->pipeline);
  add_tetrahedralize_flags(*app, *job->pipeline.tetrahedralize, job->pipeline.order);
  add_parts_flag(*app, job->parts);
  add_msh_version_flag(*app, job->msh_version);
  add_number_flags(*app, job->numbering);
  return {app, [job] { return make_mesh(*job); }, &job->common};
}

}  // namespace scan2fea::command
