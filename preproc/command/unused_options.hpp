// What was asked for and has no effect on this input, so that nobody believes that it had.
#pragma once

#include "preproc/command/read_inputs.hpp"

#include <string>
#include <vector>

namespace scan2fea::command {

// Sentences without a full stop; none where all options count.
std::vector<std::string> unused_options(const MakeMeshJob& job, const ReadInputs& inputs);

}  // namespace scan2fea::command
