#include "preproc/bodies/join_body.hpp"

#include "preproc/bodies/contact_border.hpp"
#include "preproc/bodies/contact_faces.hpp"
#include "preproc/bodies/contact_gap.hpp"
#include "preproc/bodies/contact_refinement.hpp"
#include "preproc/bodies/facing_surface.hpp"
#include "preproc/bodies/imprint.hpp"
#include "preproc/bodies/split_surface.hpp"
#include "preproc/mesh/error.hpp"
#include "preproc/mesh/error_text.hpp"
#include "preproc/volume/inside_test.hpp"

#include <algorithm>
#include <cmath>
#include <map>

namespace scan2fea {
namespace {

// Up to so many tolerances a gap may be one that was to be closed.
constexpr double doubtful_gap = 10;
constexpr double told_gap = 0.01;           // of the added body's diagonal
constexpr double rounding = 1e-6;           // of the diagonal
constexpr double shortest_contact = 0.005;  // along a rim, of the diagonal
constexpr double narrow = 0.08;             // of the diagonal
// Of the diagonal: how exactly a contact's border is found where no rim is, but no finer than so many tolerances.
constexpr double resolution = 0.004, resolution_in_tolerances = 2;

std::vector<std::uint32_t> all_of(const SurfaceMesh& mesh) {
  std::vector<std::uint32_t> all(mesh.triangles.size());
  for (std::uint32_t f = 0; f < all.size(); ++f) all[f] = f;
  return all;
}

bool are_apart(const BoundingBox& a, const BoundingBox& b, double distance) {
  return (a.low.array() > b.high.array() + distance).any() || (b.low.array() > a.high.array() + distance).any();
}

// Adds one body to those that are joined already.
class Join {
 public:
  Join(BodyComplex& complex, std::span<const Body> bodies, std::uint32_t added, const JoinOptions& options,
       JoinHints& hints)
      : complex_(complex),
        bodies_(bodies),
        added_(added),
        options_(options),
        hints_(hints),
        body_(bodies[added].surface) {
    for (std::uint32_t f = 0; f < complex.sides.size(); ++f)
      if (complex.sides[f].front == no_body) outer_.push_back(f);
    fuzz_ =
        rounding * std::max(bounding_box(complex.mesh.vertices).diagonal(), bounding_box(body_.vertices).diagonal());
  }

  void run() {
    const std::vector<std::uint32_t> own = all_of(body_);
    tolerance_ = options_.tolerance.value_or(contact_tolerance(complex_.mesh, outer_, body_, own));
    hints_ = {.tolerance = tolerance_, .first = no_body, .second = added_};
    const FacingSurface on_complex(complex_.mesh, outer_, fuzz_), on_body(body_, own, fuzz_);
    const double step = shortest_contact * bounding_box(body_.vertices).diagonal();
    refuse_overlap();
    if (!options_.tolerance) refuse_gaps(on_complex, on_body);
    tell_gaps(on_complex, on_body);
    SplitSurface first(complex_.mesh), second(body_);
    imprint_rims(first, on_complex, body_, own, tolerance_, step);
    imprint_rims(second, on_body, complex_.mesh, outer_, tolerance_, step);
    std::vector<bool> outer(first.mesh().triangles.size());
    for (std::uint32_t f = 0; f < outer.size(); ++f) outer[f] = complex_.sides[first.origin(f)].front == no_body;
    std::vector<bool> all(second.mesh().triangles.size(), true);
    const double edge =
        std::max(resolution * bounding_box(body_.vertices).diagonal(), resolution_in_tolerances * tolerance_);
    const std::size_t contacts = complex_.contacts.size();
    try {
      glue(first, second, outer, all, on_complex, on_body, tolerance_);
    } catch (const NotMeshable&) {
      // Where a contact ends at no rim, triangles may be too large for its border.
      complex_.contacts.resize(contacts);
      refine_contact_border(first, outer, on_complex, on_body, tolerance_, edge);
      refine_contact_border(second, all, on_body, on_complex, tolerance_, edge);
      glue(std::move(first), std::move(second), outer, all, on_complex, on_body, edge);
    }
  }

 private:
  [[noreturn]] void fail(std::string what, double value, const Vec3& place, std::uint32_t other) const {
    throw NotMeshable({.what = std::move(what),
                       .where = bodies_[other].name + " and " + bodies_[added_].name,
                       .value = error_text(value),
                       .limit = error_text(tolerance_),
                       .advice = {},
                       .at = place});
  }

