// What the stages of a run will take, about: for the progress that is shown, and nothing else.
#pragma once

#include "preproc/command/make_mesh.hpp"
#include "preproc/mesh/run_estimate.hpp"

#include <optional>
#include <vector>

namespace scan2fea::command {

// What is known so far.
struct ExpectedWork {
  double scan_triangles;
  bool is_cloud = false;
  bool is_of_bodies = false;
  std::optional<double> triangles = {};  // of the result, once they are made
};

// Of a file, before it is read.
ExpectedWork expected_work(const MakeMeshJob& job);

// In the order in which they come. Where the result's triangles are known, those after simplification.
std::vector<ExpectedStage> expected_stages(const MakeMeshJob& job, const ExpectedWork& work);

// Of a scan's faces, once it is read.
std::vector<ExpectedStage> expected_faces(double scan_triangles);

// Of the sub-commands that measure what was read.
std::vector<ExpectedStage> expected_measuring(const std::vector<std::filesystem::path>& files,
                                              const CommonFlags& flags);

}  // namespace scan2fea::command
