// A flag that takes one of some names.
#pragma once

#include "preproc/command/option_text.hpp"
#include "preproc/mesh/joined.hpp"

#include <CLI/App.hpp>

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

namespace scan2fea::command {

template <class Value>
using Choices = std::vector<std::pair<std::string, Value>>;

template <class Value>
std::vector<std::string> names_of(const Choices<Value>& choices) {
  std::vector<std::string> names;
  for (const auto& choice : choices) names.push_back(choice.first);
  return names;
}

template <class Value>
std::string list_of(const Choices<Value>& choices, const std::string& between) {
  return joined(names_of(choices), between);
}

// The values of an enumeration under the names that the library gives them.
template <class Enum, std::size_t n>
Choices<Enum> named(const Enum (&values)[n]) {
  Choices<Enum> choices;
  for (const Enum value : values) choices.emplace_back(std::string(name_of(value)), value);
  return choices;
}

[[noreturn]] inline void refuse_choice(const std::string& flag, const std::string& name,
                                       const std::vector<std::string>& known) {
  throw CLI::ValidationError(flag, "'" + name + "' is none of " + joined(known) + did_you_mean(name, known));
}

template <class Value>
Value chosen(const std::string& flag, const std::string& name, const Choices<Value>& choices) {
  const auto found = std::ranges::find(choices, name, [](const auto& choice) { return choice.first; });
  if (found == choices.end()) refuse_choice(flag, name, names_of(choices));
  return found->second;
}

// The value that the target has is the default that the help tells, where it is one of the choices.
template <class Value, class Target = Value>
CLI::Option* add_choice(CLI::App& command, const std::string& flag, Target& value, const Choices<Value>& choices,
                        const std::string& text) {
  CLI::Option* option =
      command
          .add_option_function<std::string>(
              flag, [&value, choices, flag](const std::string& name) { value = chosen(flag, name, choices); }, text)
          ->type_name(list_of(choices, "|"));
  for (const auto& [name, choice] : choices)
    if (value == Target(choice)) option->default_str(name);
  return option;
}

}  // namespace scan2fea::command
