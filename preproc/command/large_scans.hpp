// Scans that are thinned while they are read, and what that changes in what the user asked for.
#pragma once

#include "preproc/command/make_mesh.hpp"
#include "preproc/surface/thinning/read_thinned_scan.hpp"

#include <string>
#include <vector>

namespace scan2fea::command {

// Of one of the job's files: --largest-scan, and four times the triangles that are asked for.
ThinningLimit thinning_limit(const MakeMeshJob& job);

// For people, gates and reports; `scan` is what it is called.
StageRecord describe(const Thinning& thinning, const std::string& scan, double seconds);

// A share of the triangles is one of those that were given, and a distance from the scan one from that; `triangles` are
// left of all files, of which one was thinned at least. Throws WrongUsage where thinning takes more than half of the
// distance.
void adapt_to_thinned(const std::vector<Thinning>& thinned, double triangles, MakeMeshJob& job);

}  // namespace scan2fea::command
