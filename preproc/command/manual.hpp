// The manual page, made of what is declared of the commands and their options.
#pragma once

#include <CLI/App.hpp>

#include <string>

namespace scan2fea::command {

// In the language of man(7): for `man -l`, or as scan2fea.1.
std::string manual_page(const CLI::App& root);

}  // namespace scan2fea::command
