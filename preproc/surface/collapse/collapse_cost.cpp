#include "preproc/surface/collapse/collapse_cost.hpp"

#include <algorithm>
#include <cmath>

namespace scan2fea {
namespace {

using Index = HalfedgeMesh::Index;

// Of the two faces at an edge, from their area vectors: the integral of the squared curvature across the edge, spread
// over a third of the faces, with the chord of the unit normals for the angle between them.
double edge_bending(const Vec3& edge, const Vec3& w1, const Vec3& w2) {
  const double a1 = w1.norm(), a2 = w2.norm();
  if (!(a1 > 0) || !(a2 > 0)) return HUGE_VAL;
  return 6 * edge.squaredNorm() / (a1 + a2) * (w1 / a1 - w2 / a2).squaredNorm();
}

double valence_excess(std::size_t valence) {
  return std::abs(static_cast<double>(valence) - 6);
}

}  // namespace

void merged_rim(const HalfedgeMesh& mesh, Index h, std::vector<Index>& rim) {
  rim.clear();
  const Index o = mesh.opposite(h);
  const auto gather = [&](Index start) {
    for (Index out = mesh.opposite(HalfedgeMesh::prev(start));
         out != HalfedgeMesh::none && HalfedgeMesh::face(out) != HalfedgeMesh::face(start) &&
         (o == HalfedgeMesh::none ||
          (HalfedgeMesh::face(out) != HalfedgeMesh::face(h) && HalfedgeMesh::face(out) != HalfedgeMesh::face(o)));
         out = mesh.opposite(HalfedgeMesh::prev(out)))
      rim.push_back(HalfedgeMesh::next(out));
  };
  const bool at_border = mesh.is_border_vertex(mesh.origin(h)) || mesh.is_border_vertex(mesh.target(h));
  if (!at_border) {
    gather(h);
    gather(o);
    return;
  }
  for (const Index v : {mesh.origin(h), mesh.target(h)})
    mesh.for_each_outgoing(v, [&](Index out) {
      const Index f = HalfedgeMesh::face(out);
      if (f != HalfedgeMesh::face(h) && (o == HalfedgeMesh::none || f != HalfedgeMesh::face(o)))
        rim.push_back(HalfedgeMesh::next(out));
    });
}

CollapsePredictor::CollapsePredictor(const HalfedgeMesh& mesh, CollapseCost cost, std::vector<double> sizing)
    : mesh_(mesh), cost_(cost), sizing_(std::move(sizing)) {
  if (cost_ == CollapseCost::quadric_error) build_quadrics();
  if (cost_ != CollapseCost::bending_energy) return;
  // The median over the edges of bending per area, which noise in flat parts and sharp edges hardly move; where most
  // edges are quite flat it is 0, and a hundredth of the mean serves. The factor is a compromise: at 10 the triangles
  // of flat parts are as large as curvature lets them, and needles (edge ratio 1.55 on the Horse), at 1000 all edges
  // are equally long and the tips lose (1.37, and three times the Hausdorff distance).
  std::vector<double> densities;
  for (Index h = 0; h < 3 * mesh.face_slots(); ++h) {
    const Index o = mesh.opposite(h);
    if (o == HalfedgeMesh::none || o < h) continue;
    const Vec3 w1 = mesh.area_vector(HalfedgeMesh::face(h)), w2 = mesh.area_vector(HalfedgeMesh::face(o));
    const double area = (w1.norm() + w2.norm()) / 6;
    const double bending = edge_bending(mesh.points[mesh.target(h)] - mesh.points[mesh.origin(h)], w1, w2);
    if (area > 0 && std::isfinite(bending)) densities.push_back(bending / area);
  }
  if (densities.empty()) return;
  const auto middle = densities.begin() + static_cast<std::ptrdiff_t>(densities.size() / 2);
  std::nth_element(densities.begin(), middle, densities.end());
  double mean = 0;
  for (const double d : densities) mean += d / static_cast<double>(densities.size());
  flat_energy_ = 100 * std::max(*middle, 0.01 * mean);
}

double CollapsePredictor::operator()(Index h) const {
  switch (cost_) {
    case CollapseCost::bending_energy:
      return bending_energy(h);
    case CollapseCost::quadric_error:
      return quadric_error(h);
    case CollapseCost::edge_length:
      return (mesh_.points[mesh_.target(h)] - mesh_.points[mesh_.origin(h)]).squaredNorm();
    case CollapseCost::sized_length:
      return sized_length(h);
  }
  return 0;
}

void CollapsePredictor::merge(Index kept, Index removed) {
  if (!sizing_.empty()) sizing_[kept] = 0.5 * (sizing_[kept] + sizing_[removed]);
  if (quadrics_.empty()) return;
  Quadric& q = quadrics_[kept];
  const Quadric& r = quadrics_[removed];
  for (std::size_t i = 0; i < q.a.size(); ++i) q.a[i] += r.a[i];
  q.b += r.b;
  q.c += r.c;
}

double CollapsePredictor::bending_energy(Index h) const {
  const Vec3 middle = 0.5 * (mesh_.points[mesh_.origin(h)] + mesh_.points[mesh_.target(h)]);
  merged_rim(mesh_, h, rim_);
  const std::size_t n = rim_.size();
  normals_.resize(n);
  for (std::size_t i = 0; i < n; ++i) {
    normals_[i] = (mesh_.points[mesh_.origin(rim_[i])] - middle).cross(mesh_.points[mesh_.target(rim_[i])] - middle);
  }
  double energy = flat_energy_ * (mesh_.points[mesh_.target(h)] - mesh_.points[mesh_.origin(h)]).squaredNorm();
  for (std::size_t i = 0; i < n; ++i) {
    const std::size_t j = i + 1 < n ? i + 1 : 0;
    const Vec3& corner = mesh_.points[mesh_.target(rim_[i])];
    if (mesh_.target(rim_[i]) == mesh_.origin(rim_[j]))
      energy += edge_bending(corner - middle, normals_[i], normals_[j]);
    const Index outer = mesh_.opposite(rim_[i]);
    if (outer != HalfedgeMesh::none)
      energy += edge_bending(corner - mesh_.points[mesh_.origin(rim_[i])], normals_[i],
                             mesh_.area_vector(HalfedgeMesh::face(outer)));
  }
  return energy;
}

void CollapsePredictor::build_quadrics() {
  quadrics_.resize(mesh_.vertex_slots());
  const BoundingBox box = bounding_box(mesh_.points);
  centre_ = 0.5 * (box.low + box.high);
  for (Index f = 0; f < mesh_.face_slots(); ++f) {
    const Vec3 w = mesh_.area_vector(f);
    const double doubled_area = w.norm();
    if (!(doubled_area > 0)) continue;
    const Vec3 n = w / doubled_area;
    const Triangle t = mesh_.triangle(f);
    const double d = -n.dot(mesh_.points[t[0]] - centre_);
    const double weight = doubled_area / 6;
    for (const Index v : t) {
      Quadric& q = quadrics_[v];
      std::size_t k = 0;
      for (int i = 0; i < 3; ++i)
        for (int j = i; j < 3; ++j) q.a[k++] += weight * n[i] * n[j];
      q.b += weight * d * n;
      q.c += weight * d * d;
    }
  }
}

double CollapsePredictor::quadric_error(Index h) const {
  const Quadric& q = quadrics_[mesh_.origin(h)];
  const Quadric& r = quadrics_[mesh_.target(h)];
  const Vec3 edge = mesh_.points[mesh_.target(h)] - mesh_.points[mesh_.origin(h)];
  const Vec3 x = mesh_.points[mesh_.origin(h)] + 0.5 * edge - centre_;
  std::array<double, 6> a;
  for (std::size_t i = 0; i < a.size(); ++i) a[i] = q.a[i] + r.a[i];
  const double error = a[0] * x[0] * x[0] + a[3] * x[1] * x[1] + a[5] * x[2] * x[2] +
                       2 * (a[1] * x[0] * x[1] + a[2] * x[0] * x[2] + a[4] * x[1] * x[2]) + 2 * (q.b + r.b).dot(x) +
                       q.c + r.c;
  // The length orders flat parts, where the error is rounding: its fourth power has the unit of a quadric weighted by
  // area, and a millionth of it is the error of a bend by a fraction of a degree.
  return std::max(error, 0.0) + 1e-6 * edge.squaredNorm() * edge.squaredNorm();
}

// Contraction joins the valences of the ends and takes one from each apex; a better outcome makes an edge look shorter.
// Each unit that the valences come nearer to six is worth a twentieth of the squared length, and all together at most
// half of it: lengths decide, and among edges of like length valences do.
double CollapsePredictor::sized_length(Index h) const {
  const Index a = mesh_.origin(h), b = mesh_.target(h), o = mesh_.opposite(h);
  const double wanted = 0.5 * (sizing_[a] + sizing_[b]);
  const double relative = (mesh_.points[b] - mesh_.points[a]).squaredNorm() / (wanted * wanted);
  if (mesh_.is_border_vertex(a) || mesh_.is_border_vertex(b)) return relative;
  const std::size_t va = mesh_.valence(a), vb = mesh_.valence(b);
  double gain = valence_excess(va) + valence_excess(vb) - valence_excess(va + vb - 4);
  for (const Index side : {h, o}) {
    const std::size_t v = mesh_.valence(mesh_.origin(HalfedgeMesh::prev(side)));
    gain += valence_excess(v) - valence_excess(v - 1);
  }
  return relative * std::max(0.5, 1 - 0.05 * gain);
}

}  // namespace scan2fea
