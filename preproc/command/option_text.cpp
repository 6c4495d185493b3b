#include "preproc/command/option_text.hpp"

#include "preproc/mesh/joined.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <string_view>
#include <utility>

namespace scan2fea::command {
namespace {

constexpr std::string_view no_group = "Options";  // CLI11's own name of it

constexpr std::array<std::string_view, 15> order_of_groups{"",
                                                           "Files",
                                                           "How many triangles, at most one of",
                                                           "Where triangles are small",
                                                           "How triangles are made",
                                                           "Named faces and symmetry",
                                                           "Clouds",
                                                           "Repair",
                                                           "Enrichment",
                                                           "Several bodies",
                                                           "Tetrahedra",
                                                           "Figures, gates and reports",
                                                           "What files hold",
                                                           "What is drawn",
                                                           "Running"};

std::size_t rank_of(const std::string& group) {
  return static_cast<std::size_t>(std::ranges::find(order_of_groups, group) - order_of_groups.begin());
}

std::vector<std::string> split(const std::string& text, char at) {
  std::vector<std::string> parts(1);
  for (const char c : text) {
    if (c == at)
      parts.emplace_back();
    else
      parts.back().push_back(c);
  }
  return parts;
}

// Words, which are written as they are; numbers and upper-case names stand for something else.
std::vector<std::string> choices_in(const std::string& value) {
  std::vector<std::string> choices;
  if (value.find('|') == std::string::npos || value.find("FILE") != std::string::npos) return choices;
  for (std::string& part : split(value, '|'))
    if (std::ranges::none_of(part, [](unsigned char c) { return std::isupper(c) || c == '%'; }))
      choices.push_back(std::move(part));
  return choices;
}

std::vector<std::string> names_of(const CLI::Option& option) {
  if (option.get_positional()) return {option.get_name(true, false)};
  std::vector<std::string> names;
  for (const std::string& name : option.get_snames()) names.push_back("-" + name);
  for (const std::string& name : option.get_lnames()) names.push_back("--" + name);
  return names;
}

// How many letters are to be put in, taken out, replaced, or swapped with their neighbours.
std::size_t distance(const std::string& a, const std::string& b) {
  std::vector<std::vector<std::size_t>> d(a.size() + 1, std::vector<std::size_t>(b.size() + 1));
  for (std::size_t i = 0; i <= a.size(); ++i)
    for (std::size_t j = 0; j <= b.size(); ++j) {
      if (i == 0 || j == 0) {
        d[i][j] = i + j;
        continue;
      }
      d[i][j] = std::min(
          {d[i - 1][j] + 1, d[i][j - 1] + 1, d[i - 1][j - 1] + static_cast<std::size_t>(a[i - 1] != b[j - 1])});
      if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1])
        d[i][j] = std::min(d[i][j], d[i - 2][j - 2] + 1);
    }
  return d[a.size()][b.size()];
}

std::string without_dashes(const std::string& name) {
  return name.substr(std::min(name.find_first_not_of('-'), name.size()));
}

std::string in_lower_case(std::string text) {
  std::ranges::transform(text, text.begin(), [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return text;
}

}  // namespace

std::string OptionText::signature() const {
  const std::string all = joined(names);
  if (is_positional) return value.empty() ? all : value;
  return value.empty() ? all : all + " " + value;
}

std::vector<OptionText> options_of(const CLI::App& command) {
  std::vector<OptionText> options;
  for (const CLI::Option* option : command.get_options()) {
    if (option->get_group().empty()) continue;  // hidden
    OptionText text;
    text.option = option;
    text.names = names_of(*option);
    text.text = option->get_description();
    text.is_positional = option->get_positional();
    if (option->get_expected_max() > 0) text.value = option->get_type_name();
    text.choices = choices_in(text.value);
    text.default_value = option->get_default_str();
    text.group = option->get_group() == no_group ? "" : option->get_group();
    if (text.group.empty() && !text.is_positional) text.group = order_of_groups.back();
    text.is_repeatable = option->get_items_expected_max() > std::max(1, option->get_type_size_max());
    options.push_back(std::move(text));
  }
  std::ranges::stable_sort(options, {}, [](const OptionText& option) {
    const std::size_t not_required = option.option->get_required() ? 0 : 1;
    return option.is_positional ? std::size_t{0} : 1 + 2 * rank_of(option.group) + not_required;
  });
  return options;
}

std::vector<const CLI::App*> sub_commands_of(const CLI::App& root) {
  std::vector<const CLI::App*> commands;
  for (const CLI::App* command : root.get_subcommands([](const CLI::App*) { return true; }))
    if (!command->get_group().empty()) commands.push_back(command);
  return commands;
}

std::vector<std::string> names_of(const std::vector<const CLI::App*>& commands) {
  std::vector<std::string> names;
  for (const CLI::App* command : commands) names.push_back(command->get_name());
  return names;
}

// A start of a name is near, and so is one with a mistake in every third letter.
std::vector<std::string> similar_names(const std::string& mistyped, const std::vector<std::string>& names) {
  std::vector<std::pair<std::size_t, std::string>> near;
  const std::string typed = in_lower_case(without_dashes(mistyped));
  if (typed.empty()) return {};
  for (const std::string& name : names) {
    const std::string known = in_lower_case(without_dashes(name));
    const std::size_t apart = distance(typed, known);
    const bool is_start = typed.size() > 1 && known.starts_with(typed);
    if (is_start || apart <= std::max<std::size_t>(1, std::min(typed.size(), known.size()) / 3))
      near.emplace_back(is_start ? 0 : apart, name);
  }
  std::ranges::stable_sort(near, {}, &std::pair<std::size_t, std::string>::first);
  std::vector<std::string> similar;
  for (auto& [apart, name] : near)
    if (apart == near.front().first) similar.push_back(std::move(name));
  return similar;
}

std::string did_you_mean(const std::string& mistyped, const std::vector<std::string>& names) {
  const std::string text = joined(similar_names(mistyped, names), " or ");
  return text.empty() ? "" : "; did you mean " + text + "?";
}

std::vector<std::string> given_in_group(const CLI::App& command, const std::string& group) {
  std::vector<std::string> names;
  for (const CLI::Option* option : command.get_options())
    if (option->get_group() == group && !option->empty()) names.push_back(option->get_name());
  return names;
}

OptionGroup::OptionGroup(CLI::App& command, std::string name)
    : command_(command), name_(std::move(name)), before_(command.get_options().size()) {}

OptionGroup::~OptionGroup() {
  const std::vector<CLI::Option*> options = command_.get_options(nullptr);
  for (std::size_t i = before_; i < options.size(); ++i)
    if (options[i]->get_group() == no_group && !options[i]->get_positional()) options[i]->group(name_);
}

}  // namespace scan2fea::command
