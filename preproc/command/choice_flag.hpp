// A flag that takes one of some names.
#pragma once

#include <CLI/App.hpp>

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

namespace scan2fea::command {

template <class Value>
using Choices = std::vector<std::pair<std::string, Value>>;

template <class Value, class Target = Value>
CLI::Option* add_choice(CLI::App& command, const std::string& flag, Target& value, const Choices<Value>& choices,
                        const std::string& text) {
  std::string list;
  for (const auto& choice : choices) list += (list.empty() ? "" : ", ") + choice.first;
  return command
      .add_option_function<std::string>(
          flag,
          [&value, choices, list, flag](const std::string& name) {
            const auto found =
                std::find_if(choices.begin(), choices.end(), [&](const auto& c) { return c.first == name; });
            if (found == choices.end()) throw CLI::ValidationError(flag, "'" + name + "' is none of " + list);
            value = found->second;
          },
          text + " (" + list + ")")
      ->type_name("NAME");
}

}  // namespace scan2fea::command
