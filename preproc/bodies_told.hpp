// What is told of several bodies: where they meet, and what became of their volumes.
#pragma once

#include "preproc/bodies/body_complex.hpp"
#include "preproc/pipeline.hpp"

#include <span>
#include <string>
#include <vector>

namespace scan2fea {

// Of the set of faces between two of them.
std::string interface_name(std::span<const Body> bodies, const Sides& sides);

struct Meetings {
  std::vector<MadeContact> contacts;
  std::vector<MadeGap> gaps;
  std::vector<MadeTouch> touches;
};

// Fills the record of the stage that joined them.
Meetings describe_meetings(const BodyComplex& joined, std::span<const Body> bodies, StageRecord& record);

std::string told_volume(const MadeBody& body);

}  // namespace scan2fea
