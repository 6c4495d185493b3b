#include "preproc/command/configuration.hpp"

#include "preproc/command/option_text.hpp"
#include "preproc/mesh/error.hpp"

#include <toml++/toml.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <fstream>
#include <vector>

namespace scan2fea::command {
namespace {

std::string place(const std::filesystem::path& file, const toml::node& node) {
  return file.string() + ":" + std::to_string(node.source().begin.line);
}

// That reads back the same: 0.1, and 1000 for 1e3, which options of whole numbers take, too.
std::string shortest(double number) {
  char text[32];
  const auto end = std::to_chars(text, text + sizeof text, number).ptr;
  const std::string as_short(text, end);
  constexpr double largest_whole = 1e15;
  return number == std::floor(number) && std::abs(number) < largest_whole
             ? std::to_string(static_cast<long long>(number))
             : as_short;
}

std::string as_flag_value(const toml::node& node, const std::string& where, const std::string& key) {
  if (const auto* text = node.as_string()) return text->get();
  if (const auto* flag = node.as_boolean()) return flag->get() ? "true" : "false";
  if (const auto* whole = node.as_integer()) return std::to_string(whole->get());
  if (const auto* number = node.as_floating_point()) return shortest(number->get());
  throw WrongUsage({.what = "value of a kind no option takes",
                    .where = where,
                    .value = key,
                    .limit = {},
                    .advice = "text, a number, true or false, or an array of these"});
}

void require_length_of_list(std::size_t values, const CLI::Option& option, const std::string& where,
                            const std::string& key) {
  const auto wanted = static_cast<std::size_t>(std::max(1, option.get_type_size_max()));
  if (values == wanted) return;
  throw WrongUsage({.what = "list of another length than the option takes",
                    .where = where,
                    .value = key + ", " + std::to_string(values) + " values",
                    .limit = std::to_string(wanted),
                    .advice = key + " = [[" + option.get_type_name() + "], ...]"});
}

// A list may be one of lists: each is then what the option takes at a time, as a box.
std::vector<std::string> values_of(const toml::node& node, const CLI::Option& option, const std::string& where,
                                   const std::string& key) {
  const toml::array* array = node.as_array();
  if (array == nullptr) return {as_flag_value(node, where, key)};
  std::vector<std::string> values;
  for (const toml::node& element : *array) {
    const toml::array* at_a_time = element.as_array();
    if (at_a_time == nullptr) {
      values.push_back(as_flag_value(element, where, key));
      continue;
    }
    require_length_of_list(at_a_time->size(), option, where, key);
    for (const toml::node& value : *at_a_time) values.push_back(as_flag_value(value, where, key));
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

Setting setting_of(CLI::Option* option, std::vector<std::string> values, std::string where, const std::string& key) {
  if (option->get_expected_max() == 0)  // of --no-primitives true is false
    for (std::string& value : values) value = option->get_flag_value(key, value);
  return {option, std::move(values), std::move(where)};
}

bool is_sub_command(const CLI::App& root, std::string_view name) {
  const auto commands = root.get_subcommands([name](const CLI::App* c) { return c->get_name() == name; });
  return !commands.empty();
}

// By the name of its flag or, of what has no dashes (the input), its own.
CLI::Option* find_option(CLI::App& command, const std::string& key) {
  CLI::Option* option = command.get_option_no_throw("--" + key);
  if (option != nullptr) return option;
  option = command.get_option_no_throw(key);
  return option != nullptr && option->get_positional() ? option : nullptr;
}

std::vector<std::string> keys_of(const CLI::App& command) {
  std::vector<std::string> keys;
  for (const OptionText& option : options_of(command)) {
    const std::string& name = option.names.back();
    keys.push_back(name.substr(name.find_first_not_of('-')));
  }
  return keys;
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
    CLI::Option* option = find_option(command, key);
    if (option != nullptr && option->get_configurable() && key != "config") {
      std::vector<std::string> values = values_of(node, *option, place(file, node), key);
      settings.push_back(setting_of(option, std::move(values), place(file, node), key));
    } else if (option != nullptr || !known_to_any(root, key)) {
      throw WrongUsage({.what = "unknown option",
                        .where = place(file, node),
                        .value = key + did_you_mean(key, keys_of(command)),
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
      throw WrongUsage({.what = "excludes another option that is given, too",
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

bool is_keyword(const CLI::Option& option) {
  static constexpr std::array of_terminals{"from", "to", "config", "quiet", "verbose", "progress"};
  const auto is_of_terminal = [](const std::string& name) { return std::ranges::count(of_terminals, name) > 0; };
  return option.get_configurable() && std::ranges::none_of(option.get_lnames(), is_of_terminal);
}

namespace {

std::vector<std::string> keywords_of(const CLI::App& command) {
  std::vector<std::string> keywords;
  for (const OptionText& option : options_of(command))
    if (is_keyword(*option.option))
      keywords.push_back(option.names.back().substr(option.names.back().find_first_not_of('-')));
  for (std::string& keyword : keywords) std::ranges::replace(keyword, '-', '_');
  return keywords;
}

}  // namespace

void apply_keywords(CLI::App& command, const std::vector<Keyword>& keywords) {
  std::vector<Setting> settings;
  for (const Keyword& keyword : keywords) {
    std::string key = keyword.name;
    std::ranges::replace(key, '_', '-');
    CLI::Option* option = find_option(command, key);
    if (option == nullptr || !is_keyword(*option))
      throw WrongUsage({.what = "unknown option",
                        .where = command.get_name(),
                        .value = keyword.name + did_you_mean(keyword.name, keywords_of(command)),
                        .limit = {},
                        .advice = "the names of `scan2fea " + command.get_name() + " --help`, with _ for -"});
    std::vector<std::string> values;
    for (const std::vector<std::string>& at_a_time : keyword.values) {
      require_length_of_list(at_a_time.size(), *option, command.get_name(), keyword.name);
      values.insert(values.end(), at_a_time.begin(), at_a_time.end());
    }
    settings.push_back(setting_of(option, std::move(values), command.get_name(), key));
  }
  apply(settings);
}

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
