// Whatever it is given, repair throws one of the project's errors or gives what its header promises.
#include "preproc/surface/repair/repair.hpp"
#include "quality/self_intersections.hpp"
#include "quality/validity.hpp"
#include "tests/fuzz/finding.hpp"
#include "tests/fuzz/soup_of_bytes.hpp"

#include <cmath>

namespace scan2fea::fuzz {
namespace {

// By one byte; mostly the default, which is what nearly everybody uses.
RepairOptions options_of(std::uint8_t byte) {
  RepairOptions options;
  switch (byte % 16) {
    case 0:
      options.level = RepairLevel::gentle;
      break;
    case 1:
      options.holes = Holes::keep;
      break;
    case 2:
      options.largest_hole_of_diagonal.reset();
      break;
    case 3:
      options.level = RepairLevel::off;
      break;
    case 4:
      options.level = RepairLevel::wrap;
      break;
    case 5:
      options.thickness = Thickness{0.25};
      break;
    case 6:
      options.thickness = Thickness{1.5, ThickenTo::front};
      break;
    case 7:
      options = {.level = RepairLevel::wrap, .thickness = Thickness{0.01, ThickenTo::back}};
      break;
    default:
      break;
  }
  return options;
}

// One body, closed, manifold, outwards, of a volume that is no rounding, and crossing nothing.
bool is_sound_body(const SurfaceMesh& mesh) {
  const SurfaceValidity validity = check_validity(mesh);
  return !mesh.triangles.empty() && validity.closed() && validity.manifold() && validity.components == 1 &&
         validity.unused_vertices == 0 && enclosed_volume(mesh) > 1e-4 * std::pow(surface_area(mesh), 1.5) &&
         find_self_intersections(mesh).empty();
}

void require_sound(const SurfaceMesh& mesh, const RepairOptions& options) {
  for (const Vec3& p : mesh.vertices) require(p.allFinite(), "a coordinate that is not finite");
  require(!mesh.triangles.empty(), "no faces");
  const SurfaceValidity validity = check_validity(mesh);
  require(validity.manifold(), "not manifold");
  require(validity.unused_vertices == 0 || options.level == RepairLevel::off, "a vertex of no face");
  require(find_self_intersections(mesh).empty(), "faces that cross");
  if (options.holes == Holes::keep) return;
  require(validity.closed(), "open");
  require(enclosed_volume(mesh) > 0, "no volume");
}

}  // namespace
}  // namespace scan2fea::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace scan2fea;
  fuzz::Bytes bytes({data, size});
  const RepairOptions options = fuzz::options_of(bytes.next());
  const SurfaceMesh soup = fuzz::soup_of(bytes);
  if (soup.triangles.empty()) return 0;
  SurfaceMesh mesh = soup;
  try {
    repair(mesh, options);
    fuzz::require_sound(mesh, options);
    if (fuzz::is_sound_body(soup) || options.level == RepairLevel::off)
      fuzz::require(mesh.vertices == soup.vertices && mesh.triangles == soup.triangles, "a sound body was changed");
  } catch (const NotMeshable& error) {
    fuzz::require_told(error);
    fuzz::require(!fuzz::is_sound_body(soup), "a sound body was refused");
  }
  return 0;
}
