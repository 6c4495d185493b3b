// What a job is of, read from its files or taken from the program that called, which has it in memory.
#pragma once

#include "export/mesh_file.hpp"
#include "preproc/bodies/body_complex.hpp"
#include "preproc/command/make_mesh.hpp"
#include "preproc/mesh/read_cloud.hpp"
#include "preproc/surface/thinning/read_thinned_scan.hpp"

#include <vector>

namespace scan2fea::command {

struct ReadInputs {
  Scan scan;
  std::vector<Body> bodies;  // where there are several, the scan among them
  Notes notes;               // names of theirs that had to be changed
  std::vector<Thinning> thinned;
  std::vector<StageRecord> stages;  // of those
};

// Settles the job's unit, and sets that the input came with. Throws what readers throw, and WrongUsage for a cloud
// among several bodies and where a size cannot be kept of a scan that was thinned.
ReadInputs read_inputs(MakeMeshJob& job, const Progress& progress);

}  // namespace scan2fea::command
