#include "preproc/bodies_told.hpp"

#include "preproc/mesh/error_text.hpp"
#include "preproc/mesh/union_find.hpp"

#include <algorithm>

namespace scan2fea {
namespace {

std::string told(const MadeContact& contact) {
  return contact.first + " and " + contact.second + " touch: " + std::to_string(contact.triangles_closed) +
         " triangles closed, the largest gap " + error_text(contact.largest_gap, 3) + ", the largest overlap " +
         error_text(contact.largest_overlap, 3) + " (tolerance " + error_text(contact.tolerance, 3) + "), at " +
         error_text(contact.at);
}

std::string told(const MadeGap& gap) {
  return gap.first + " and " + gap.second + " face one another across a gap of " + error_text(gap.size, 3) +
         " that stays open (tolerance " + error_text(gap.tolerance, 3) + "), at " + error_text(gap.at);
}

std::string told(const MadeTouch& touch) {
  const std::string where = touch.length > 0 ? "line alone, " + error_text(touch.length, 3) + " long" : "point alone";
  return touch.first + " and " + touch.second + " touch at a " + where + ", at " + error_text(touch.at) +
         ": drawn apart by " + error_text(touch.moved, 3) +
         ", they share no nodes there; a tie or a hinge is for the solver";
}

}  // namespace

std::string interface_name(std::span<const Body> bodies, const Sides& sides) {
  return "INTERFACE_" + bodies[sides.behind].name + "_" + bodies[sides.front].name;
}

Meetings describe_meetings(const BodyComplex& joined, std::span<const Body> bodies, StageRecord& record) {
  Meetings meetings;
  double gap = 0, overlap = 0, area = 0, open = 0;
  std::size_t closed = 0;
  UnionFind parts(bodies.size());
  for (const Contact& contact : joined.contacts) {
    parts.unite(contact.first, contact.second);
    meetings.contacts.push_back({.first = bodies[contact.first].name,
                                 .second = bodies[contact.second].name,
                                 .set = interface_name(bodies, {contact.first, contact.second}),
                                 .triangles_closed = contact.triangles,
                                 .largest_gap = contact.largest_gap,
                                 .largest_overlap = contact.largest_overlap,
                                 .tolerance = contact.tolerance,
                                 .at = contact.at});
    gap = std::max(gap, contact.largest_gap);
    overlap = std::max(overlap, contact.largest_overlap);
    area += contact.area;
    closed += contact.triangles;
    record.remarks.push_back(told(meetings.contacts.back()));
  }
  for (const OpenGap& left : joined.gaps) {
    meetings.gaps.push_back({bodies[left.first].name, bodies[left.second].name, left.size, left.tolerance, left.at});
    open = std::max(open, left.size);
    record.remarks.push_back(told(meetings.gaps.back()));
  }
  for (const Touch& touch : joined.touches) {
    meetings.touches.push_back(
        {bodies[touch.first].name, bodies[touch.second].name, touch.length, touch.moved, touch.at});
    record.remarks.push_back(told(meetings.touches.back()));
  }
  std::size_t count = 0;
  for (std::uint32_t b = 0; b < bodies.size(); ++b) count += parts.find(b) == b;
  record.changes = {{"bodies", static_cast<double>(bodies.size())},
                    {"contacts", static_cast<double>(joined.contacts.size())},
                    {"contact_area", area},
                    {"triangles_closed", static_cast<double>(closed)},
                    {"largest_gap", gap},
                    {"largest_overlap", overlap},
                    {"open_gaps", static_cast<double>(joined.gaps.size())},
                    {"largest_open_gap", open},
                    {"touches", static_cast<double>(joined.touches.size())},
                    {"parts", static_cast<double>(count)}};
  if (count > 1)
    record.remarks.push_back(std::to_string(count) +
                             " parts that do not touch: a solver finds the system singular unless each is held");
  return meetings;
}

std::string told_volume(const MadeBody& body) {
  return body.name + ": volume " + error_text(body.volume) + ", " +
         error_text(100 * (body.volume / body.volume_of_scan - 1), 3) + " % from its scan's, " +
         error_text(100 * (body.volume / body.volume_joined - 1), 3) + " % from that after it was joined";
}

}  // namespace scan2fea
