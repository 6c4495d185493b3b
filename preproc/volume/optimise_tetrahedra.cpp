#include "preproc/volume/optimise_tetrahedra.hpp"

#include "preproc/volume/edge_removal.hpp"
#include "preproc/volume/entropy_smoothing.hpp"
#include "preproc/volume/max_min_relocation.hpp"
#include "preproc/volume/multi_face_removal.hpp"
#include "preproc/volume/patch_relocation.hpp"
#include "preproc/volume/tet_complex.hpp"
#include "preproc/volume/vertex_insertion.hpp"
#include "preproc/volume/vertex_removal.hpp"

#include <algorithm>
#include <limits>
#include <queue>

namespace scan2fea {
namespace {

constexpr double topology_gain = 1.0005;
constexpr double insertion_gain = 1.02;
// Patches cost as much as a thousand other moves. From good_of_patches on, dihedral angles of 34 to 128 degrees, they
// are not worth it; and on bodies of poor elements everywhere the worst have to do.
constexpr double good_of_patches = 1.5;
constexpr std::size_t patches_at_least = 8, elements_a_patch = 2000;
// Stars without an element worse than this are left as the lattice made them.
constexpr double smoothing_threshold = 2;
constexpr int relocation_steps = 8;

// New vertices over elements at the start. A sound surface asks for a hundredth; one of needles would have insertion
// fill it with ever smaller elements for ever smaller gains.
constexpr double most_insertions = 0.025;
constexpr std::size_t insertions_at_least = 40;  // on small meshes
// Below this quality, dihedral angles of 24 or 136 degrees, more rounds are worth their time while they gain.
constexpr double poor = 1.09;
constexpr int most_rounds = 8;

// What was tried on an element without success since it or a neighbour last changed.
constexpr std::uint32_t tried_topology = 1, tried_insertion = 2, tried_relocation = 4;

class Optimisation {
 public:
  Optimisation(const TetMesh& mesh, const OptimiseOptions& options, const BoundaryWays& ways, const Progress& progress)
      : complex_(mesh), options_(options), ways_(ways), progress_(progress) {}

  OptimiseResult run() {
    result_.worst_before = worst();
    insertions_left_ =
        insertions_at_least + static_cast<std::size_t>(most_insertions * static_cast<double>(complex_.slot_count()));
    for (int round = 0; round < 3; ++round) {
      topology(false);
      report(0.1 + 0.15 * round);
      smoothing();
      report(0.15 + 0.15 * round);
    }
    relocation();
    double least = result_.worst_after = worst();
    for (int round = 0; round < options_.insertion_rounds || worth_another(round, least); ++round) {
      report(0.5 + 0.5 * std::min(round, options_.insertion_rounds) / std::max(1, options_.insertion_rounds));
      least = result_.worst_after;
      topology(true);
      relocation();
      result_.worst_after = worst();
    }
    if (options_.patches) {
      patches();
      result_.worst_after = worst();
    }
    report(1);
    return result_;
  }

  const TetComplex& complex() const { return complex_; }

 private:
  struct Candidate {
    double quality;
    std::uint32_t element, version;
    bool operator<(const Candidate& other) const {  // the worst comes first out of a heap
      return quality != other.quality ? quality > other.quality : element > other.element;
    }
  };

  double worst() const {
    double least = std::numeric_limits<double>::infinity();
    for (std::uint32_t t = 0; t < complex_.slot_count(); ++t)
      if (complex_.alive(t)) least = std::min(least, complex_.quality(t));
    return least;
  }

  bool worth_another(int round, double least_before) const {
    return options_.insertion_rounds > 0 && round < most_rounds && result_.worst_after < poor &&
           result_.worst_after > least_before * topology_gain;
  }

  void report(double fraction) {
    fraction_ = fraction;
    progress_.tell("optimise", fraction);
  }

  // Looks at the clock and for an interrupt now and then only.
  bool time_is_up() {
    if (result_.stopped_by_time) return true;
    if (++moves_ % 512 != 0) return false;
    if (!progress_.may_improve()) result_.stopped_by_time = true;
    if (moves_ % 65536 == 0) report(fraction_);
    return result_.stopped_by_time;
  }

  std::vector<Candidate> bad_elements(std::uint32_t tried) const {
    std::vector<Candidate> bad;
    for (std::uint32_t t = 0; t < complex_.slot_count(); ++t) {
      const TetComplex::Element& element = complex_.element(t);
      if (complex_.alive(t) && element.quality < options_.threshold && !(element.tried & tried))
        bad.push_back({element.quality, t, element.version});
    }
    return bad;
  }

  static std::vector<Candidate> sorted(std::vector<Candidate> bad) {  // the worst first
    std::sort(bad.begin(), bad.end(), [](const Candidate& a, const Candidate& b) { return b < a; });
    return bad;
  }

  // Worst first, until every bad element has been tried in its present surroundings.
  void topology(bool with_insertion) {
    const std::uint32_t bit = with_insertion ? tried_insertion : tried_topology;
    std::priority_queue<Candidate> queue({}, bad_elements(bit));
    const auto push = [&](std::uint32_t t) {
      const TetComplex::Element& element = complex_.element(t);
      if (element.quality < options_.threshold && !(element.tried & bit))
        queue.push({element.quality, t, element.version});
    };
    while (!queue.empty() && !time_is_up()) {
      const Candidate candidate = queue.top();
      queue.pop();
      const TetComplex::Element& element = complex_.element(candidate.element);
      if (element.version != candidate.version || (element.tried & bit)) continue;
      if (!mend_by_topology(candidate.element) &&
          !(with_insertion && (mend_by_removal(candidate.element) || mend_by_insertion(candidate.element)))) {
        complex_.mark_tried(candidate.element, bit);
        continue;
      }
      for (const std::uint32_t t : complex_.fresh_slots()) {
        push(t);
        for (const std::uint32_t n : complex_.element(t).link)
          if (!(n & TetComplex::boundary_bit)) push(n);
      }
    }
  }

