#include "preproc/surface/mending/mend_patches.hpp"

#include "preproc/surface/kernel/adjacency.hpp"
#include "preproc/surface/kernel/parallel_blocks.hpp"
#include "quality/face_blocks.hpp"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <exception>
#include <utility>

namespace scan2fea {
namespace {

std::vector<BoundingBox> boxes_of_blocks(const SurfaceMesh& mesh) {
  std::vector<BoundingBox> boxes(parallel_block_count(mesh.triangles.size()));
  for_each_block(mesh.triangles.size(), [&](std::size_t first, std::size_t last) {
    BoundingBox& all = boxes[first / parallel_block_size];
    all = box_of_face(mesh, static_cast<std::uint32_t>(first));
    for (auto f = static_cast<std::uint32_t>(first); f < last; ++f) {
      const BoundingBox box = box_of_face(mesh, f);
      all.low = all.low.cwiseMin(box.low);
      all.high = all.high.cwiseMax(box.high);
    }
  });
  return boxes;
}

}  // namespace

PatchMender::PatchMender(SurfaceMesh& mesh, FeatureNet& net, const ReferenceSurface& scan,
                         const TriangleTree* scan_tree)
    : mesh_(mesh), net_(net), scan_(scan), scan_tree_(scan_tree), boxes_(mesh), built_(mesh.triangles.size()) {
  net.patch_of_face.clear();
  if (scan_tree == nullptr) scan_blocks_ = boxes_of_blocks(scan.whole);
}

std::vector<PatchPlace> PatchMender::mend(std::vector<PatchPlace> places, int rings, Mending how, const PatchGoal& goal,
                                          const Progress& progress) {
  std::vector<PatchPlace> left;
  std::vector<bool> is_covered;  // per vertex
  const std::size_t inserted_before = changes_.inserted, all = places.size();
  while (!places.empty()) {
    progress("mending places", 1 - static_cast<double>(places.size()) / static_cast<double>(all));
    Batch batch = next_batch(std::move(places), rings, is_covered);
    places = std::move(batch.later);
    const std::size_t count = batch.patches.size();
    if (count == 0) break;
    const std::vector<std::vector<std::uint32_t>> scan_faces = scan_faces_near(batch.patches);
    PatchGoal part = goal;
    part.most_vertices =
        (goal.most_vertices - std::min(goal.most_vertices, changes_.inserted - inserted_before)) / count;
    std::vector<PatchOutcome> outcomes(count);
    // The whole scan: cut along its creases, it has no side beyond them that a face next to one could agree with.
    const auto mend_one = [&](std::size_t i) {
      RefinementPatch& patch = batch.patches[i];
      const std::vector<std::uint32_t> around = faces_around(patch);
      const ShorterEdges& place = batch.places[i].shorter;
      PatchGoal here = part;
      here.where = place.where;
      outcomes[i] = how == Mending::improve
                        ? patch.improve(mesh_, around, scan_.whole, scan_faces[i], net_, here)
                        : patch.shorten(mesh_, around, scan_.whole, scan_faces[i], net_, here, place);
    };
    // An exception (no memory is left) would cancel the loops that other patches are in, which then would go on with
    // half of their results.
    std::vector<std::exception_ptr> failed(count);
    tbb::parallel_for(std::size_t{0}, count, [&](std::size_t i) {
      try {
        mend_one(i);
      } catch (...) {
        failed[i] = std::current_exception();
      }
    });
    for (const std::exception_ptr& failure : failed)
      if (failure) std::rethrow_exception(failure);
    for (std::size_t i = 0; i < count; ++i) {
      if (!outcomes[i].reached) left.push_back(std::move(batch.places[i]));
      if (outcomes[i].improved) write(batch.patches[i], scan_faces[i]);
    }
  }
  return left;
}

PatchMender::Batch PatchMender::next_batch(std::vector<PatchPlace> places, int rings,
                                           std::vector<bool>& is_covered) const {
  Batch batch;
  is_covered.resize(mesh_.vertices.size(), false);
  const VertexStars stars(mesh_);
  const std::vector<LineEdge> lines = line_edges(net_);
  for (PatchPlace& place : places) {
    if (std::all_of(place.seeds.begin(), place.seeds.end(), [&](std::uint32_t v) { return is_covered[v]; })) continue;
    RefinementPatch patch(mesh_, stars, place.seeds, rings, place.deviation, lines);
    const bool is_apart = std::none_of(batch.patches.begin(), batch.patches.end(), [&](const RefinementPatch& other) {
      return boxes_meet(patch.box(), other.box());
    });
    (is_apart ? batch.places : batch.later).push_back(std::move(place));
    if (!is_apart) continue;
    for (const std::uint32_t f : patch.faces())
      for (const std::uint32_t v : mesh_.triangles[f]) is_covered[v] = true;
    batch.patches.push_back(std::move(patch));
  }
  return batch;
}

// Per patch the faces of the scan in its box. Without a tree, whole blocks of them are told to be far away by one box,
// since neighbours in a file are mostly neighbours in space.
std::vector<std::vector<std::uint32_t>> PatchMender::scan_faces_near(
    const std::vector<RefinementPatch>& patches) const {
  const SurfaceMesh& scan = scan_.whole;
  std::vector<std::vector<std::uint32_t>> near(patches.size());
  if (scan_tree_ != nullptr) {
    for (std::size_t p = 0; p < patches.size(); ++p) {
      scan_tree_->for_each_overlap(patches[p].box(), [&](std::uint32_t f) { near[p].push_back(f); });
      std::sort(near[p].begin(), near[p].end());
    }
    return near;
  }
  using Hits = std::vector<std::pair<std::uint32_t, std::uint32_t>>;  // patch, face
  std::vector<Hits> hits(parallel_block_count(scan.triangles.size()));
  for_each_block(scan.triangles.size(), [&](std::size_t first, std::size_t last) {
    const std::size_t block = first / parallel_block_size;
    for (std::uint32_t p = 0; p < patches.size(); ++p) {
      if (!boxes_meet(scan_blocks_[block], patches[p].box())) continue;
      for (auto f = static_cast<std::uint32_t>(first); f < last; ++f)
        if (boxes_meet(box_of_face(scan, f), patches[p].box())) hits[block].emplace_back(p, f);
    }
  });
  for (const Hits& block : hits)
    for (const auto& [p, f] : block) near[p].push_back(f);
  return near;
}

// Ascending, but for the patch's own.
std::vector<std::uint32_t> PatchMender::faces_around(const RefinementPatch& patch) const {
  std::vector<std::uint32_t> around;
  const auto add = [&](std::uint32_t f) {
    if (!std::binary_search(patch.faces().begin(), patch.faces().end(), f)) around.push_back(f);
  };
  boxes_.for_each_overlap(patch.box(), add);
  // Those that came since are few.
  for (auto f = static_cast<std::uint32_t>(built_); f < mesh_.triangles.size(); ++f)
    if (boxes_meet(box_of_face(mesh_, f), patch.box())) add(f);
  std::sort(around.begin(), around.end());
  return around;
}

void PatchMender::write(const RefinementPatch& patch, const std::vector<std::uint32_t>& scan_faces) {
  const auto first_new = static_cast<std::uint32_t>(mesh_.triangles.size());
  patch.write(mesh_, net_);
  std::vector<std::uint32_t>& changed = changes_.changed;
  for (const std::uint32_t f : patch.faces()) {
    changed.push_back(f);
    if (f < built_) boxes_.set(f, box_of_face(mesh_, f));
  }
  for (std::uint32_t f = first_new; f < mesh_.triangles.size(); ++f) changed.push_back(f);
  changes_.scan_faces.insert(changes_.scan_faces.end(), scan_faces.begin(), scan_faces.end());
  changes_.inserted += patch.inserted();
  ++changes_.patches;
}

}  // namespace scan2fea
