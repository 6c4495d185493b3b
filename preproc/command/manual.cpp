// The manual page, in the language of man(7).
#include "preproc/command/manual.hpp"

#include "preproc/command/option_text.hpp"
#include "preproc/command/piped_files.hpp"
#include "preproc/command/sub_commands.hpp"
#include "preproc/mesh/joined.hpp"

#include <scan2fea/version.hpp>

#include <algorithm>
#include <map>
#include <sstream>

namespace scan2fea::command {
namespace {

// A hyphen that is typed, no backslash that is not meant, and no request by a point or quote at a line's start.
std::string escaped(const std::string& text) {
  std::string out;
  for (const char c : text) {
    if (c == '\\')
      out += "\\e";
    else if (c == '-')
      out += "\\-";
    else if (c == '\'' || c == '.')
      out += (out.empty() || out.back() == '\n') ? std::string("\\&") + c : std::string(1, c);
    else
      out += c;
  }
  return out;
}

std::string bold(const std::string& text) {
  return "\\fB" + escaped(text) + "\\fR";
}

std::string italic(const std::string& text) {
  return "\\fI" + escaped(text) + "\\fR";
}

std::string signature(const OptionText& option) {
  std::string text;
  for (const std::string& name : option.names) text += (text.empty() ? "" : ", ") + bold(name);
  if (!option.value.empty()) text += " " + italic(option.value);
  return text;
}

// The same option of several commands is told once.
struct ToldOption {
  OptionText option;
  std::vector<std::string> commands;
};

std::vector<ToldOption> all_options(const std::vector<const CLI::App*>& commands) {
  std::vector<ToldOption> told;
  for (const CLI::App* command : commands)
    for (OptionText& option : options_of(*command)) {
      if (option.is_positional) continue;
      const auto same = std::ranges::find_if(told, [&](const ToldOption& other) {
        return other.option.names == option.names && other.option.text == option.text;
      });
      if (same == told.end())
        told.push_back({std::move(option), {command->get_name()}});
      else
        same->commands.push_back(command->get_name());
    }
  return told;
}

std::string arguments_of(const CLI::App& command) {
  std::string text;
  for (const OptionText& option : options_of(command)) {
    if (option.is_positional)
      text += " " + italic(option.value) + (option.is_repeatable ? "..." : "");
    else if (option.option->get_required())
      text += " " + bold(option.names.front()) + " " + italic(option.value);
  }
  return text;
}

void add_options(const std::vector<const CLI::App*>& commands, std::string& page) {
  const std::vector<ToldOption> told = all_options(commands);
  std::vector<std::string> groups;
  for (const ToldOption& option : told)
    if (std::ranges::find(groups, option.option.group) == groups.end()) groups.push_back(option.option.group);
  for (const std::string& group : groups) {
    page += ".SS " + escaped(group) + "\n";
    for (const ToldOption& each : told) {
      if (each.option.group != group) continue;
      page += ".TP\n" + signature(each.option) + "\n" + escaped(each.option.text);
      if (!each.option.default_value.empty()) page += " The default is " + escaped(each.option.default_value) + ".";
      if (each.option.is_repeatable) page += " May be given several times.";
      page += "\n";
      if (each.commands.size() == commands.size()) continue;
      page += ".br\nOf " + italic(joined(each.commands)) + ".\n";
    }
  }
}

// Of the footers that begin with "Examples:".
void add_examples(const CLI::App& app, std::string& page) {
  std::istringstream footer(app.get_footer());
  bool is_example = false;
  for (std::string line; std::getline(footer, line);) {
    if (line == "Examples:") {
      is_example = true;
      continue;
    }
    if (is_example && line.starts_with("  "))
      page += escaped(line.substr(2)) + "\n";
    else
      is_example = false;
  }
}

}  // namespace

std::string manual_page(const CLI::App& root) {
  const std::vector<const CLI::App*> commands = sub_commands_of(root);
  std::vector<const CLI::App*> at_work;
  for (const CLI::App* command : commands)
    if (command->get_group() != help_group) at_work.push_back(command);
  std::string page = ".\\\" Made by scan2fea manual.\n.TH SCAN2FEA 1 \"\" \"scan2fea " + std::string(library_version) +
                     "\" \"User commands\"\n.SH NAME\nscan2fea \\- from a scanned surface to a finite\\-element mesh\n"
                     ".SH SYNOPSIS\n";
  for (const CLI::App* command : commands)
    page += bold("scan2fea " + command->get_name()) + arguments_of(*command) + " [" + italic("OPTIONS") + "]\n.br\n";
  page += ".SH DESCRIPTION\n" +
          escaped(
              "A scan (a triangle mesh or a point cloud) is repaired, enriched on request, simplified to nearly "
              "equilateral triangles that stay on it, filled with tetrahedra by TetGen, measured, and written for "
              "solvers.\nResults go to files or standard output, messages and progress to standard error. The "
              "extension of a file tells its format; for - as input or output --from or --to does.") +
          "\n.SH COMMANDS\n";
  for (const CLI::App* command : commands)
    page += ".TP\n" + bold(command->get_name()) + "\n" + escaped(command->get_description()) + "\n";
  page += ".SH OPTIONS\n";
  add_options(at_work, page);
  page += ".SH EXAMPLES\n.nf\n";
  add_examples(root, page);
  for (const CLI::App* command : commands) add_examples(*command, page);
  page += ".fi\n.SH \"EXIT STATUS\"\n";
  const std::map<int, std::string> statuses{{0, "Done."},
                                            {1, "A gate failed; no mesh is written."},
                                            {2, "Wrong usage."},
                                            {3, "The input cannot be read, or is no mesh."},
                                            {4, "No valid mesh can be made of it, or not in time."},
                                            {5, "The tetrahedral mesher failed."},
                                            {6, "Output cannot be written."},
                                            {130, "Interrupted."}};
  for (const auto& [status, text] : statuses) page += ".TP\n" + std::to_string(status) + "\n" + escaped(text) + "\n";
  page += ".SH ENVIRONMENT\n.TP\nNO_COLOR\nNo colours, on a terminal either.\n.TP\nTMPDIR\n" +
          escaped("Where what comes and goes through pipes is kept meanwhile.") + "\n";
  return page;
}

SubCommand add_manual(CLI::App& root) {
  CLI::App* app = root.add_subcommand("manual", "This program's manual page, for man -l -");
  app->group(help_group);
  return {app, [&root] {
            write_to_stdout(manual_page(root));
            return 0;
          }};
}

}  // namespace scan2fea::command
