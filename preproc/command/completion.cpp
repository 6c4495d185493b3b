// What bash, zsh and fish complete, made of what is declared of the commands and their options.
#include "preproc/command/option_text.hpp"
#include "preproc/command/piped_files.hpp"
#include "preproc/command/sub_commands.hpp"
#include "preproc/mesh/error.hpp"
#include "preproc/mesh/joined.hpp"

#include <algorithm>
#include <memory>
#include <string>
#include <vector>

namespace scan2fea::command {
namespace {

// For a shell's single quotes.
std::string quoted(const std::string& text) {
  std::string out = "'";
  for (const char c : text) out += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return out + "'";
}

// Of the options with a value, for `case`: names, and what completes the value.
std::string bash_values(const std::vector<OptionText>& options) {
  std::string text;
  for (const OptionText& option : options) {
    if (option.is_positional || option.value.empty()) continue;
    std::string action = "none=1";
    if (option.takes_file()) action = "files=1";
    if (option.takes_folder()) action = "folders=1";
    if (!option.choices.empty()) action = "words=" + quoted(joined(option.choices, " "));
    if (!option.choices.empty() && option.takes_file()) action += " files=1";
    text += "        " + joined(option.names, "|") + ") " + action + " ;;\n";
  }
  return text;
}

std::string bash_command(const CLI::App& command) {
  std::vector<std::string> names;
  std::string of_files = "words=";
  const std::vector<OptionText> options = options_of(command);
  for (const OptionText& option : options) {
    if (!option.is_positional)
      names.insert(names.end(), option.names.begin(), option.names.end());
    else
      of_files = option.choices.empty() ? "files=1" : "words=" + quoted(joined(option.choices, " "));
  }
  return "    " + command.get_name() + ")\n      options=" + quoted(joined(names, " ")) + "\n      case $before in\n" +
         bash_values(options) + "        *) " + of_files + " ;;\n      esac ;;\n";
}

std::string bash(const std::vector<const CLI::App*>& commands) {
  std::string text =
      "# Completion of scan2fea for bash, made by: scan2fea completion bash\n"
      "_scan2fea() {\n"
      "  local current=${COMP_WORDS[COMP_CWORD]} before=${COMP_WORDS[COMP_CWORD-1]} command=${COMP_WORDS[1]}\n"
      "  local options='' words='' files='' folders='' none=''\n"
      "  COMPREPLY=()\n"
      "  # bash parts --option=value at the sign\n"
      "  if [[ $current == '=' ]]; then current=''\n"
      "  elif [[ $before == '=' ]]; then before=${COMP_WORDS[COMP_CWORD-2]}\n"
      "  fi\n"
      "  if (( COMP_CWORD == 1 )); then\n"
      "    COMPREPLY=($(compgen -W '" +
      joined(names_of(commands), " ") +
      " --help --version' -- \"$current\"))\n"
      "    return\n"
      "  fi\n"
      "  case $command in\n";
  for (const CLI::App* command : commands) text += bash_command(*command);
  text +=
      "    *) return ;;\n"
      "  esac\n"
      "  if [[ -z $none && -z $words$folders && $current == -* && $current != - ]] || "
      "[[ $current == -* && -n $files ]]; then\n"
      "    COMPREPLY=($(compgen -W \"$options\" -- \"$current\"))\n"
      "    return\n"
      "  fi\n"
      "  if [[ -n $words ]]; then COMPREPLY=($(compgen -W \"$words\" -- \"$current\")); fi\n"
      "  local IFS=$'\\n'\n"
      "  if [[ -n $files$folders ]]; then\n"
      "    compopt -o filenames 2>/dev/null\n"
      "    COMPREPLY+=($(compgen ${files:+-f}${folders:+-d} -- \"$current\"))\n"
      "  fi\n"
      "}\n"
      "complete -F _scan2fea scan2fea\n";
  return text;
}

// In a specification of zsh's _arguments brackets and colons mean something.
std::string zsh_text(const std::string& text) {
  std::string out;
  for (const char c : text) {
    if (c == '[' || c == ']' || c == ':' || c == '\\') out += '\\';
    out += c;
  }
  return out;
}

std::string zsh_value(const OptionText& option) {
  if (option.value.empty()) return "";
  std::string action = " ";
  if (!option.choices.empty()) action = "(" + joined(option.choices, " ") + ")";
  if (option.takes_file()) action = "_files";
  if (option.takes_folder()) action = "_files -/";
  return ":" + zsh_text(option.value) + ":" + action;
}

std::string zsh_command(const CLI::App& command) {
  std::string text = "    " + command.get_name() + ")\n      _arguments -s";
  for (const OptionText& option : options_of(command)) {
    if (option.is_positional) {
      text += " \\\n        " + quoted((option.is_repeatable ? "*" : "") + zsh_value(option));
      continue;
    }
    for (const std::string& name : option.names)
      text += " \\\n        " +
              quoted((option.is_repeatable ? "*" : "") + name + "[" + zsh_text(option.text) + "]" + zsh_value(option));
  }
  return text + " ;;\n";
}

std::string zsh(const std::vector<const CLI::App*>& commands) {
  std::string text =
      "#compdef scan2fea\n"
      "# Completion of scan2fea for zsh, made by: scan2fea completion zsh\n"
      "_scan2fea() {\n"
      "  if (( CURRENT == 2 )); then\n"
      "    local -a commands=(\n";
  for (const CLI::App* command : commands)
    text += "      " + quoted(command->get_name() + ":" + zsh_text(command->get_description())) + "\n";
  text +=
      "    )\n"
      "    _describe command commands\n"
      "    return\n"
      "  fi\n"
      "  local command=$words[2]\n"
      "  shift words\n"
      "  (( CURRENT-- ))\n"
      "  case $command in\n";
  for (const CLI::App* command : commands) text += zsh_command(*command);
  return text + "  esac\n}\n_scan2fea \"$@\"\n";
}

// fish has ' and \ alone to be escaped within single quotes.
std::string fish_text(const std::string& text) {
  std::string out = "'";
  for (const char c : text) {
    if (c == '\'' || c == '\\') out += '\\';
    out += c;
  }
  return out + "'";
}

std::string fish(const std::vector<const CLI::App*>& commands) {
  std::string text = "# Completion of scan2fea for fish, made by: scan2fea completion fish\n";
  for (const CLI::App* command : commands)
    text += "complete -c scan2fea -f -n __fish_use_subcommand -a " + command->get_name() + " -d " +
            fish_text(command->get_description()) + "\n";
  for (const CLI::App* command : commands)
    for (const OptionText& option : options_of(*command)) {
      const std::string of_command =
          "complete -c scan2fea -n '__fish_seen_subcommand_from " + command->get_name() + "'";
      if (option.is_positional) {
        if (!option.choices.empty()) text += of_command + " -f -a " + fish_text(joined(option.choices, " ")) + "\n";
        continue;
      }
      text += of_command;
      for (const std::string& name : option.names)
        text += name.starts_with("--") ? " -l " + name.substr(2) : " -s " + name.substr(1);
      if (!option.value.empty()) text += option.takes_file() || option.takes_folder() ? " -r" : " -x";
      if (!option.choices.empty()) text += " -a " + fish_text(joined(option.choices, " "));
      text += " -d " + fish_text(option.text) + "\n";
    }
  return text;
}

}  // namespace

SubCommand add_completion(CLI::App& root) {
  const auto shell = std::make_shared<std::string>();
  CLI::App* app =
      root.add_subcommand("completion", "What a shell needs to complete commands, options and their values");
  app->group(help_group);
  app->add_option("shell", *shell, "bash, zsh or fish")->required()->type_name("bash|zsh|fish");
  app->footer(
      "Examples:\n"
      "  source <(scan2fea completion bash)\n"
      "  scan2fea completion fish > ~/.config/fish/completions/scan2fea.fish");
  return {app, [shell, &root] {
            const std::vector<const CLI::App*> commands = sub_commands_of(root);
            if (*shell == "bash")
              write_to_stdout(bash(commands));
            else if (*shell == "zsh")
              write_to_stdout(zsh(commands));
            else if (*shell == "fish")
              write_to_stdout(fish(commands));
            else
              throw WrongUsage({.what = "unknown shell",
                                .where = {},
                                .value = *shell + did_you_mean(*shell, {"bash", "zsh", "fish"}),
                                .limit = {},
                                .advice = "bash, zsh or fish"});
            return 0;
          }};
}

}  // namespace scan2fea::command
