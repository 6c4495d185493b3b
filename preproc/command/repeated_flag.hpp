// An option of several numbers that may be given several times: in a row where a file gives them.
#pragma once

#include <CLI/App.hpp>

#include <functional>

namespace scan2fea::command {

// `take` is called with the numbers of each time, which are finite.
CLI::Option* add_repeated(CLI::App& command, const char* name, int numbers, const char* type, const char* help,
                          const std::function<void(const double*)>& take);

}  // namespace scan2fea::command
