// Simplification: fewer, nearly equilateral triangles that stay on the scan and enclose its volume.
// Source: the paper, section 3 (collapse); the lattice chain joins orientation and position fields with an optimisation
// of entropy and fit.
#pragma once

#include "preproc/mesh/progress.hpp"
#include "preproc/mesh/surface_mesh.hpp"
#include "preproc/surface/simplification/simplify_options.hpp"
#include "preproc/surface/sizing/shorter_edges.hpp"

#include <memory>
#include <optional>
#include <span>

namespace scan2fea {

struct FittedCurves;
class PlanesOfScan;

// `mesh` must be manifold, outward and free of self-intersections (see `repair`), closed or with borders; so is the
// result, with the same genus, components and borders, and with a chain of edges along each crease. The enclosed volume
// of every closed component is kept to rounding by the `lattice` method, and by `collapse` where the lattice gave way
// to it; asked for directly, `collapse` is the paper's method as it is, and moves only what passes through itself
// afterwards. Throws NotMeshable where neither way gives a valid surface, WrongUsage for options out of range,
// Cancelled. On any throw `mesh` is as it was. The same bytes for any number of threads. O(n log n). Not guaranteed:
// that a deviation which is possible is reached, or with the fewest triangles.
SimplifyResult simplify(SurfaceMesh& mesh, const SimplifyOptions& options = {}, const Progress& progress = {});

// The same for those who need the scan afterwards, to compare with, or who may ask for another surface: a copy of it
// less.
class Simplification {
 public:
  // Refers to the scan, which must outlive it. Throws WrongUsage for options out of range.
  Simplification(const SurfaceMesh& scan, const SimplifyOptions& options);
  ~Simplification();

  // See `simplify`.
  SimplifyResult run(SurfaceMesh& surface, const Progress& progress = {});

  // After `run`: one more surface, with shorter edges at these places and at most so many triangles. Nothing, and
  // `surface` as it was, where the budget of the search is spent (see surface_search.hpp) or there is no such surface.
  std::optional<SimplifyResult> run_again(std::span<const ShorterEdges> places, double most_triangles,
                                          SurfaceMesh& surface, const Progress& progress = {});

  // After `run`: the last surface with its vertices at these places, or as far towards them as nothing meets, and the
  // scan's volume. Nothing where it would lose a deviation that was asked for.
  std::optional<SimplifyResult> run_moved(const std::vector<Vec3>& places, SurfaceMesh& surface);
  // Vertices of the last surface that are to stay, since they stand for lines of the scan.
  std::vector<bool> held() const;
  // How far its other vertices may go off it: as far as it is from the scan, where no deviation was asked for.
  double way_off() const;

  // What is plane on the scan.
  const PlanesOfScan& planes() const;

  // Curved triangles of one of these surfaces, by its result; see fit_curves.hpp.
  FittedCurves curved(const SimplifyResult& result, const SurfaceMesh& surface, bool keep_corners = false,
                      const Progress& progress = {}) const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace scan2fea