  bool mend_by_topology(std::uint32_t t) {
    if (complex_.element(t).tried & tried_topology) return false;
    for (std::size_t i = 0; i < 4; ++i)
      for (std::size_t j = i + 1; j < 4; ++j)
        if (remove_edge(complex_, t, i, j, topology_gain, tried_topology)) {
          ++result_.edge_removals;
          return true;
        }
    for (std::size_t k = 0; k < 4; ++k) {
      const std::uint32_t n = complex_.element(t).link[k];
      if ((n & TetComplex::boundary_bit) || (complex_.element(n).tried & tried_topology)) continue;
      if (remove_faces(complex_, t, k, topology_gain)) {
        ++result_.face_removals;
        return true;
      }
    }
    complex_.mark_tried(t, tried_topology);
    return false;
  }

  // Elsewhere the lattice's vertices have their room: nothing is gained then.
  bool mend_by_removal(std::uint32_t t) {
    if (complex_.quality(t) >= poor || !removal_.mend(complex_, t, insertion_gain)) return false;
    ++result_.removals;
    return true;
  }

  bool mend_by_insertion(std::uint32_t t) {
    if (insertions_left_ == 0 || !insertion_.mend(complex_, t, insertion_gain)) return false;
    --insertions_left_;
    ++result_.insertions;
    return true;
  }

  void smoothing() {
    // Which stars are worth a look, by one pass over the elements in the order of memory.
    std::vector<double> least(complex_.node_count(), std::numeric_limits<double>::infinity());
    for (std::uint32_t t = 0; t < complex_.slot_count(); ++t)
      if (complex_.alive(t))
        for (const std::uint32_t v : complex_.element(t).corners) least[v] = std::min(least[v], complex_.quality(t));
    for (std::uint32_t v = 0; v < complex_.node_count() && !time_is_up(); ++v) {
      if (least[v] > smoothing_threshold || complex_.fixed(v)) continue;
      double quality = look_from(complex_, v, around_, faces_);
      Vec3 place = complex_.node(v);
      if (smooth_by_entropy(faces_, place, quality)) complex_.move_node(v, place, around_);
    }
  }

  void relocation() {
    for (const Candidate& candidate : sorted(bad_elements(tried_relocation))) {
      if (time_is_up()) return;
      const TetComplex::Element& element = complex_.element(candidate.element);
      if (!complex_.alive(candidate.element) || element.quality >= options_.threshold) continue;
      const Tetrahedron corners = element.corners;
      bool moved = false;
      for (const std::uint32_t v : corners) {
        if (complex_.fixed(v) && !ways_) continue;
        double quality = look_from(complex_, v, around_, faces_);
        Vec3 place = complex_.node(v);
        if (!(complex_.fixed(v) ? slide_max_min(faces_, ways_, v, place, quality, relocation_steps)
                                : relocate_max_min(faces_, place, quality, relocation_steps)))
          continue;
        complex_.move_node(v, place, around_);
        moved = true;
      }
      if (moved)
        ++result_.relocations;
      else
        complex_.mark_tried(candidate.element, tried_relocation);
    }
  }

  // Around the worst first, each as long as it gains.
  void patches() {
    const double good = std::min(options_.threshold, good_of_patches);
    std::size_t left = patches_at_least + complex_.slot_count() / elements_a_patch;
    for (const Candidate& candidate : sorted(bad_elements(0))) {
      const std::uint32_t t = candidate.element;
      for (bool gains = true; gains && left > 0 && complex_.quality(t) < good && !time_is_up(); --left) {
        gains = relocate_patch(complex_, t, ways_, *options_.patches);
        if (gains) ++result_.patches;
      }
    }
  }

  TetComplex complex_;
  const OptimiseOptions& options_;
  const BoundaryWays& ways_;  // empty where the boundary stays
  const Progress& progress_;
  OptimiseResult result_;
  VertexInsertion insertion_;
  VertexRemoval removal_;
  std::vector<std::uint32_t> around_;
  StarFaces faces_;
  std::size_t insertions_left_ = 0;
  std::size_t moves_ = 0;
  double fraction_ = 0;
};

}  // namespace

OptimiseOptions optimise_options(Effort effort) {
  OptimiseOptions options;
  if (effort == Effort::low) {
    options.threshold = 1.3;
    options.insertion_rounds = 1;
  }
  if (effort == Effort::high) {
    options.threshold = 1.6;
    options.insertion_rounds = 3;
    options.patches = PatchOptions{};
  }
  return options;
}

OptimiseResult optimise_tetrahedra(TetMesh& mesh, std::size_t kept, const OptimiseOptions& options,
                                   const Progress& progress) {
  return optimise_tetrahedra(mesh, kept, options, {}, progress);
}

OptimiseResult optimise_tetrahedra(TetMesh& mesh, std::size_t kept, const OptimiseOptions& options,
                                   const BoundaryWays& ways, const Progress& progress) {
  Optimisation optimisation(mesh, options, ways, progress);
  const OptimiseResult result = optimisation.run();
  mesh = optimisation.complex().to_mesh(kept);
  return result;
}

}  // namespace scan2fea