  // Vertices of one that lie deeper in the other.
  void refuse_overlap() const {
    SurfaceMesh outer{complex_.mesh.vertices, {}};
    for (const std::uint32_t f : outer_) outer.triangles.push_back(complex_.mesh.triangles[f]);
    const BoundingBox own_box = bounding_box(body_.vertices), box = bounding_box(outer.vertices);
    if (are_apart(own_box, box, 0)) return;
    const InsideTest in_complex(outer), in_body(body_);
    refuse_inside(in_complex, outer, in_body);
    double deepest = tolerance_;
    Vec3 place;
    std::uint32_t other = no_body;
    for (const Vec3& p : body_.vertices) {
      const InsideTest::Answer answer = in_complex(p);
      if (!answer.inside || answer.distance <= deepest) continue;
      deepest = answer.distance;
      place = p;
      other = complex_.sides[outer_[answer.triangle]].behind;
    }
    for (const std::uint32_t f : outer_)
      for (const std::uint32_t v : complex_.mesh.triangles[f]) {
        const Vec3& p = complex_.mesh.vertices[v];
        if (const InsideTest::Answer answer = in_body(p); answer.inside && answer.distance > deepest) {
          deepest = answer.distance;
          place = p;
          other = complex_.sides[f].behind;
        }
      }
    if (other != no_body) fail_overlap(deepest, place, other);
  }

  // A tolerance that is larger than a body would hide that two solids are in one place.
  void refuse_inside(const InsideTest& in_complex, const SurfaceMesh& outer, const InsideTest& in_body) const {
    if (!options_.tolerance) return;
    const double exact = contact_tolerance(complex_.mesh, outer_, body_, all_of(body_));
    const auto lies_in = [&](const SurfaceMesh& mesh, const InsideTest& other) {
      return std::ranges::all_of(mesh.triangles, [&](const Triangle& t) {
        return std::ranges::all_of(t, [&](std::uint32_t v) {
          const InsideTest::Answer answer = other(mesh.vertices[v]);
          return answer.inside && answer.distance > exact;
        });
      });
    };
    if (!lies_in(body_, in_complex) && !lies_in(outer, in_body)) return;
    const Vec3& place = body_.vertices[body_.triangles.front()[0]];
    const InsideTest::Answer answer = in_complex(place);
    fail("one body lies inside of the other's solid", answer.distance, place,
         complex_.sides[outer_[answer.triangle]].behind);
  }

  [[noreturn]] void fail_overlap(double depth, const Vec3& place, std::uint32_t other) const {
    hints_.closing = depth;
    hints_.first = other;
    fail("the bodies overlap", depth, place, other);
  }

  // Calls take(gap, the other body) for places where the surfaces face one another without touching; a rounding that
  // departs from a contact is none.
  template <class Take>
  void for_each_gap(const FacingSurface& on_complex, const FacingSurface& on_body, double reach, const Take& take) {
    const std::vector<std::uint32_t> own = all_of(body_);
    for (const Gap& gap :
         find_gaps_between({complex_.mesh, outer_, on_complex}, {body_, own, on_body}, tolerance_, reach))
      take(gap, complex_.sides[gap.triangle].behind);
  }

  void refuse_gaps(const FacingSurface& on_complex, const FacingSurface& on_body) {
    std::optional<std::pair<Gap, std::uint32_t>> widest;
    for_each_gap(on_complex, on_body, doubtful_gap * tolerance_, [&](const Gap& gap, std::uint32_t other) {
      if (!widest || gap.widest > widest->first.widest) widest = {gap, other};
    });
    if (!widest) return;
    hints_.closing = widest->first.widest;
    hints_.leaves_gap = true;
    hints_.first = widest->second;
    fail("there is a gap between the bodies", widest->first.widest, widest->first.place, widest->second);
  }

  void tell_gaps(const FacingSurface& on_complex, const FacingSurface& on_body) {
    const double reach = std::max(doubtful_gap * tolerance_, told_gap * bounding_box(body_.vertices).diagonal());
    std::map<std::uint32_t, OpenGap> open;
    for_each_gap(on_complex, on_body, reach, [&](const Gap& gap, std::uint32_t other) {
      const OpenGap told{other, added_, gap.narrowest, tolerance_, gap.middle};
      const auto [at, is_new] = open.try_emplace(other, told);
      if (!is_new && told.size < at->second.size) at->second = told;
    });
    for (const auto& [other, gap] : open) complex_.gaps.push_back(gap);
  }

  // `outer`, `own`: the triangles of both that may touch; `exactness`: of the borders of the contact.
  void glue(SplitSurface first, SplitSurface second, const std::vector<bool>& outer, const std::vector<bool>& own,
            const FacingSurface& on_complex, const FacingSurface& on_body, double exactness) {
    std::vector<bool> of_first = contact_faces(first, outer, on_complex, on_body, tolerance_);
    std::vector<bool> of_second = contact_faces(second, own, on_body, on_complex, tolerance_);
    note_contacts(second, of_second, on_complex, on_body);
    hints_.is_narrow = is_narrow(second.mesh(), own, of_second);
    const auto border = border_of_marked(first.mesh(), outer, of_first);
    const auto border_of_second = border_of_marked(second.mesh(), own, of_second);
    if (border.empty() != border_of_second.empty()) fail_unclear(first, border, second, border_of_second);
    const std::vector<std::uint32_t> image =
        match_borders(first, border, second, border_of_second, tolerance_, exactness);
    // What the borders' new vertices have split.
    for (auto f = static_cast<std::uint32_t>(of_first.size()); f < first.mesh().triangles.size(); ++f)
      of_first.push_back(of_first[first.split_from(f)]);
    for (auto f = static_cast<std::uint32_t>(of_second.size()); f < second.mesh().triangles.size(); ++f)
      of_second.push_back(of_second[second.split_from(f)]);
    take(first, of_first, second, of_second, image);
  }

