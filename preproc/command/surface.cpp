#include "preproc/command/make_mesh.hpp"
#include "preproc/command/sub_commands.hpp"

namespace scan2fea::command {

SubCommand add_surface(CLI::App& root) {
  const auto job = std::make_shared<MakeMeshJob>();
  job->pipeline.tetrahedralize.reset();
  CLI::App* app = root.add_subcommand("surface", "The surface stages alone: repair, enrich, simplify");
  add_common_flags(*app, job->common);
  add_output_flag(*app, job->output);
  add_size_flags(*app, job->size);
  add_repair_flags(*app, *job->pipeline.repair);
  add_optional_enrich_flags(*app, *job);
  add_simplify_flags(*app, *job->pipeline.simplify);
  return {app, [job] { return make_mesh(*job); }};
}

}  // namespace scan2fea::command
