// One call of METIS, in a process of its own: it takes signals, prints, calls `exit`, and draws from the random numbers
// of the whole process.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

namespace scan2fea {

// Neighbours of vertex v are those from first[v] to first[v + 1]; each edge is there from both sides.
struct Graph {
  std::vector<std::int32_t> first, neighbours;

  std::int32_t size() const { return static_cast<std::int32_t>(first.size()) - 1; }
};

// The largest number of vertices, edges and parts, of the METIS that this was built with.
std::uint64_t largest_metis_number();

// The part of each vertex, at least two parts, from 0 on. `contiguous`: each hangs together; only of a graph that does.
// Parts may be empty. Throws NotMeshable where METIS fails.
std::vector<std::uint32_t> run_metis(Graph& graph, std::int32_t parts, bool contiguous);

}  // namespace scan2fea
