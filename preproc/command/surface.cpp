#include "preproc/command/make_mesh.hpp"
#include "preproc/command/sub_commands.hpp"

namespace scan2fea::command {

SubCommand add_surface(CLI::App& root) {
  const auto job = std::make_shared<MakeMeshJob>();
  job->pipeline.tetrahedralize.reset();
  job->takes_clouds = TakesClouds::too;
  CLI::App* app =
      root.add_subcommand("surface", "The surface stages alone: of a cloud reconstruct, repair, enrich, simplify");
  app->group(chain_group);
  app->footer(
      "Examples:\n"
      "  scan2fea surface scan.stl -o part.stl --edge-length 1.5");
  add_surface_flags(*app, *job);
  return {app, [job] { return make_mesh(*job); }, &job->common};
}

}  // namespace scan2fea::command
