#include "preproc/surface/repair/repair_result.hpp"

#include "preproc/mesh/names.hpp"

#include <algorithm>
#include <numeric>

namespace scan2fea {
namespace {

constexpr NameTable<RepairKind, 21> names{{
    {RepairKind::WeldedVertex, "welded vertex"},
    {RepairKind::SplitEdge, "split edge"},
    {RepairKind::UnusedVertex, "unused vertex"},
    {RepairKind::DegenerateFace, "degenerate face"},
    {RepairKind::DuplicateFace, "duplicate face"},
    {RepairKind::InnerWall, "inner wall"},
    {RepairKind::SplitVertex, "split vertex"},
    {RepairKind::NonManifoldFaces, "non-manifold face"},
    {RepairKind::TurnedFaces, "turned faces"},
    {RepairKind::DroppedSpeck, "dropped speck"},
    {RepairKind::FilledCavity, "filled cavity"},
    {RepairKind::DroppedFragment, "dropped fragment"},
    {RepairKind::DroppedInside, "dropped inner piece"},
    {RepairKind::RepeatedShell, "repeated shell"},
    {RepairKind::ThickenedSheet, "thickened sheet"},
    {RepairKind::ClosedHole, "closed hole"},
    {RepairKind::Wrapped, "wrapped"},
    {RepairKind::PartedTouch, "parted touch"},
    {RepairKind::UnitedShell, "united shell"},
    {RepairKind::SmoothedFold, "smoothed fold"},
    {RepairKind::Intersection, "removed intersection"},
}};

}  // namespace

std::string_view name(RepairKind kind) {
  return name_in(names, kind);
}

bool is_lost(RepairKind kind) {
  switch (kind) {
    case RepairKind::DuplicateFace:
    case RepairKind::InnerWall:
    case RepairKind::DroppedSpeck:
    case RepairKind::FilledCavity:
    case RepairKind::DroppedFragment:
    case RepairKind::DroppedInside:
    case RepairKind::RepeatedShell:
      return true;
    default:
      return false;
  }
}

bool is_made_up(RepairKind kind) {
  switch (kind) {
    case RepairKind::NonManifoldFaces:
    case RepairKind::ThickenedSheet:
    case RepairKind::ClosedHole:
    case RepairKind::Wrapped:
    case RepairKind::Intersection:
      return true;
    default:
      return false;
  }
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
