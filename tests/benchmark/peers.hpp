// The tools that Debian has for the same task, each behind one function, for comparison only.
#pragma once

#include <string>

namespace scan2fea::benchmark {

struct PeerJob {
  std::string input;
  std::string output;
  std::size_t faces;   // for the simplifiers
  double edge_length;  // for the remesher, which takes no count
};

void cgal_isotropic_remeshing(const PeerJob& job);  // 10 iterations
void cgal_feature_remeshing(const PeerJob& job);    // the same, edges of 40 degrees and borders split and protected
void cgal_garland_heckbert(const PeerJob& job);
void cgal_lindstrom_turk(const PeerJob& job);
void openmesh_quadric(const PeerJob& job);
void openmesh_progressive(const PeerJob& job);  // a progressive mesh by edge length, as in the paper's comparison
void meshoptimizer_simplify(const PeerJob& job);

}  // namespace scan2fea::benchmark
