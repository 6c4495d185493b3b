#include "preproc/command/stage_words.hpp"

#include <algorithm>
#include <array>
#include <cstdio>
#include <optional>
#include <utility>

namespace scan2fea::command {
namespace {

using Words = std::pair<std::string_view, std::string_view>;

constexpr std::array stages{Words{"read", "reading"},
                            Words{"reconstruct", "laying a surface through the points"},
                            Words{"repair", "repairing the scan"},
                            Words{"enrich", "adding points where there are few"},
                            Words{"faces", "finding the faces of the part"},
                            Words{"symmetry", "finding the mirror plane"},
                            Words{"simplify", "laying triangles"},
                            Words{"mirror", "mirroring the half"},
                            Words{"contact", "joining the bodies"},
                            Words{"interfaces", "laying triangles between bodies"},
                            Words{"tetrahedralize", "filling with tetrahedra"},
                            Words{"renewal", "improving poor tetrahedra"},
                            Words{"slide", "sliding the surface's nodes"},
                            Words{"layers", "adding layers"},
                            Words{"second order", "curving sides"},
                            Words{"measure", "measuring"},
                            Words{"report", "drawing the report"},
                            Words{"write", "writing"}};

constexpr std::array steps{Words{"graph", "edge lengths"},
                           Words{"sizing", "edge lengths"},
                           Words{"orientation", "directions"},
                           Words{"extraction", "triangles"},
                           Words{"shape and fit", "shaping triangles"},
                           Words{"collapse", "contracting edges"},
                           Words{"local refinement", "places far from the scan"},
                           Words{"deviation", "places far from the scan"},
                           Words{"mending places", "badly shaped places"},
                           Words{"mending", "what crosses or is folded"},
                           Words{"tetgen", "TetGen"},
                           Words{"optimise", "shaping tetrahedra"},
                           Words{"close holes", "closing holes"},
                           Words{"remove self-intersections", "what crosses"},
                           Words{"primitives", "planes, cylinders and the like"}};

template <std::size_t n>
std::string_view look_up(const std::array<Words, n>& words, std::string_view name) {
  const auto found = std::ranges::find(words, name, &Words::first);
  return found == words.end() ? name : found->second;
}

std::optional<double> figure(const StageRecord& stage, std::string_view name) {
  const auto found = std::ranges::find(stage.changes, name, [](const auto& change) { return change.first; });
  if (found == stage.changes.end()) return {};
  return found->second;
}

std::string number(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.6g", value);
  return text;
}

// Counts beyond a million, too.
std::string count(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.0f", value);
  return text;
}

std::string all_figures(const StageRecord& stage, bool zeros) {
  std::string text;
  for (const auto& [name, value] : stage.changes) {
    if (value == 0 && !zeros) continue;
    text += (text.empty() ? "" : ", ") + name + " " + number(value);
  }
  return text;
}

std::string told_tetrahedra(const StageRecord& stage) {
  return count(*figure(stage, "tetrahedra")) + " tetrahedra, " + count(*figure(stage, "nodes")) + " nodes";
}

// The few figures that tell what it did; what is lost and made up is among its remarks.
std::string summary(const StageRecord& stage) {
  if (const auto after = figure(stage, "faces_after"); after && stage.name == "simplify") {
    std::string text = count(*figure(stage, "faces_before")) + " triangles became " + count(*after);
    if (const auto deviation = figure(stage, "largest_deviation"))
      text += ", at most " + number(*deviation) + " from the scan";
    return text;
  }
  if (stage.name == "tetrahedralize" && figure(stage, "nodes")) return told_tetrahedra(stage);
  if (stage.name == "second order" && figure(stage, "nodes"))
    return told_tetrahedra(stage) + ", scaled Jacobian at least " + number(*figure(stage, "least_scaled_jacobian"));
  if (stage.name == "layers" && figure(stage, "nodes"))
    return count(*figure(stage, "layer_tetrahedra")) + " tetrahedra behind " +
           count(*figure(stage, "layered_triangles")) + " triangles; " + told_tetrahedra(stage) + " in all";
  if (stage.name == "slide" && stage.remarks.empty())
    return count(*figure(stage, "vertices_moved")) + " nodes moved by at most " +
           number(*figure(stage, "largest_move")) + "; dihedral angles " +
           number(*figure(stage, "min_dihedral_after_deg")) + " to " +
           number(*figure(stage, "max_dihedral_after_deg")) + " deg, were " +
           number(*figure(stage, "min_dihedral_before_deg")) + " to " +
           number(*figure(stage, "max_dihedral_before_deg"));
  if (stage.name == "renewal" && figure(stage, "min_dihedral_before_deg")) {
    const double before = *figure(stage, "min_dihedral_before_deg"), after = *figure(stage, "min_dihedral_after_deg");
    return before == after ? "nothing better than the smallest dihedral angle of " + number(before) + " deg"
                           : "smallest dihedral angle " + number(after) + " deg, was " + number(before);
  }
  std::string text = all_figures(stage, false);
  if (stage.name == "repair" && text == "bodies 1") return "nothing to mend";
  return text.empty() ? "nothing changed" : text;
}

void add_lines(const std::vector<std::string>& lines, std::size_t most, std::string& text) {
  for (std::size_t i = 0; i < std::min(lines.size(), most); ++i) text += "\n  " + lines[i];
  if (lines.size() > most) text += "\n  ... and " + std::to_string(lines.size() - most) + " more with --verbose";
}

}  // namespace

std::string_view words_of_stage(std::string_view stage) {
  return look_up(stages, stage);
}

std::string_view words_of_step(std::string_view step) {
  return look_up(steps, step);
}

std::string describe_stage(const StageRecord& stage, bool in_detail) {
  char seconds[32];
  std::snprintf(seconds, sizeof seconds, ", %.2f s", stage.seconds);
  std::string text = stage.name + ": " + (in_detail ? all_figures(stage, true) : summary(stage)) + seconds;
  const std::size_t most = in_detail ? stage.remarks.size() : 8;
  add_lines(stage.remarks, most, text);
  if (in_detail) add_lines(stage.reasons, stage.reasons.size(), text);
  return text;
}

}  // namespace scan2fea::command
