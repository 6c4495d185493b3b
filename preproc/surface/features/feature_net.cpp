#include "preproc/surface/features/feature_net.hpp"

#include <algorithm>

namespace scan2fea {

Vec3 direction_at(const FeatureLine& line, double place) {
  const auto i = std::min(static_cast<std::size_t>(place), line.points.size() - 2);
  return (line.points[i + 1] - line.points[i]).normalized();
}

double advanced(const FeatureLine& line, double place, double step) {
  const double last = static_cast<double>(line.points.size() - 1);
  while (true) {
    if (line.closed && step < 0 && place <= 0) place = last;
    if (line.closed && step > 0 && place >= last) place = 0;
    if ((step < 0 && place <= 0) || (step > 0 && place >= last) || step == 0) return place;
    const double whole = step > 0 ? std::floor(place) : std::ceil(place) - 1;
    const auto i = static_cast<std::size_t>(whole);
    const double segment = (line.points[i + 1] - line.points[i]).norm();
    const double to_end = (step > 0 ? whole + 1 - place : place - whole) * segment;
    if (std::abs(step) < to_end) return place + step / segment;
    place = step > 0 ? whole + 1 : whole;
    step += step > 0 ? -to_end : to_end;
  }
}

double chord_deviation(const FeatureLine& line, double from, double to) {
  const Vec3 a = line.point_at(from), chord = line.point_at(to) - a;
  const double squared_length = chord.squaredNorm();
  double largest = 0;
  const auto visit = [&](double begin, double end) {
    for (auto i = static_cast<std::size_t>(std::ceil(begin)); static_cast<double>(i) <= end; ++i) {
      const Vec3 way = line.points[i] - a;
      const double t = squared_length > 0 ? std::clamp(way.dot(chord) / squared_length, 0.0, 1.0) : 0.0;
      largest = std::max(largest, (way - t * chord).norm());
    }
  };
  if (from <= to) {
    visit(from, to);
  } else {
    visit(from, static_cast<double>(line.points.size() - 1));
    visit(0, to);
  }
  return largest;
}

double middle_place(const FeatureLine& line, double from, double to) {
  const auto length = [&](double begin, double end) {
    double sum = 0;
    Vec3 at = line.point_at(begin);
    const auto go_to = [&](const Vec3& next) {
      sum += (next - at).norm();
      at = next;
    };
    for (auto i = static_cast<std::size_t>(begin) + 1; static_cast<double>(i) < end; ++i) go_to(line.points[i]);
    go_to(line.point_at(end));
    return sum;
  };
  const auto last = static_cast<double>(line.points.size() - 1);
  const double whole = from <= to ? length(from, to) : length(from, last) + length(0, to);
  return advanced(line, from, whole / 2);
}

std::vector<LineEdge> line_edges(const FeatureNet& net) {
  std::vector<LineEdge> edges;
  for (std::uint32_t l = 0; l < net.lines.size(); ++l) {
    const FeatureLine& line = net.lines[l];
    const std::size_t count = line.vertices.size();
    for (std::size_t i = 0; i + (line.closed ? 0 : 1) < count; ++i) {
      const VertexOnLine &from = line.vertices[i], &to = line.vertices[(i + 1) % count];
      edges.push_back({from.vertex, to.vertex, from.place, to.place, l});
    }
  }
  std::sort(edges.begin(), edges.end(), [](const LineEdge& a, const LineEdge& b) { return a.edge() < b.edge(); });
  return edges;
}

std::vector<FeatureEdge> edges_of(const FeatureNet& net) {
  std::vector<FeatureEdge> edges;
  for (const LineEdge& e : line_edges(net)) edges.push_back(e.edge());
  return edges;
}

std::vector<bool> vertices_on_lines(const FeatureNet& net, std::size_t vertices) {
  std::vector<bool> on_line(vertices, false);
  for (const FeatureLine& line : net.lines)
    for (const VertexOnLine& at : line.vertices) on_line[at.vertex] = true;
  return on_line;
}

namespace {

VertexConstraints held(const FeatureNet& net, std::size_t vertices, bool borders_alone) {
  if (net.empty()) return {};
  VertexConstraints constraints(vertices, VertexConstraint::free);
  for (const FeatureLine& line : net.lines)
    for (const VertexOnLine& at : line.vertices)
      if (line.border || !borders_alone) constraints[at.vertex] = VertexConstraint::fixed;
  return constraints;
}

}  // namespace

VertexConstraints held_lines(const FeatureNet& net, std::size_t vertices) {
  return held(net, vertices, false);
}

VertexConstraints held_borders(const FeatureNet& net, std::size_t vertices) {
  return held(net, vertices, true);
}

}  // namespace scan2fea
