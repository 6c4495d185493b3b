// Lengths that were asked for, held against the part: most that make no sense are given in another unit than its own.
#pragma once

#include "preproc/command/make_mesh.hpp"
#include "preproc/mesh/surface_mesh.hpp"

namespace scan2fea::command {

// Throws WrongUsage where a length is larger than anything in the part.
void require_lengths_within(const BoundingBox& part, const MakeMeshJob& job);

}  // namespace scan2fea::command
