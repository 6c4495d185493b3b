// What solvers and others ask of a mesh, each with its source: what a report's page names beside a figure, and what the
// ready-made gates of --gates hold a mesh to.
//
// A solver's limit is that beyond which it warns by default; where it knows no warning, that beyond which it ends. A
// limit is here only where its source says it of the very figure that we measure: Ansys' and Nastran's aspect ratios of
// tetrahedra, Ansys' Jacobian ratio and Abaqus' shape factor are other figures.
#pragma once

#include "quality/gates.hpp"

#include <span>
#include <string_view>

namespace scan2fea {

struct MeasureLimit {
  std::string_view figure;
  Comparison comparison;  // that a good mesh meets
  double value;
  enum class Beyond { is_unusual, warning, error, worse_than_paper } beyond;
  char source;           // the letter of a LimitSource
  std::string_view set;  // of --gates; empty: told, and no gate
  // The elements that it is a limit of: the triangles of a volume mesh's boundary are none.
  enum class Of { triangles, tetrahedra, either } of;
};

struct LimitSource {
  char letter;
  std::string_view text;
};

std::span<const MeasureLimit> measure_limits();
std::span<const LimitSource> limit_sources();
std::string_view text_of_source(char letter);

// "abaqus", ...: in the order of the documentation.
std::span<const std::string_view> gate_sets();

// Throws WrongUsage where the set has no limit for such a mesh.
std::vector<Gate> gates_of_set(std::string_view set, bool is_volume_mesh);

}  // namespace scan2fea
