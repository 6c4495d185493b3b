// `--version`: of the program, of the libraries that it was built with, and of the format of its figures.
#pragma once

#include <string>

namespace scan2fea::command {

std::string version_text();

}  // namespace scan2fea::command
