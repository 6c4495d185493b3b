// The sub-commands, one file each. Every `add_...` declares one on the root and says how to execute it.
#pragma once

#include <CLI/App.hpp>

#include <functional>

namespace scan2fea::command {

struct DisplayFlags;

struct SubCommand {
  CLI::App* app;
  std::function<int()> execute;   // called after all flags and the configuration are in; returns the exit status
  DisplayFlags* flags = nullptr;  // of those that work on meshes in memory, too: where they learn who calls
};

SubCommand add_run(CLI::App& root);
SubCommand add_surface(CLI::App& root);
SubCommand add_reconstruct(CLI::App& root);
SubCommand add_repair(CLI::App& root);
SubCommand add_enrich(CLI::App& root);
SubCommand add_simplify(CLI::App& root);
SubCommand add_tetrahedralize(CLI::App& root);
SubCommand add_faces(CLI::App& root);
SubCommand add_check(CLI::App& root);
SubCommand add_compare(CLI::App& root);
SubCommand add_convert(CLI::App& root);
SubCommand add_picture(CLI::App& root);
SubCommand add_completion(CLI::App& root);
SubCommand add_manual(CLI::App& root);

// As the help lists them.
inline constexpr const char *chain_group = "From scan to mesh", *stage_group = "One stage of it",
                            *look_group = "Looking and converting", *help_group = "Help";

}  // namespace scan2fea::command
