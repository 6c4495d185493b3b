#include "preproc/surface/curved/faces_beyond.hpp"

#include "quality/curved_surface.hpp"
#include "quality/triangle_tree.hpp"

#include <algorithm>
#include <iterator>
#include <utility>

namespace scan2fea {
namespace {

// Plane pieces are this near to the curved faces, over the distance that is to be kept.
constexpr double coarse = 0.1, fine = 0.01;

// Faces cut into plane pieces, and the face of each.
struct Pieces {
  SurfaceMesh mesh;
  std::vector<std::uint32_t> face;
};

void add_pieces(const CurvedSurface& surface, const std::vector<std::uint32_t>& faces, double tolerance,
                Pieces& pieces) {
  std::vector<Vec3> nodes = surface.corners.vertices;
  nodes.insert(nodes.end(), surface.mid.begin(), surface.mid.end());
  std::vector<CurvedTriangle> triangles(faces.size());
  for (std::size_t i = 0; i < faces.size(); ++i)
    std::ranges::copy(surface.nodes_of(faces[i]), triangles[i].nodes.begin());
  const FlatPieces flat = flat_pieces(std::move(nodes), triangles, tolerance);
  append(pieces.mesh, flat.mesh);
  for (const std::uint32_t i : flat.of_piece) pieces.face.push_back(faces[i]);
}

class FaceJudge {
 public:
  FaceJudge(const CurvedSurface& surface, const KeptDeviation& kept, const std::vector<bool>& is_straight)
      : surface_(surface), kept_(kept), is_straight_(is_straight) {}

  // Of these faces.
  std::vector<std::uint32_t> far(const std::vector<std::uint32_t>& faces, double part) const {
    if (faces.empty()) return {};
    Pieces pieces;
    add_pieces(surface_, faces, part * kept_.distance, pieces);
    const OneSidedDeviation to_scan = bound_one_sided_deviation(pieces.mesh, kept_.scan, options(part));
    std::vector<std::uint32_t> found;
    for (std::size_t piece = 0; piece < pieces.face.size(); ++piece)
      if (to_scan.upper[piece] > options(part).limit) found.push_back(pieces.face[piece]);
    return curved(std::move(found));
  }

  // That are nearest to what of the scan is too far away.
  std::vector<std::uint32_t> nearest_to_far(const std::vector<std::uint32_t>& all) const {
    Pieces pieces;
    add_pieces(surface_, all, coarse * kept_.distance, pieces);
    std::vector<std::uint32_t> of_scan, found;
    for (std::uint32_t f = 0; f < kept_.scan.mesh().triangles.size(); ++f) of_scan.push_back(f);
    found = nearest_to_far(of_scan, pieces, coarse);
    if (found.empty()) return found;
    // Finer there, and again for those of the scan that were far.
    add_pieces(surface_, found, fine * kept_.distance, pieces);
    return nearest_to_far(of_scan, pieces, fine);
  }

 private:
  DeviationBoundOptions options(double part) const {
    return {.limit = (1 - part) * kept_.distance, .tolerance = 3 * part};
  }

  // `of_scan`: triangles of the scan to ask for; those that are far are left in it.
  std::vector<std::uint32_t> nearest_to_far(std::vector<std::uint32_t>& of_scan, const Pieces& pieces,
                                            double part) const {
    SurfaceMesh asked{kept_.scan.mesh().vertices, {}};
    for (const std::uint32_t f : of_scan) asked.triangles.push_back(kept_.scan.mesh().triangles[f]);
    const OneSidedDeviation from_scan = bound_one_sided_deviation(asked, pieces.mesh, options(part));
    std::vector<std::uint32_t> far_of_scan, found;
    for (std::size_t i = 0; i < of_scan.size(); ++i)
      if (from_scan.upper[i] > options(part).limit) far_of_scan.push_back(static_cast<std::uint32_t>(i));
    if (!far_of_scan.empty()) {
      const TriangleTree tree(pieces.mesh);
      for (const std::uint32_t i : far_of_scan)
        found.push_back(pieces.face[tree.closest(from_scan.farthest[i]).triangle]);
    }
    std::vector<std::uint32_t> left;
    for (const std::uint32_t i : far_of_scan) left.push_back(of_scan[i]);
    of_scan = std::move(left);
    return curved(std::move(found));
  }

  std::vector<std::uint32_t> curved(std::vector<std::uint32_t> faces) const {
    std::erase_if(faces, [&](std::uint32_t f) { return is_straight_[f]; });
    std::ranges::sort(faces);
    faces.erase(std::ranges::unique(faces).begin(), faces.end());
    return faces;
  }

  const CurvedSurface& surface_;
  const KeptDeviation& kept_;
  const std::vector<bool>& is_straight_;
};

}  // namespace

std::vector<std::uint32_t> faces_beyond(const CurvedSurface& surface, const KeptDeviation& kept,
                                        const std::vector<std::uint32_t>& faces, const std::vector<bool>& is_straight) {
  const FaceJudge judge(surface, kept, is_straight);
  std::vector<std::uint32_t> found = judge.far(judge.far(faces, coarse), fine);
  if (faces.size() < surface.corners.triangles.size()) return found;
  const std::vector<std::uint32_t> nearest = judge.nearest_to_far(faces);
  std::vector<std::uint32_t> both;
  std::ranges::set_union(found, nearest, std::back_inserter(both));
  return both;
}

}  // namespace scan2fea
