#include "preproc/command/print_configuration.hpp"

#include "preproc/command/help.hpp"
#include "preproc/command/option_text.hpp"
#include "preproc/command/option_values.hpp"
#include "preproc/command/piped_files.hpp"

#include <scan2fea/version.hpp>
#include <toml++/toml.h>

#include <algorithm>
#include <array>
#include <sstream>

namespace scan2fea::command {
namespace {

constexpr const char* flag = "--print-config";
constexpr std::array not_of_it{"--help", "--config"};

std::string key_of(const OptionText& option) {
  const std::string& name = option.names.back();
  // Of --primitives, --no-primitives the one that says it is so.
  const std::string& key = option.value.empty() && !option.is_positional ? option.names.front() : name;
  return key.substr(key.find_first_not_of('-'));
}

// TOML knows no number that begins with a point, or ends with one.
std::string value_text(const std::string& value) {
  const bool looks_like_one = !value.empty() && value.find_first_not_of("0123456789.eE+-") == std::string::npos;
  if (looks_like_one && number_in(value)) {
    try {
      const toml::table read = toml::parse("x = " + value);
      if (read["x"].is_number()) return value;
    } catch (const toml::parse_error&) {
    }
  }
  std::ostringstream text;
  text << toml::value<std::string>(value);
  return text.str();
}

// One value, a list, or a list of as many values as the option takes at a time.
std::string values_text(const OptionText& option) {
  const CLI::results_t& results = option.option->results();
  if (option.value.empty() && !option.is_positional) return results.back() == "false" ? "false" : "true";
  const auto at_a_time = static_cast<std::size_t>(std::max(1, option.option->get_type_size_max()));
  if (!option.is_repeatable && at_a_time == 1) return value_text(results.back());
  std::string text;
  for (std::size_t i = 0; i < results.size(); ++i) {
    const bool begins = at_a_time > 1 && i % at_a_time == 0;
    text += (i == 0 ? "" : ", ") + std::string(begins ? "[" : "") + value_text(results[i]);
    if (at_a_time > 1 && i % at_a_time == at_a_time - 1) text += "]";
  }
  return "[" + text + "]";
}

std::string default_text(const OptionText& option) {
  if (option.value.empty() && !option.is_positional) return option.default_value.empty() ? "false" : "true";
  return option.default_value.empty() ? "..." : value_text(option.default_value);
}

}  // namespace

void add_print_configuration_flag(CLI::App& command) {
  const OptionGroup group(command, "Running");
  const std::string text = "Print these options as TOML for --config, and do nothing else";
  command.add_flag(flag, text)->configurable(false);
}

bool asks_for_configuration(const CLI::App& command) {
  const CLI::Option* option = command.get_option_no_throw(flag);
  return option != nullptr && option->count() > 0;
}

std::string configuration_text(const CLI::App& command) {
  std::string text = std::string("# scan2fea ") + library_version + ": scan2fea " + command.get_name() +
                     " --config THIS_FILE\n[" + command.get_name() + "]\n";
  std::string group;
  for (const OptionText& option : options_of(command)) {
    if (!option.option->get_configurable() || std::ranges::find(not_of_it, option.names.back()) != not_of_it.end())
      continue;
    if (option.group != group) text += "\n# " + (group = option.group) + "\n";
    const bool is_given = option.option->count() > 0;
    if (is_given) {
      text += key_of(option) + " = " + values_text(option) + "\n";
      continue;
    }
    constexpr std::size_t columns = 100;
    for (const std::string& line : wrapped(option.text, columns)) text += "#   " + line + "\n";
    text += "# " + key_of(option) + " = " + default_text(option) + "\n";
  }
  return text;
}

void print_configuration(const CLI::App& command) {
  write_to_stdout(configuration_text(command));
}

}  // namespace scan2fea::command
