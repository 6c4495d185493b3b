// What a person is told of stages: what each is at, and what it did.
#pragma once

#include "preproc/pipeline.hpp"

#include <string>
#include <string_view>

namespace scan2fea::command {

// "simplify" -> "laying triangles"; of the algorithms' own steps, "shape and fit" -> "shaping triangles". What has none
// is its own name.
std::string_view words_of_stage(std::string_view stage);
std::string_view words_of_step(std::string_view step);

// "simplify: 96966 triangles became 12604, 0.41 s", and its first remarks below. In detail all figures, all remarks,
// and why it came out as it did.
std::string describe_stage(const StageRecord& stage, bool in_detail);

}  // namespace scan2fea::command
