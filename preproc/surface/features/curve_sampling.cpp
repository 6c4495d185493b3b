#include "preproc/surface/features/curve_sampling.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <utility>

namespace scan2fea {
namespace {

// All three are over the wanted length h. Long segments have candidates for samples at this distance: half of it is as
// much as a step can miss h by, and relaxation takes that away.
constexpr double piece_of_length = 1.0 / 6;
// Vertices of fine polylines that are nearer than this to the last candidate are none.
constexpr double nearest_candidates_of_length = 1.0 / 12;
// No longer step is looked at: two would cost less.
constexpr double longest_step = 2.5;
constexpr int relaxation_sweeps = 6;

// A step longer than this share of its curve would leave too few: with 0.45 there are at least three steps, with 0.65
// two.
constexpr double three_steps = 0.45;
constexpr double two_steps = 0.65;

// A polyline from one end to the other; a loop is cut open at one of its vertices or between two.
struct Polyline {
  std::vector<Vec3> points;
  std::vector<double> arc;     // at each point
  std::vector<double> length;  // wanted, at each point
  std::vector<double> steps;   // of the wanted length up to each point; see count_steps
  double tolerance = 0;
  double longest_share = 1;  // of its length that a step may have

  void count_steps() {
    steps.assign(1, 0);
    for (std::size_t i = 1; i < points.size(); ++i)
      steps.push_back(steps.back() + 2 * (arc[i] - arc[i - 1]) / (length[i] + length[i - 1]));
  }
  double total() const { return arc.back(); }

