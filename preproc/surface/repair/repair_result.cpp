#include "preproc/surface/repair/repair_result.hpp"

#include <algorithm>
#include <numeric>

namespace scan2fea {

std::string_view name(RepairKind kind) {
  switch (kind) {
    case RepairKind::WeldedVertex:
      return "welded vertex";
    case RepairKind::UnusedVertex:
      return "unused vertex";
    case RepairKind::DegenerateFace:
      return "degenerate face";
    case RepairKind::DuplicateFace:
      return "duplicate face";
    case RepairKind::InnerWall:
      return "inner wall";
    case RepairKind::SplitVertex:
      return "split vertex";
    case RepairKind::NonManifoldFaces:
      return "non-manifold face";
    case RepairKind::TurnedFaces:
      return "turned faces";
    case RepairKind::DroppedSpeck:
      return "dropped speck";
    case RepairKind::DroppedFragment:
      return "dropped fragment";
    case RepairKind::DroppedInside:
      return "dropped inner piece";
    case RepairKind::ClosedHole:
      return "closed hole";
    case RepairKind::PartedTouch:
      return "parted touch";
    case RepairKind::UnitedShell:
      return "united shell";
    case RepairKind::SmoothedFold:
      return "smoothed fold";
    case RepairKind::Intersection:
      return "removed intersection";
  }
  return {};
}

std::size_t RepairResult::count(RepairKind kind) const {
  return static_cast<std::size_t>(
      std::count_if(changes.begin(), changes.end(), [&](const RepairChange& c) { return c.kind == kind; }));
}

double RepairResult::total_size(RepairKind kind) const {
  return std::accumulate(changes.begin(), changes.end(), 0.0,
                         [&](double sum, const RepairChange& c) { return c.kind == kind ? sum + c.size : sum; });
}

}  // namespace scan2fea
