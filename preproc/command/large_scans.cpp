#include "preproc/command/large_scans.hpp"

#include "preproc/mesh/error.hpp"
#include "preproc/mesh/error_text.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <string>

namespace scan2fea::command {
namespace {

// 0 where no number is asked for.
double wanted_triangles(const SizeFlags& size, const GivenScan& scan) {
  if (size.faces) return static_cast<double>(*size.faces);
  if (size.ratio) return *size.ratio * static_cast<double>(scan.triangles);
  if (size.edge_length) return scan.area / (std::numbers::sqrt3 / 4 * *size.edge_length * *size.edge_length);
  return 0;
}

// So that each triangle stands for several of the scan; more than any file holds is as good as all.
std::size_t needed_triangles(const SizeFlags& size, const GivenScan& scan) {
  constexpr double a_wanted = 4, all = 1e15;
  return static_cast<std::size_t>(std::min(all, a_wanted * wanted_triangles(size, scan)));
}

// Two digits, rounded up.
std::string rounded_up(double number) {
  const double unit = std::pow(10, std::floor(std::log10(number)) - 1);
  char text[32];
  std::snprintf(text, sizeof text, "%.0f", std::ceil(number / unit) * unit);
  return text;
}

// The distance grows with the cells, the triangles fall with their square.
[[noreturn]] void refuse_distance(const Thinning& thinning, double asked) {
  const double times = 2 * thinning.largest_distance / asked;
  throw WrongUsage({.what = "the scan was thinned, which takes more than half of the distance",
                    .where = "--deviation",
                    .value = error_text(asked),
                    .limit = error_text(2 * thinning.largest_distance),
                    .advice = "--largest-scan " +
                              rounded_up(std::min(1.2 * 4 * times * times * static_cast<double>(thinning.triangles),
                                                  static_cast<double>(thinning.given.triangles)))});
}

}  // namespace

ThinningLimit thinning_limit(const MakeMeshJob& job) {
  return {.largest = *job.largest_scan / (1 + job.more_bodies.size()),
          .needed = [size = job.size](const GivenScan& scan) { return needed_triangles(size, scan); }};
}

StageRecord describe(const Thinning& thinning, const std::string& scan, double seconds) {
  StageRecord record;
  record.name = "thin";
  record.seconds = seconds;
  record.changes = {{"triangles_given", static_cast<double>(thinning.given.triangles)},
                    {"triangles_left", static_cast<double>(thinning.triangles)},
                    {"cell", thinning.cell},
                    {"largest_distance", thinning.largest_distance}};
  std::string volume;
  if (thinning.volume_change) {
    const double of_volume = 100 * *thinning.volume_change;
    record.changes.emplace_back("volume_difference_pct", of_volume);
    volume = ", their volumes differ by " + error_text(of_volume, 2) + " %";
  }
  const double percent = 100 * thinning.largest_distance / thinning.given.box.diagonal();
  record.warnings.push_back(
      scan + " has " + std::to_string(thinning.given.triangles) + " triangles and was thinned to " +
      std::to_string(thinning.triangles) + " while it was read: neither surface is farther than " +
      error_text(thinning.largest_distance, 3) + " from the other (" + error_text(percent, 2) + " % of the size), at " +
      error_text(thinning.farthest) + volume +
      "; what is told of distances and volumes is from the thinned one; --largest-scan sets how many are left");
  for (const std::string& set : thinning.lost_sets)
    record.warnings.push_back("the set " + set + " of " + scan +
                              " is gone: it was smaller than what was thinned to a vertex, " +
                              error_text(thinning.cell, 3) + "; try: a larger --largest-scan, or --set");
  return record;
}

void adapt_to_thinned(const std::vector<Thinning>& thinned, double triangles, MakeMeshJob& job) {
  double given = triangles;
  for (const Thinning& thinning : thinned) {
    given += static_cast<double>(thinning.given.triangles) - static_cast<double>(thinning.triangles);
    if (!job.size.deviation) continue;
    RelativeLength& deviation = *job.size.deviation;
    const double asked = deviation.relative ? deviation.value * thinning.given.box.diagonal() : deviation.value;
    if (asked < 2 * thinning.largest_distance) refuse_distance(thinning, asked);
  }
  if (job.size.ratio) *job.size.ratio *= given / triangles;
  if (!job.size.deviation) return;
  const Thinning& farthest = *std::ranges::max_element(thinned, {}, &Thinning::largest_distance);
  RelativeLength& deviation = *job.size.deviation;
  deviation.value -= farthest.largest_distance / (deviation.relative ? farthest.given.box.diagonal() : 1);
}

}  // namespace scan2fea::command
