// Runs TetGen in a child process that can neither crash, hang nor starve the command.
#pragma once

#include "preproc/mesh/progress.hpp"
#include "preproc/volume/tetgen_exchange.hpp"

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <optional>

namespace scan2fea {

struct TetgenLimits {
  // Wall time, after which the child is killed. TetGen needs about 20 s for a million tetrahedra.
  std::chrono::duration<double> time{3600};
  // Address space of the child in bytes. TetGen needs about 1 kB per tetrahedron. None: the machine's.
  std::optional<std::uint64_t> memory_bytes;
  // The worker executable. None: `scan2fea-tetgen`, found by `companion_file`.
  std::optional<std::filesystem::path> worker;
};

// Hands the input to the worker in a file without a name, waits, and reads its output from another. The worker ends
// with this process, however that ends. `progress` is asked some twenty times a second; when it cancels or its time is
// over, the child is killed. Throws MeshingFailed with one line for every way in which the child can fail, IoError
// where the files fail.
TetgenOutput run_tetgen(const TetgenInput& input, const TetgenLimits& limits = {}, const Progress& progress = {});

}  // namespace scan2fea
