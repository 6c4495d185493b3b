#include "preproc/command/wrong_usage.hpp"

#include "preproc/command/option_text.hpp"
#include "preproc/mesh/error.hpp"
#include "preproc/mesh/joined.hpp"

#include <algorithm>
#include <filesystem>
#include <vector>

namespace scan2fea::command {
namespace {

std::vector<std::string> names_of(const CLI::App& command) {
  std::vector<std::string> names;
  for (const OptionText& option : options_of(command))
    if (!option.is_positional) names.insert(names.end(), option.names.begin(), option.names.end());
  return names;
}

// Those that the user may have had in mind: "surface, simplify".
std::string commands_with(const CLI::App& root, const std::string& option) {
  std::vector<std::string> commands;
  for (const CLI::App* command : sub_commands_of(root)) {
    const std::vector<std::string> names = names_of(*command);
    if (std::ranges::find(names, option) != names.end()) commands.push_back(command->get_name());
  }
  return joined(commands);
}

const CLI::App* parsed_command(const CLI::App& root) {
  const std::vector<CLI::App*> parsed = root.get_subcommands();
  return parsed.empty() ? nullptr : parsed.front();
}

std::string unexpected(const CLI::App& root, const CLI::App& command) {
  const std::vector<std::string> extras = command.remaining(true);
  const auto flag = std::ranges::find_if(extras, [](const std::string& extra) { return extra.starts_with("-"); });
  if (flag == extras.end()) return command.get_name() + ": '" + extras.front() + "' is one argument too many";
  const std::string name = flag->substr(0, flag->find('='));
  std::string text = command.get_name() + " has no option '" + name + "'";
  const std::string others = commands_with(root, name);
  if (!others.empty()) return text + ", which is one of " + others;
  return text + did_you_mean(name, names_of(command));
}

// "--faces: 1 required N missing" of CLI11, or "--json: At Most 1 required but received 2".
std::string missing_value(const CLI::App& command, const std::string& what) {
  const std::string name = what.substr(0, what.find(':'));
  if (what.find("At Most") != std::string::npos) return name + " is given more than once";
  const CLI::Option* option = command.get_option_no_throw(name);
  return option == nullptr ? what : name + " takes a value: " + name + " " + option->get_type_name();
}

}  // namespace

std::string unknown_command(const CLI::App& root, const std::string& argument) {
  const std::vector<std::string> names = names_of(root.get_subcommands([](const CLI::App*) { return true; }));
  if (std::ranges::find(names, argument) != names.end()) return {};
  std::error_code ignored;
  if (argument == "-" || std::filesystem::is_regular_file(argument, ignored))
    return "there is no command '" + argument + "', which is a file; did you mean: scan2fea run " + argument +
           " -o PART.inp";
  const std::string list = joined(names_of(sub_commands_of(root)));
  const std::string meant = did_you_mean(argument, names);
  return "there is no command '" + argument + "'" + (meant.empty() ? "; there are: " + list : meant);
}

std::string told(const CLI::App& root, const CLI::ParseError& error) {
  const CLI::App* command = parsed_command(root);
  std::string text = error.what();
  if (command == nullptr) {
    const std::vector<std::string> extras = root.remaining(false);
    if (!extras.empty())
      text = "there is no option '" + extras.front() + "'" + did_you_mean(extras.front(), names_of(root));
    else if (dynamic_cast<const CLI::RequiredError*>(&error) != nullptr)
      text = "no command is given";
    return text + "; try: scan2fea --help";
  }
  if (dynamic_cast<const CLI::ExtrasError*>(&error) != nullptr) text = unexpected(root, *command);
  if (dynamic_cast<const CLI::ArgumentMismatch*>(&error) != nullptr) text = missing_value(*command, text);
  if (dynamic_cast<const CLI::ExcludesError*>(&error) != nullptr) text += ": give one of the two";
  return text.find("try: ") == std::string::npos ? text + "; try: scan2fea " + command->get_name() + " --help" : text;
}

RequiredLater::RequiredLater(CLI::App& root) {
  for (CLI::App* command : root.get_subcommands([](CLI::App*) { return true; }))
    for (CLI::Option* option : command->get_options([](CLI::Option* o) { return o->get_required(); })) {
      options_.push_back(option);
      option->required(false);
    }
}

void RequiredLater::put_back() const {
  for (CLI::Option* option : options_) option->required();
}

void RequiredLater::require_all(const CLI::App& command) const {
  for (const OptionText& option : options_of(command)) {
    if (std::ranges::find(options_, option.option) == options_.end() || option.option->count() > 0) continue;
    throw WrongUsage({.what = "missing: " + option.signature() + ", " + option.text,
                      .where = "scan2fea " + command.get_name(),
                      .value = {},
                      .limit = {},
                      .advice = "scan2fea " + command.get_name() + " --help"});
  }
}

}  // namespace scan2fea::command
