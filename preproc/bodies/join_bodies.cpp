#include "preproc/bodies/body_complex.hpp"
#include "preproc/bodies/join_body.hpp"
#include "preproc/bodies/touching_places.hpp"
#include "preproc/mesh/error.hpp"
#include "preproc/mesh/error_text.hpp"
#include "preproc/volume/inside_test.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

namespace scan2fea {
namespace {

// Times the distance that is to be closed, and times the tolerance that did not do, nearest first.
constexpr std::array<double, 4> over_distance{1.01, 1.1, 1.4, 2};
constexpr std::array<double, 4> other_tolerances{0.5, 2, 0.2, 5};
// Of the diagonal. The first is as much as repair draws touching shells apart.
constexpr std::array<double, 3> draw_back{1e-6, 4e-6, 1.6e-5};

// Each edge once in either direction.
void require_closed(const BodyComplex& complex, std::uint32_t body, const std::string& name) {
  std::map<std::pair<std::uint32_t, std::uint32_t>, int> uses;
  for (const Triangle& t : triangles_of_body(complex, body))
    for (std::size_t k = 0; k < 3; ++k) ++uses[{t[k], t[(k + 1) % 3]}];
  for (const auto& [edge, count] : uses) {
    const auto reverse = uses.find({edge.second, edge.first});
    if (count == 1 && reverse != uses.end() && reverse->second == 1) continue;
    throw NotMeshable({.what = "the surface of the body does not close around its contact",
                       .where = name,
                       .value = {},
                       .limit = {},
                       .advice = {},
                       .at = complex.mesh.vertices[edge.first]});
  }
}

void require_volume(const BodyComplex& complex, std::uint32_t body, const Body& given) {
  const double volume = enclosed_volume({complex.mesh.vertices, triangles_of_body(complex, body)});
  const double change = volume / enclosed_volume(given.surface) - 1;
  if (std::abs(change) <= most_volume_change) return;
  throw NotMeshable({.what = "to close its contacts changes the volume of the body",
                     .where = given.name,
                     .value = error_text(100 * change, 3) + " %",
                     .limit = error_text(100 * most_volume_change, 3) + " %",
                     .advice = {},
                     .at = {}});
}

// A body between the two fills the gap.
void drop_filled_gaps(std::span<const Body> bodies, BodyComplex& complex) {
  if (complex.gaps.empty()) return;
  for (std::uint32_t b = 0; b < bodies.size(); ++b) {
    const InsideTest inside(bodies[b].surface);
    std::erase_if(complex.gaps,
                  [&](const OpenGap& gap) { return gap.first != b && gap.second != b && inside(gap.at).inside; });
  }
}

[[noreturn]] void fail_crossing(std::span<const Body> bodies, const TouchingPlace& place, double tolerance) {
  const bool is_same =
      place.first != place.second && lie_alike(bodies[place.first].surface, bodies[place.second].surface, tolerance);
  const std::string& first = bodies[place.first].name;
  throw NotMeshable({.what = is_same ? "the two bodies are one and the same" : "the bodies cross",
                     .where = place.first == place.second ? first : first + " and " + bodies[place.second].name,
                     .value = {},
                     .limit = {},
                     .advice = is_same ? "leave one of them out" : "",
                     .at = place.at});
}

void add_apart(BodyComplex& complex, const Body& body, std::uint32_t b) {
  append(complex.mesh, body.surface);
  complex.sides.resize(complex.mesh.triangles.size(), {.behind = b, .front = no_body});
}

// A contact that is but a strip or a speck, as of a rod or a ball on a plate, may have no clear border: then the bodies
// touch along a line or at a point.
void add_body(BodyComplex& complex, std::span<const Body> bodies, std::uint32_t b, const JoinOptions& options,
              JoinHints& hints) {
  BodyComplex before = complex;
  try {
    join_body(complex, bodies, b, options, hints);
    require_closed(complex, b, bodies[b].name);
    if (options.tolerance || !hints.is_narrow || find_touching_places(complex).empty()) return;
  } catch (const NotMeshable&) {
    if (options.tolerance || hints.closing || !hints.is_narrow) throw;
  }
  complex = std::move(before);
  add_apart(complex, bodies[b], b);
}

BodyComplex joined_as_they_lie(std::span<const Body> bodies, const JoinOptions& options, JoinHints& hints) {
  BodyComplex complex;
  complex.mesh = bodies[0].surface;
  complex.sides.assign(complex.mesh.triangles.size(), {.behind = 0, .front = no_body});
  for (std::uint32_t b = 1; b < bodies.size(); ++b) add_body(complex, bodies, b, options, hints);
  for (std::uint32_t b = 0; b < bodies.size(); ++b) {
    require_closed(complex, b, bodies[b].name);
    require_volume(complex, b, bodies[b]);
  }
  return complex;
}

// Draws bodies back where they touch or cross others beside their contacts: the second of two, then the first, then
// both farther.
BodyComplex joined(std::span<const Body> given, const JoinOptions& options, JoinHints& hints) {
  std::vector<Body> moved;
  std::map<std::pair<std::uint32_t, std::uint32_t>, Touch> touches;
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::size_t> trials;
  while (true) {
    const std::span<const Body> bodies = moved.empty() ? given : std::span<const Body>(moved);
    BodyComplex complex = joined_as_they_lie(bodies, options, hints);
    const std::vector<TouchingPlace> places = find_touching_places(complex);
    if (places.empty()) {
      for (const auto& [pair, touch] : touches)
        if (std::ranges::none_of(complex.contacts, [&](const Contact& contact) {
              return contact.first == pair.first && contact.second == pair.second;
            }))
          complex.touches.push_back(touch);
      drop_filled_gaps(bodies, complex);
      return complex;
    }
    if (moved.empty()) moved.assign(given.begin(), given.end());
    for (const TouchingPlace& place : places) {
      const std::size_t trial = trials[{place.first, place.second}]++;
      if (trial == 2 * draw_back.size() || !only_touch(place, complex)) fail_crossing(given, place, hints.tolerance);
      const std::uint32_t body = trial % 2 == 0 ? place.second : place.first;
      const double distance =
          draw_back[trial / 2] * std::max(bounding_box(given[place.first].surface.vertices).diagonal(),
                                          bounding_box(given[place.second].surface.vertices).diagonal());
      draw_back_at(place, complex, body, distance, moved[body].surface);
      const auto [at, is_new] =
          touches.try_emplace({place.first, place.second}, Touch{place.first, place.second, place.length, 0, place.at});
      at->second.moved += distance;
    }
  }
}

// The first of these tolerances with which the bodies are joined, as the user would give it.
std::optional<std::string> that_works(std::span<const Body> bodies, std::span<const double> times, double length,
                                      const JoinHints& failure) {
  for (const double factor : times) {
    const std::string text = error_text(factor * length);
    const JoinOptions options{.tolerance = std::stod(text)};
    JoinHints hints;
    try {
      const BodyComplex complex = joined(bodies, options, hints);
      const auto closes = [&](const Contact& c) { return c.first == failure.first && c.second == failure.second; };
      if (length != failure.closing || std::ranges::any_of(complex.contacts, closes)) return text;
    } catch (const NotMeshable&) {
      // Another one, then.
    }
  }
  return {};
}

std::string advice(std::span<const Body> bodies, const JoinHints& hints) {
  constexpr std::array<double, 1> once{1};
  std::string text;
  const auto closing = hints.closing ? that_works(bodies, over_distance, *hints.closing, hints)
                                     : that_works(bodies, other_tolerances, hints.tolerance, hints);
  if (closing) text = "--contact " + *closing + (hints.leaves_gap ? " to close it" : "");
  const auto leaving = hints.leaves_gap ? that_works(bodies, once, hints.tolerance, hints) : std::nullopt;
  if (leaving) text += (text.empty() ? "" : ", ") + ("--contact " + *leaving) + " to leave it";
  if (!text.empty()) return text;
  return "--one-body, which makes one of them, or subtract one from the other where they are drawn";
}

}  // namespace

BodyComplex join_bodies(std::span<const Body> bodies, const JoinOptions& options) {
  JoinHints hints;
  try {
    return joined(bodies, options, hints);
  } catch (NotMeshable& error) {
    ErrorParts parts = error.parts();
    if (parts.advice.empty()) parts.advice = advice(bodies, hints);
    error.amend(std::move(parts));
    throw;
  }
}

std::vector<Triangle> triangles_of_body(const BodyComplex& complex, std::uint32_t body) {
  std::vector<Triangle> triangles;
  for (std::size_t f = 0; f < complex.sides.size(); ++f) {
    const Triangle& t = complex.mesh.triangles[f];
    if (complex.sides[f].behind == body) triangles.push_back(t);
    if (complex.sides[f].front == body) triangles.push_back({t[0], t[2], t[1]});
  }
  return triangles;
}

}  // namespace scan2fea
