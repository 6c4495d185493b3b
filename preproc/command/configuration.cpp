#include "preproc/command/configuration.hpp"

#include "preproc/mesh/error.hpp"

#include <toml++/toml.h>

#include <fstream>
#include <sstream>
#include <vector>

namespace scan2fea::command {
namespace {

std::string place(const std::filesystem::path& file, const toml::node& node) {
  return file.string() + ":" + std::to_string(node.source().begin.line);
}

std::string as_flag_value(const toml::node& node, const std::string& where, const std::string& key) {
  if (const auto* text = node.as_string()) return text->get();
  if (const auto* flag = node.as_boolean()) return flag->get() ? "true" : "false";
  if (node.is_number()) {
    std::ostringstream out;
    out << toml::node_view<const toml::node>(&node);
    return out.str();
  }
  throw WrongUsage({.what = "value of a kind no option takes",
                    .where = where,
                    .value = key,
                    .limit = {},
                    .advice = "text, a number, true or false, or an array of these"});
}

std::vector<std::string> values_of(const toml::node& node, const std::string& where, const std::string& key) {
  std::vector<std::string> values;
  if (const toml::array* array = node.as_array()) {
    for (const toml::node& element : *array) values.push_back(as_flag_value(element, where, key));
  } else {
    values.push_back(as_flag_value(node, where, key));
  }
  return values;
}

bool given_or_excluded(const CLI::Option& option) {
  if (option.count() > 0) return true;
  const auto& excludes = option.get_excludes();
  return std::any_of(excludes.begin(), excludes.end(), [](const CLI::Option* other) { return other->count() > 0; });
}

struct Setting {
  CLI::Option* option;
  std::vector<std::string> values;
  std::string where;
};

bool is_sub_command(const CLI::App& root, std::string_view name) {
  const auto commands = root.get_subcommands([name](const CLI::App* c) { return c->get_name() == name; });
  return !commands.empty();
}

bool known_to_any(const CLI::App& root, const std::string& key) {
  const auto commands = root.get_subcommands([](const CLI::App*) { return true; });
  return std::any_of(commands.begin(), commands.end(),
                     [&](const CLI::App* c) { return c->get_option_no_throw("--" + key) != nullptr; });
}

std::vector<Setting> settings_in(const toml::table& table, const CLI::App& root, CLI::App& command,
                                 const std::filesystem::path& file) {
  std::vector<Setting> settings;
  for (const auto& [name, node] : table) {
    const std::string key(name.str());
    if (node.is_table()) continue;
    CLI::Option* option = command.get_option_no_throw("--" + key);
    if (option != nullptr && option->get_configurable() && key != "config") {
      settings.push_back({option, values_of(node, place(file, node), key), place(file, node)});
    } else if (option != nullptr || !known_to_any(root, key)) {
      throw WrongUsage({.what = "unknown option",
                        .where = place(file, node),
                        .value = key,
                        .limit = {},
                        .advice = "the names of `scan2fea " + command.get_name() + " --help`, without the dashes"});
    }
  }
  return settings;
}

void apply(const std::vector<Setting>& settings) {
  // What the flags said goes first: decided for all settings before any is applied, so that two keys of the file that
  // exclude each other are an error and not a silent choice.
  std::vector<const Setting*> chosen;
  for (const Setting& s : settings)
    if (!given_or_excluded(*s.option)) chosen.push_back(&s);
  for (const Setting* s : chosen) {
    if (given_or_excluded(*s->option))
      throw WrongUsage({.what = "excludes another option of the same file",
                        .where = s->where,
                        .value = s->option->get_name(),
                        .limit = {},
                        .advice = "keep one of the two"});
    try {
      for (const std::string& value : s->values) s->option->add_result(value);
      s->option->run_callback();
    } catch (const CLI::Error& e) {
      throw WrongUsage({.what = e.what(), .where = s->where, .value = {}, .limit = {}, .advice = {}});
    }
  }
}

}  // namespace

void apply_configuration(CLI::App& root, CLI::App& command, const std::filesystem::path& file) {
  std::ifstream in(file);
  if (!in || std::filesystem::is_directory(file))
    throw InvalidInput({.what = "cannot read the configuration",
                        .where = file.string(),
                        .value = {},
                        .limit = {},
                        .advice = "a readable TOML file"});
  toml::table table;
  try {
    table = toml::parse(in, file.string());
  } catch (const toml::parse_error& e) {
    throw InvalidInput({.what = std::string(e.description()),
                        .where = file.string() + ":" + std::to_string(e.source().begin.line),
                        .value = {},
                        .limit = {},
                        .advice = "TOML syntax: name = value"});
  }
  for (const auto& [name, node] : table)
    if (node.is_table() && !is_sub_command(root, name.str()))
      throw WrongUsage({.what = "table of no sub-command",
                        .where = place(file, node),
                        .value = std::string(name.str()),
                        .limit = {},
                        .advice = "[run], [surface], [check], ..."});
  if (const toml::table* own = table[command.get_name()].as_table()) apply(settings_in(*own, root, command, file));
  apply(settings_in(table, root, command, file));
}

}  // namespace scan2fea::command