  [[noreturn]] void fail_unclear(const SplitSurface& first, const std::vector<FeatureEdge>& border,
                                 const SplitSurface& second, const std::vector<FeatureEdge>& other) const {
    const Vec3 place = border.empty() ? second.point(other.front()[0]) : first.point(border.front()[0]);
    throw NotMeshable({.what = "the bodies touch, but it is not clear where",
                       .where = bodies_[added_].name,
                       .value = {},
                       .limit = {},
                       .advice = {},
                       .at = place});
  }

  // A strip of width w has an area of w / 2 times its border.
  bool is_narrow(const SurfaceMesh& mesh, const std::vector<bool>& own, const std::vector<bool>& in_contact) const {
    double area = 0, border = 0;
    for (std::size_t f = 0; f < mesh.triangles.size(); ++f)
      if (in_contact[f]) area += area_vector(mesh, mesh.triangles[f]).norm() / 2;
    for (const auto& [a, b] : border_of_marked(mesh, own, in_contact))
      border += (mesh.vertices[a] - mesh.vertices[b]).norm();
    return 2 * area < narrow * bounding_box(body_.vertices).diagonal() * border;
  }

  void note_contacts(const SplitSurface& second, const std::vector<bool>& of_second, const FacingSurface& on_complex,
                     const FacingSurface& on_body) {
    std::map<std::uint32_t, Contact> contacts;
    for (std::uint32_t f = 0; f < of_second.size(); ++f) {
      if (!of_second[f]) continue;
      const Triangle& t = second.triangle(f);
      const Vec3 middle = centroid(second.mesh(), t);
      for (const Vec3& p : {middle, second.point(t[0]), second.point(t[1]), second.point(t[2])}) {
        const auto foot = on_complex.under(p, on_body.normal(second.origin(f)), tolerance_);
        if (!foot) continue;
        Contact& contact = contacts[complex_.sides[foot->triangle].behind];
        const bool is_first = contact.second != added_;
        if (is_first || std::abs(foot->height) > std::max(contact.largest_gap, contact.largest_overlap)) contact.at = p;
        contact.second = added_;
        contact.largest_gap = std::max(contact.largest_gap, foot->height);
        contact.largest_overlap = std::max(contact.largest_overlap, -foot->height);
      }
      if (const auto foot = on_complex.under(middle, on_body.normal(second.origin(f)), tolerance_))
        ++contacts[complex_.sides[foot->triangle].behind].triangles;
    }
    for (auto& [other, contact] : contacts) {
      if (contact.triangles == 0) continue;  // a corner that touches
      contact.first = other;
      contact.tolerance = tolerance_;
      complex_.contacts.push_back(contact);
    }
  }

  void take(const SplitSurface& first, const std::vector<bool>& of_first, const SplitSurface& second,
            const std::vector<bool>& of_second, std::vector<std::uint32_t> image);

  BodyComplex& complex_;
  std::span<const Body> bodies_;
  std::uint32_t added_;
  const JoinOptions& options_;
  JoinHints& hints_;
  const SurfaceMesh& body_;
  std::vector<std::uint32_t> outer_;
  double fuzz_ = 0, tolerance_ = 0;
};

void Join::take(const SplitSurface& first, const std::vector<bool>& of_first, const SplitSurface& second,
                const std::vector<bool>& of_second, std::vector<std::uint32_t> image) {
  std::vector<Sides> sides;
  for (std::uint32_t f = 0; f < of_first.size(); ++f) {
    Sides& side = sides.emplace_back(complex_.sides[first.origin(f)]);
    if (!of_first[f]) continue;
    side.front = added_;
    for (Contact& contact : complex_.contacts)
      if (contact.first == side.behind && contact.second == added_)
        contact.area += area_vector(first.mesh(), first.triangle(f)).norm() / 2;
  }
  SurfaceMesh mesh = first.mesh();
  for (std::uint32_t f = 0; f < of_second.size(); ++f) {
    if (of_second[f]) continue;
    Triangle t = second.triangle(f);
    for (std::uint32_t& v : t) {
      if (image[v] == no_image) {
        image[v] = static_cast<std::uint32_t>(mesh.vertices.size());
        mesh.vertices.push_back(second.point(v));
      }
      v = image[v];
    }
    if (t[0] == t[1] || t[1] == t[2] || t[2] == t[0]) continue;
    mesh.triangles.push_back(t);
    sides.push_back({.behind = added_, .front = no_body});
  }
  complex_.mesh = std::move(mesh);
  complex_.sides = std::move(sides);
}

}  // namespace

void join_body(BodyComplex& complex, std::span<const Body> bodies, std::uint32_t added, const JoinOptions& options,
               JoinHints& hints) {
  Join(complex, bodies, added, options, hints).run();
}

}  // namespace scan2fea
