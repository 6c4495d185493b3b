#include "preproc/command/make_mesh.hpp"
#include "preproc/command/option_text.hpp"
#include "preproc/command/sub_commands.hpp"
#include "preproc/command/written_file_flags.hpp"
#include "preproc/mesh/error.hpp"

namespace scan2fea::command {

SubCommand add_run(CLI::App& root) {
  const auto job = std::make_shared<MakeMeshJob>();
  job->takes_clouds = TakesClouds::too;
  CLI::App* app = root.add_subcommand("run", "The whole chain: a scan or a point cloud in, a mesh for a solver out");
  app->group(chain_group);
  app->footer(
      "Examples:\n"
      "  scan2fea run scan.ply -o part.inp --unit mm\n"
      "  scan2fea run scan.ply -o part.inp --faces 12000 --order 2 --report part-report\n"
      "  scan2fea run bracket.stl pin.stl -o both.inp --unit mm\n"
      "  scan2fea run - --from stl -o - --to inp < scan.stl > part.inp\n"
      "  scan2fea run scan.ply -o part.inp --faces 12000 --print-config > part.toml");
  add_surface_flags(*app, *job);
  app->get_option("input")->description("What to read");
  app->add_option("more", job->more_bodies, "More bodies, each a file: they share nodes where they touch")
      ->type_name("FILE");
  add_contact_flag(*app, job->joining.tolerance);
  const OptionGroup group(*app, bodies_group);
  app->add_flag("--one-body", job->one_body, "One body of all that is read: what overlaps is united");
  app->get_option("--holes")->description(
      "What becomes of holes: close; with keep no volume fits in (scan2fea surface)");
  add_tetrahedralize_flags(*app, *job->pipeline.tetrahedralize, job->pipeline.order);
  add_slide_flag(*app, job->pipeline.slide);
  add_layers_flag(*app, job->pipeline.layers);
  add_deck_flag(*app, job->deck);
  add_parts_flag(*app, job->parts);
  add_msh_version_flag(*app, job->msh_version);
  add_number_flags(*app, job->numbering);
  return {app,
          [job] {
            if (job->pipeline.repair->holes == Holes::keep)
              throw WrongUsage({.what = "a volume needs a closed surface",
                                .where = {},
                                .value = "--holes keep",
                                .limit = "--holes close",
                                .advice = "scan2fea surface for an open one"});
            return make_mesh(*job);
          },
          &job->common};
}

}  // namespace scan2fea::command
