// What run, surface, repair, enrich, simplify and tetrahedralize have in common: read, work, measure, gate, write.
#pragma once

#include "preproc/command/flags.hpp"

namespace scan2fea::command {

struct MakeMeshJob {
  CommonFlags common;
  OutputFlag output;
  SizeFlags size;
  PipelineOptions pipeline;
};

// Returns the command's exit status: 0, or 1 if a gate failed, and then nothing is written but the report.
int make_mesh(MakeMeshJob job);

}  // namespace scan2fea::command
