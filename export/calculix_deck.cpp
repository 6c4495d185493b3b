#include "export/deck_parts.hpp"
#include "export/text_output.hpp"

#include <sstream>

namespace scan2fea {
namespace {

constexpr const char *static_name = "Static analysis", *modal_name = "Natural frequencies";

void write_head(std::ostream& out, const DeckParts& parts) {
  const DeckUnits& units = parts.units;
  const bool modal = parts.kind == DeckKind::modal;
  out << "** " << (modal ? modal_name : static_name) << " of " << one_line(parts.mesh_file)
      << ", for CalculiX and Abaqus; made by scan2fea, to be edited\n"
      << "** unit of length: " << units.length << "\n"
      << "** Units: " << units.length << ", " << units.force << ", " << units.mass << ", s; so stresses are in "
      << units.stress << " and densities in " << units.of_density_text() << (modal ? ", frequencies in Hz" : "")
      << ".\n"
      << "** What scan2fea cannot know stands below lines with ASSUMED.\n"
      << "*HEADING\n"
      << (modal ? modal_name : static_name) << "\n"
      << "*INCLUDE, INPUT=" << parts.mesh_file << "\n";
}

void write_material(std::ostream& out, const DeckUnits& units) {
  out << "** ASSUMED: steel. Young's modulus (" << units.stress << ") and Poisson's ratio; density ("
      << units.of_density_text() << ")\n"
      << "*MATERIAL, NAME=STEEL\n*ELASTIC\n"
      << deck_number(units.of_stress(Steel::young)) << ", " << deck_number(Steel::poisson) << "\n*DENSITY\n"
      << deck_number(units.of_density(Steel::density)) << "\n";
}

// The elements of no body are a set of the deck's own.
void write_other_elements(std::ostream& out, const DeckParts& parts) {
  out << "** the elements of no body\n*ELSET, ELSET=" << parts.other_name << "\n";
  constexpr std::size_t per_line = 10;
  for (std::size_t i = 0; i < parts.other.size(); ++i)
    out << parts.numbers.element(parts.other[i])
        << (i + 1 == parts.other.size() || (i + 1) % per_line == 0 ? "\n" : ", ");
}

void write_sections(std::ostream& out, const DeckParts& parts) {
  std::vector<std::string> sets = parts.bodies;
  if (!parts.other.empty()) {
    write_other_elements(out, parts);
    sets.push_back(parts.other_name);
  }
  if (sets.empty()) sets.push_back(parts.prefix + "EALL");
  if (sets.size() > 1) out << "** ASSUMED: all bodies are of it. For another, copy the block above and name it here.\n";
  for (const std::string& name : parts.no_bodies) out << "** " << name << " overlaps with a body: no section\n";
  for (const std::string& name : sets) out << "*SOLID SECTION, ELSET=" << name << ", MATERIAL=STEEL\n";
}

void write_load(std::ostream& out, const DeckParts& parts) {
  const DeckUnits& units = parts.units;
  out << "** ASSUMED: a pressure of 1 MPa (" << deck_number(units.of_stress(deck_pressure)) << " " << units.stress
      << ") onto " << parts.loaded << ". Below 0 it pulls.\n";
  for (const std::string& remark : load_remarks(parts)) out << "** " << remark << "\n";
  out << "*DSLOAD\n"
      << parts.loaded << ", P, " << deck_number(units.of_stress(deck_pressure)) << "\n"
      << "** Its weight, too, where the ** are taken away from these two lines: gravity and its direction\n"
      << "** *DLOAD\n** " << parts.prefix << "EALL, GRAV, " << deck_number(units.of_acceleration(deck_gravity))
      << ", 0., 0., -1.\n";
}

}  // namespace

std::string calculix_deck(const DeckParts& parts) {
  std::ostringstream out;
  const std::string fixed = parts.fixed.of_faces ? parts.fixed.name + "_NODES" : parts.fixed.name;
  write_head(out, parts);
  write_material(out, parts.units);
  write_sections(out, parts);
  out << "** ASSUMED: " << parts.fixed.name << " does not move at all. 1, 3 are x to z; 3, 3 would be z alone.\n"
      << "*BOUNDARY\n"
      << fixed << ", 1, 3\n";
  if (parts.kind == DeckKind::modal) {
    out << "*STEP\n** ASSUMED: the lowest " << deck_modes << " modes\n*FREQUENCY\n"
        << deck_modes
        << "\n** The shapes, scaled to a mass of one; frequencies are in the .dat file.\n*NODE FILE\nU\n*END STEP\n";
  } else {
    out << "*STEP\n*STATIC\n";
    write_load(out, parts);
    out << "** Displacements, reactions, stresses and strains for viewers (.frd); the sum of the reactions (.dat)\n"
        << "*NODE FILE\nU, RF\n*EL FILE\nS, E\n*NODE PRINT, NSET=" << fixed << ", TOTALS=ONLY\nRF\n*END STEP\n";
  }
  return out.str();
}

}  // namespace scan2fea
