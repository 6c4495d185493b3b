// What decks of all solvers say of a mesh, whatever their language.
#pragma once

#include "export/deck.hpp"
#include "export/set_names.hpp"

#include <optional>
#include <string>
#include <vector>

namespace scan2fea {

// A consistent system of units with the second.
struct DeckUnits {
  std::string length, force, mass, stress;
  double newtons;  // one force
  double metres;   // one length

  double of_stress(double pascals) const { return pascals * metres * metres / newtons; }
  double of_density(double kilograms_per_cubic_metre) const {  // a mass is force over acceleration
    return kilograms_per_cubic_metre * metres * metres * metres * metres / newtons;
  }
  double of_acceleration(double metres_per_square_second) const { return metres_per_square_second / metres; }
  std::string of_density_text() const { return mass + "/" + length + "3"; }
};

struct DeckSet {
  std::string name;  // in the file
  bool of_faces = true;
};

struct DeckParts {
  std::string mesh_file;  // without its folder
  DeckKind kind;
  std::string prefix;  // of all sets
  Numbering numbers;
  DeckUnits units;
  DeckSet fixed;
  std::string fixed_nodes;  // a name for the nodes of `fixed` that no other set of nodes has
  std::string loaded;       // a set of faces; empty where none is needed
  double loaded_area = 0;
  Vec3 loaded_normal = Vec3::Zero();   // the integral of the normal over `loaded`, outwards
  std::size_t shared_nodes = 0;        // of `fixed` and `loaded`
  std::vector<std::string> bodies;     // sets of elements that do not overlap
  std::vector<std::string> no_bodies;  // sets of elements that overlap with these
  std::vector<std::uint32_t> other;    // elements of no body, where there are bodies
  std::string other_name;              // that no other set of elements has
};

// Of steel as it is sold; SI.
struct Steel {
  static constexpr double young = 210e9, poisson = 0.3, density = 7850;
};
inline constexpr double deck_pressure = 1e6;  // Pa: of 1 MPa, since results are proportional to it
inline constexpr double deck_gravity = 9.80665;
inline constexpr int deck_modes = 10;

// Six significant digits, with a point or an exponent, so that no language takes it for an integer.
std::string deck_number(double value);

// What a pressure of `deck_pressure` onto `loaded` comes to, in sentences of the deck's comments.
std::vector<std::string> load_remarks(const DeckParts& parts);

std::string calculix_deck(const DeckParts& parts);
std::string aster_deck(const DeckParts& parts);

}  // namespace scan2fea
