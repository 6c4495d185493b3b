#include "preproc/command/size_checks.hpp"

#include "preproc/mesh/error.hpp"
#include "preproc/mesh/error_text.hpp"

#include <limits>
#include <optional>
#include <string>

namespace scan2fea::command {
namespace {

[[noreturn]] void refuse(const std::string& what, const char* flag, double value, double limit,
                         const std::string& advice) {
  throw WrongUsage(
      {.what = what, .where = flag, .value = error_text(value), .limit = error_text(limit), .advice = advice});
}

struct Length {
  const char* flag;
  std::optional<double> value;
  const char* what;
  double limit_of_diagonal;
  double advised_of_diagonal;
};

// Of what reaches one side of the part from the other, more is no size of anything in it. A point in the middle is
// within half of the diagonal of all others.
std::vector<Length> lengths_of(const MakeMeshJob& job) {
  const PipelineOptions& options = job.pipeline;
  const std::optional<RelativeLength>& deviation = job.size.deviation;
  std::vector<Length> lengths{{"--edge-length", job.size.edge_length, "edges longer than the part", 1, 0.02},
                              {"--deviation", {}, "a single point is as near to the scan", 0.5, 0.002},
                              {"--interior-size", {}, "edges longer than the part", 1, 0.05},
                              {"--sampling-radius", {}, "a spacing wider than the part", 1, 0.01},
                              {"--thickness", {}, "thicker than the part is long", 1, 0.02},
                              {"--contact", job.joining.tolerance, "gaps wider than the parts", 1, 0.001}};
  if (deviation && !deviation->relative) lengths[1].value = deviation->value;
  if (options.tetrahedralize && options.tetrahedralize->interior_size.unit == InteriorSize::Unit::model)
    lengths[2].value = options.tetrahedralize->interior_size.value;
  if (options.enrich) lengths[3].value = options.enrich->sampling_radius;
  if (options.repair && options.repair->thickness) lengths[4].value = options.repair->thickness->thickness;
  return lengths;
}

// A file of 32-bit coordinates, as most scans are, has no closer truth.
void require_deviation_above_rounding(const RelativeLength& deviation, double diagonal) {
  constexpr double rounding = std::numeric_limits<float>::epsilon() / 2;
  const double length = deviation.relative ? deviation.value * diagonal : deviation.value;
  if (length >= rounding * diagonal) return;
  throw WrongUsage({.what = "closer to the scan than its coordinates are to the part",
                    .where = "--deviation",
                    .value = error_text(length),
                    .limit = error_text(rounding * diagonal, 2),
                    .advice = "0.1%"});
}

}  // namespace

void require_lengths_within(const BoundingBox& part, const MakeMeshJob& job) {
  const double diagonal = part.diagonal();
  if (!(diagonal > 0)) return;  // that is told by others
  if (job.size.deviation) require_deviation_above_rounding(*job.size.deviation, diagonal);
  for (const Length& length : lengths_of(job)) {
    const double limit = length.limit_of_diagonal * diagonal;
    if (length.value && *length.value >= limit)
      refuse(length.what, length.flag, *length.value, limit, error_text(length.advised_of_diagonal * diagonal, 2));
  }
  if (!job.pipeline.simplify) return;
  const auto require_shorter = [&](const char* flag, double length) {
    if (length >= diagonal) refuse("edges longer than the part", flag, length, diagonal, error_text(diagonal / 100, 2));
  };
  for (const SizedBox& box : job.pipeline.simplify->limits.boxes) require_shorter("--size-box", box.length);
  for (const SizedBall& ball : job.pipeline.simplify->limits.balls) require_shorter("--size-ball", ball.length);
}

}  // namespace scan2fea::command
