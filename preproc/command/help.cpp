#include "preproc/command/help.hpp"

#include "preproc/command/option_text.hpp"

#include <algorithm>
#include <cstdlib>
#include <sstream>
#include <sys/ioctl.h>
#include <unistd.h>

namespace scan2fea::command {
namespace {

// Wider lines are hard to read, and in narrower ones a word a line is no help.
std::size_t columns_of_help() {
  constexpr std::size_t most = 100, least = 30, usual = 80;
  winsize size{};
  if (ioctl(STDOUT_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 0)
    return std::clamp<std::size_t>(size.ws_col, least, most);
  const char* told = std::getenv("COLUMNS");
  const long columns = told == nullptr ? 0 : std::strtol(told, nullptr, 10);
  return columns > 0 ? std::clamp<std::size_t>(static_cast<std::size_t>(columns), least, most) : usual;
}

// A name and beside it, or below where there is no room, what it is.
void add_entry(const std::string& name, const std::string& text, std::size_t columns, std::string& help) {
  const std::size_t indent = columns >= 60 ? 26 : 6;
  std::string line = "  " + name;
  std::vector<std::string> lines = wrapped(text, columns - indent);
  const bool beside = line.size() + 2 <= indent && !lines.empty();
  if (beside) {
    line += std::string(indent - line.size(), ' ') + lines.front();
    lines.erase(lines.begin());
  }
  // A long list of choices goes on below, after one of its signs.
  while (line.size() > columns && line.rfind('|', columns - 1) != std::string::npos) {
    const std::size_t sign = line.rfind('|', columns - 1);
    help += line.substr(0, sign + 1) + "\n";
    line = "      " + line.substr(sign + 1);
  }
  help += line + "\n";
  for (const std::string& more : lines) help += std::string(indent, ' ') + more + "\n";
}

std::string text_of(const OptionText& option) {
  std::string text = option.text;
  if (!option.default_value.empty()) text += " [" + option.default_value + "]";
  if (option.is_repeatable && !option.is_positional) text += " (repeatable)";
  return text;
}

std::string usage(const CLI::App& command, const std::vector<OptionText>& options, const std::string& name) {
  std::string text = "Usage: " + name;
  if (command.get_parent() == nullptr) return text + " COMMAND [OPTIONS]\n";
  for (const OptionText& option : options)
    if (option.is_positional)
      text += " " + (option.option->get_required() ? option.value : "[" + option.value + "]") +
              (option.is_repeatable ? "..." : "");
  for (const OptionText& option : options)
    if (!option.is_positional && option.option->get_required()) text += " " + option.names.front() + " " + option.value;
  return text + " [OPTIONS]\n";
}

void add_commands(const CLI::App& root, std::size_t columns, std::string& help) {
  std::vector<std::string> groups;
  const std::vector<const CLI::App*> commands = sub_commands_of(root);
  for (const CLI::App* command : commands)
    if (std::ranges::find(groups, command->get_group()) == groups.end()) groups.push_back(command->get_group());
  for (const std::string& group : groups) {
    help += "\n" + group + ":\n";
    for (const CLI::App* command : commands)
      if (command->get_group() == group) add_entry(command->get_name(), command->get_description(), columns, help);
  }
}

}  // namespace

std::vector<std::string> wrapped(const std::string& text, std::size_t columns) {
  std::vector<std::string> lines;
  std::istringstream given(text);
  for (std::string line; std::getline(given, line);) {
    std::istringstream words(line);
    std::string current;
    for (std::string word; words >> word;) {
      if (!current.empty() && current.size() + 1 + word.size() > columns) {
        lines.push_back(current);
        current.clear();
      }
      current += (current.empty() ? "" : " ") + word;
    }
    lines.push_back(current);
  }
  return lines;
}

std::string HelpFormatter::make_help(const CLI::App* app, std::string name, CLI::AppFormatMode) const {
  const std::size_t columns = columns_of_help();
  const std::vector<OptionText> options = options_of(*app);
  std::string help;
  for (const std::string& line : wrapped(app->get_description(), columns)) help += line + "\n";
  std::string full_name = name.empty() ? app->get_name() : name;
  if (app->get_parent() != nullptr && full_name.find(' ') == std::string::npos)
    full_name = app->get_parent()->get_name() + " " + full_name;
  help += "\n" + usage(*app, options, full_name);
  add_commands(*app, columns, help);
  const std::string none = " ";
  std::string group = none;
  for (const OptionText& option : options) {
    const std::string its = option.is_positional ? "" : option.group;
    if (its != group) {
      help += "\n";
      for (const std::string& line : wrapped(its.empty() ? "" : its + ":", columns)) help += line + "\n";
      group = its;
    }
    add_entry(option.signature(), text_of(option), columns, help);
  }
  if (!app->get_footer().empty()) help += "\n" + app->get_footer() + "\n";
  return help;
}

}  // namespace scan2fea::command
