#include "export/units.hpp"

#include "preproc/mesh/error.hpp"
#include "preproc/mesh/error_text.hpp"
#include "preproc/mesh/length_unit.hpp"

namespace scan2fea {
namespace {

[[noreturn]] void fail(std::string what, const std::string& where, std::string value, std::string advice) {
  throw WrongUsage({std::move(what), where, std::move(value), {}, std::move(advice)});
}

}  // namespace

double UnitScale::factor() const {
  return metres(from) / metres(to);
}

UnitScale parse_unit_scale(const std::string& text) {
  const std::size_t colon = text.find(':');
  const auto from = length_unit(text.substr(0, colon));
  const auto to = colon == std::string::npos ? std::nullopt : length_unit(text.substr(colon + 1));
  if (!from || !to)
    fail("not two units of length", "--scale", text, "mm:m; units are " + std::string(known_length_units));
  return {*from, *to};
}

std::string settled_unit(const std::string& of_file, const std::optional<std::string>& of_user,
                         const std::string& file) {
  const std::string known = length_unit(of_file).value_or(of_file);
  if (of_user && !known.empty() && *of_user != known)
    fail("the file says that its unit is " + known, file, "--unit " + *of_user,
         "no --unit; to convert, scan2fea convert --scale " + known + ":" + *of_user);
  return of_user ? *of_user : known;
}

void require_same_unit(const std::string& of_mesh, const std::string& of_file, const std::string& file) {
  const std::string mesh = length_unit(of_mesh).value_or(of_mesh), other = length_unit(of_file).value_or(of_file);
  if (!mesh.empty() && !other.empty() && mesh != other)
    fail("the file says that its unit is " + other, file, "the mesh is in " + mesh,
         "scan2fea convert --scale " + other + ":" + mesh);
}

void apply_scale(MeshFile& file, const UnitScale& scale, const std::string& name) {
  std::visit(
      [&](auto& mesh) {
        if (!mesh.unit.empty() && mesh.unit != scale.from)
          fail("the mesh is in " + mesh.unit, name, "--scale " + scale.from + ":" + scale.to,
               "--scale " + mesh.unit + ":" + scale.to);
        mesh.unit = scale.to;
      },
      file.mesh);
  std::vector<Vec3>& points =
      file.is_volume() ? std::get<TetMesh>(file.mesh).nodes : std::get<NamedSurface>(file.mesh).mesh.vertices;
  for (Vec3& p : points) p *= scale.factor();
}

// Scanners of all kinds, micro-CT the finest of them, see parts from a millimetre on, and what is meshed for a solver
// is a part or a building.
std::optional<std::string> implausible_size(double diagonal, const std::string& unit) {
  constexpr double smallest = 1e-3, largest = 1e3;  // metres
  const double size = diagonal * metres(unit);
  if (diagonal == 0 || (size >= smallest && size <= largest)) return {};
  return "the whole is " + error_text(diagonal, 3) + " " + unit + " across, which is " +
         (size < smallest ? "less than a millimetre" : "more than a kilometre") + ": is the unit right?";
}

}  // namespace scan2fea