  std::size_t segment_at(double s) const {
    const auto after = std::upper_bound(arc.begin(), arc.end(), s);
    const auto i = static_cast<std::size_t>(std::max<std::ptrdiff_t>(1, after - arc.begin())) - 1;
    return std::min(i, points.size() - 2);
  }
  double fraction(double s, std::size_t segment) const {
    const double l = arc[segment + 1] - arc[segment];
    return l > 0 ? std::clamp((s - arc[segment]) / l, 0.0, 1.0) : 0;
  }
  Vec3 point(double s) const {
    const std::size_t i = segment_at(s);
    const double t = fraction(s, i);
    return (1 - t) * points[i] + t * points[i + 1];
  }
  double steps_at(double s) const {
    const std::size_t i = segment_at(s);
    return steps[i] + fraction(s, i) * (steps[i + 1] - steps[i]);
  }
  double arc_after(double count) const {
    const auto after = std::upper_bound(steps.begin(), steps.end(), count) - steps.begin();
    const std::size_t i = std::min(static_cast<std::size_t>(std::max<std::ptrdiff_t>(1, after)) - 1, steps.size() - 2);
    const double l = steps[i + 1] - steps[i];
    return arc[i] + (l > 0 ? (count - steps[i]) / l : 0) * (arc[i + 1] - arc[i]);
  }
  double wanted(double s) const {
    const std::size_t i = segment_at(s);
    const double t = fraction(s, i);
    return (1 - t) * length[i] + t * length[i + 1];
  }
};

double squared_distance_to_segment(const Vec3& p, const Vec3& a, const Vec3& b) {
  const Vec3 d = b - a;
  const double dd = d.squaredNorm();
  const double t = dd > 0 ? std::clamp(d.dot(p - a) / dd, 0.0, 1.0) : 0;
  return (p - a - t * d).squaredNorm();
}

// A place on the polyline, with what a step's cost needs.
struct Place {
  double arc;
  Vec3 point;
  double wanted;
  std::size_t next;  // the polyline's first point beyond
};

Place place_at(const Polyline& line, double s) {
  const auto beyond = std::upper_bound(line.arc.begin(), line.arc.end(), s);
  return {s, line.point(s), line.wanted(s), static_cast<std::size_t>(beyond - line.arc.begin())};
}

double step_cost(const Polyline& line, const Place& from, const Place& to) {
  const double wanted = 0.5 * (from.wanted + to.wanted);
  double squared = 0;
  for (std::size_t i = from.next; i < line.points.size() && line.arc[i] < to.arc; ++i)
    squared = std::max(squared, squared_distance_to_segment(line.points[i], from.point, to.point));
  const double length = (to.arc - from.arc) / wanted - 1;
  const double excess = std::max(0.0, std::sqrt(squared) / line.tolerance - 0.5);
  return length * length + 10 * excess * excess;
}

std::vector<Place> candidates(const Polyline& line) {
  std::vector<Place> places{place_at(line, 0)};
  for (std::size_t i = 0; i + 1 < line.points.size(); ++i) {
    const double from = line.arc[i], to = line.arc[i + 1];
    const double h = std::min({line.length[i], line.length[i + 1], 2 * line.longest_share * line.total()});
    const double pieces = std::max(1.0, std::ceil((to - from) / (piece_of_length * h)));
    for (double k = 1; k < pieces; ++k) places.push_back(place_at(line, from + (to - from) * k / pieces));
    const bool last = i + 2 == line.points.size();
    if (last || (to - places.back().arc >= nearest_candidates_of_length * h && line.total() - to > 0))
      places.push_back(place_at(line, to));
  }
  return places;
}

// The cheapest way from the first to the last candidate.
std::vector<Place> cheapest_path(const Polyline& line) {
  const std::vector<Place> places = candidates(line);
  std::vector<double> cost(places.size(), std::numeric_limits<double>::infinity());
  std::vector<std::size_t> before(places.size(), 0);
  cost[0] = 0;
  const double longest = line.longest_share * line.total();
  for (std::size_t j = 1; j < places.size(); ++j) {
    for (std::size_t i = j; i-- > 0;) {
      const double l = places[j].arc - places[i].arc;
      const bool neighbours = i + 1 == j;
      if (!neighbours && (l > longest || l > longest_step * std::max(places[i].wanted, places[j].wanted))) break;
      const double c = cost[i] + step_cost(line, places[i], places[j]);
      if (c < cost[j]) {
        cost[j] = c;
        before[j] = i;
      }
    }
  }
  std::vector<Place> path;
  for (std::size_t j = places.size() - 1; j > 0; j = before[j]) path.push_back(places[j]);
  path.push_back(places.front());
  std::reverse(path.begin(), path.end());
  return path;
}

double cost_of(const Polyline& line, const std::vector<Place>& places, std::size_t from, std::size_t to) {
  const double longest = line.longest_share * line.total();
  double cost = 0;
  for (std::size_t i = from; i < to; ++i) {
    if (places[i + 1].arc - places[i].arc > longest) return std::numeric_limits<double>::infinity();
    cost += step_cost(line, places[i], places[i + 1]);
  }
  return cost;
}

// Candidates are a sixth of h apart, which leaves steps uneven. Between two samples all others are put where their
// steps are the same share of the wanted length, if that costs less; and if not, for half of them at a time: bends hold
// the samples that lie on them.
void even_out(const Polyline& line, std::vector<Place>& places, std::size_t from, std::size_t to) {
  if (to - from < 2) return;
  std::vector<Place> evened = places;
  const double first = line.steps_at(places[from].arc), last = line.steps_at(places[to].arc);
  for (std::size_t i = from + 1; i < to; ++i) {
    const double share = static_cast<double>(i - from) / static_cast<double>(to - from);
    evened[i] = place_at(line, line.arc_after(first + share * (last - first)));
  }
  if (cost_of(line, evened, from, to) <= cost_of(line, places, from, to)) {
    places = std::move(evened);
    return;
  }
  const std::size_t middle = (from + to) / 2;
  even_out(line, places, from, middle);
  even_out(line, places, middle, to);
}

// Evens out what is left between bends that the halves did not part.
void relax(const Polyline& line, std::vector<Place>& places) {
  double shift = piece_of_length / 2;
  for (int sweep = 0; sweep < relaxation_sweeps; ++sweep, shift *= 0.6) {
    for (std::size_t i = 1; i + 1 < places.size(); ++i) {
      for (const double side : {-1.0, 1.0}) {
        const double s = places[i].arc + side * shift * places[i].wanted;
        if (s <= places[i - 1].arc || s >= places[i + 1].arc) continue;
        const double before = cost_of(line, places, i - 1, i + 1);
        const Place old = std::exchange(places[i], place_at(line, s));
        if (cost_of(line, places, i - 1, i + 1) < before) break;
        places[i] = old;
      }
    }
  }
}

std::vector<double> sample(Polyline line) {
  line.count_steps();
  std::vector<Place> places = cheapest_path(line);
  even_out(line, places, 0, places.size() - 1);
  relax(line, places);
  std::vector<double> arcs;
  for (const Place& place : places) arcs.push_back(place.arc);
  return arcs;
}

Polyline polyline(const SurfaceMesh& scan, const FeatureCurve& curve, const std::vector<double>& edge_length,
                  double tolerance) {
  Polyline line;
  line.tolerance = tolerance;
  const std::size_t n = curve.vertices.size() + (curve.closed ? 1 : 0);
  for (std::size_t i = 0; i < n; ++i) {
    const std::uint32_t v = curve.vertices[i % curve.vertices.size()];
    line.points.push_back(scan.vertices[v]);
    line.length.push_back(edge_length[v]);
    line.arc.push_back(i == 0 ? 0 : line.arc.back() + (line.points[i] - line.points[i - 1]).norm());
  }
  return line;
}

// The same loop, cut open at another of its points.
Polyline cut_at(const Polyline& loop, std::size_t start) {
  Polyline line;
  line.tolerance = loop.tolerance;
  line.longest_share = loop.longest_share;
  const std::size_t n = loop.points.size() - 1;
  for (std::size_t i = 0; i <= n; ++i) {
    const std::size_t from = (start + i) % n;
    line.points.push_back(loop.points[from]);
    line.length.push_back(loop.length[from]);
    const double segment = i == 0 ? 0 : loop.arc[(start + i - 1) % n + 1] - loop.arc[(start + i - 1) % n];
    line.arc.push_back(i == 0 ? 0 : line.arc.back() + segment);
  }
  return line;
}

std::size_t sharpest_bend(const Polyline& loop) {
  const std::size_t n = loop.points.size() - 1;
  std::size_t best = 0;
  double least = 2;
  for (std::size_t i = 0; i < n; ++i) {
    const Vec3 in = (loop.points[i] - loop.points[(i + n - 1) % n]).normalized();
    const Vec3 out = (loop.points[i + 1] - loop.points[i]).normalized();
    // The first of equal bends is taken, whatever rounding says.
    if (in.dot(out) < least - 1e-9) {
      least = in.dot(out);
      best = i;
    }
  }
  return best;
}

double parameter(const Polyline& line, double s) {
  const std::size_t i = line.segment_at(s);
  return static_cast<double>(i) + line.fraction(s, i);
}

std::vector<double> sample_open(const Polyline& line) {
  std::vector<double> result;
  for (const double s : sample(line)) result.push_back(parameter(line, s));
  result.front() = 0;
  result.back() = static_cast<double>(line.points.size() - 1);
  return result;
}

std::vector<double> sample_loop(const Polyline& loop) {
  const auto n = static_cast<double>(loop.points.size() - 1);
  const std::size_t start = sharpest_bend(loop);
  const Polyline line = cut_at(loop, start);
  std::vector<double> path = sample(line);
  path.pop_back();
  std::vector<double> result;
  for (const double s : path) {
    const double at = parameter(line, s) + static_cast<double>(start);
    result.push_back(at < n ? at : at - n);
  }
  std::sort(result.begin(), result.end());
  return result;
}

// Wanted lengths that allow for the least number of steps.
void bound_lengths(Polyline& line, double share) {
  line.longest_share = share;
  const double longest = line.total() / (share == three_steps ? 3 : 2);
  for (double& h : line.length) h = std::min(h, longest);
}

}  // namespace

Vec3 curve_point(const SurfaceMesh& scan, const FeatureCurve& curve, double parameter) {
  const std::size_t n = curve.vertices.size();
  const auto i = std::min(static_cast<std::size_t>(parameter), curve.closed ? n - 1 : n - 2);
  const double t = parameter - static_cast<double>(i);
  return (1 - t) * scan.vertices[curve.vertices[i]] + t * scan.vertices[curve.vertices[(i + 1) % n]];
}

std::vector<std::vector<double>> sample_curves(const SurfaceMesh& scan, const FeatureCurves& features,
                                               const std::vector<double>& edge_length,
                                               const CurveSamplingOptions& options) {
  std::vector<Polyline> lines;
  for (const FeatureCurve& curve : features.curves)
    lines.push_back(polyline(scan, curve, edge_length, options.tolerance));

  // Of the curves between two corners the shortest may be one chord.
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::size_t> shortest;
  const auto ends = [&](std::size_t i) {
    const std::vector<std::uint32_t>& v = features.curves[i].vertices;
    return std::pair(std::min(v.front(), v.back()), std::max(v.front(), v.back()));
  };
  for (std::size_t i = 0; i < lines.size(); ++i) {
    if (features.curves[i].closed) continue;
    const auto [at, first] = shortest.try_emplace(ends(i), i);
    if (!first && lines[i].total() < lines[at->second].total()) at->second = i;
  }

  std::vector<std::vector<double>> samples;
  for (std::size_t i = 0; i < lines.size(); ++i) {
    const bool closed = features.curves[i].closed;
    if (closed || ends(i).first == ends(i).second) {
      bound_lengths(lines[i], three_steps);
    } else if (shortest.at(ends(i)) != i) {
      bound_lengths(lines[i], two_steps);
    }
    samples.push_back(closed ? sample_loop(lines[i]) : sample_open(lines[i]));
  }
  return samples;
}

}  // namespace scan2fea
