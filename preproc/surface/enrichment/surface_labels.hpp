// Which primitives the vertices of a surface lie on: one on a face of the part, two on a crease, three at a corner,
// none where nothing is known. The primitive of a face is the one that its corners share.
#pragma once

#include "preproc/surface/kernel/halfedge_mesh.hpp"
#include "preproc/surface/primitives/find_primitives.hpp"

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace scan2fea {

// Up to three labels, in the order in which they were added.
class LabelSet {
 public:
  LabelSet() = default;
  explicit LabelSet(std::uint32_t label) { add(label); }

  void add(std::uint32_t label) {
    if (label != no_primitive && !holds(label) && count_ < labels_.size()) labels_[count_++] = label;
  }
  bool holds(std::uint32_t label) const {
    for (const std::uint32_t own : *this)
      if (own == label) return true;
    return false;
  }
  std::size_t size() const { return count_; }
  const std::uint32_t* begin() const { return labels_.data(); }
  const std::uint32_t* end() const { return labels_.data() + count_; }

 private:
  std::array<std::uint32_t, 3> labels_{};
  std::size_t count_ = 0;
};

class SurfaceLabels {
 public:
  using Index = HalfedgeMesh::Index;

  // Of a mesh whose vertices are those that `found` labels. Keeps references.
  SurfaceLabels(const HalfedgeMesh& mesh, const Primitives& found);

  const LabelSet& of(Index v) const { return sets_[v]; }
  void set(Index v, const LabelSet& labels) { sets_[v] = labels; }
  // For the vertex that was added to the mesh last.
  void add(const LabelSet& labels) { sets_.push_back(labels); }

  const std::vector<Primitive>& primitives() const { return found_.list; }
  const Shape& shape(std::uint32_t label) const { return found_.list[label].shape; }

  // The rounding between two primitives, wherever along them it was found; no_primitive where there is none.
  std::uint32_t rounding_between(std::uint32_t one, std::uint32_t other) const;

  // That all corners share; where they share several, the one whose normal is nearest to the face's. no_primitive where
  // they share none.
  std::uint32_t of_face(Index f) const;

  // An edge between faces of different primitives; and one along the end of a crease with one side, the other side
  // running over from one primitive into another that is tangent to it, so that its face lies on neither.
  bool is_crease(Index h) const;
  // Whether the edge may be turned: faces of one primitive, or of none at all.
  bool may_flip(Index h) const;

  // The nearest point that lies on all of these primitives.
  std::optional<Vec3> meeting(const LabelSet& labels, const Vec3& start) const;

  // Of the primitives of a vertex the normal there that is nearest to a direction; `otherwise` where it has none.
  Vec3 normal(Index v, const Vec3& direction, const Vec3& otherwise) const;

 private:
  const HalfedgeMesh& mesh_;
  const Primitives& found_;
  std::vector<LabelSet> sets_;
};

}  // namespace scan2fea
