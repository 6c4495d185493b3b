#include "export/formats.hpp"

#include "export/inp.hpp"
#include "export/smallest_determinant.hpp"
#include "export/text_output.hpp"
#include "export/vtu.hpp"
#include "preproc/mesh/error.hpp"

#include <algorithm>
#include <array>
#include <cctype>

namespace scan2fea {
namespace {

VolumeFormat known_format(const std::filesystem::path& file) {
  if (const auto format = volume_format(file)) return *format;
  throw WrongUsage({.what = "not the extension of a volume mesh",
                    .where = file.string(),
                    .value = file.extension().string(),
                    .limit = {},
                    .advice = std::string(known_volume_formats())});
}

std::string text(double value) {
  char characters[longest_number];
  return {characters, write_number(characters, value)};
}

std::vector<std::string> calculix_warnings(const TetMesh& mesh, const std::filesystem::path& file) {
  const SmallestDeterminant smallest = smallest_determinant(mesh);
  if (smallest.value >= calculix_smallest_determinant || mesh.tetrahedra.empty()) return {};
  std::string warning = file.string() + ": CalculiX will refuse element " +
                        std::to_string(std::uint64_t{smallest.tetrahedron} + 1) + ": Jacobian determinant " +
                        text(smallest.value) + " (limit: " + text(calculix_smallest_determinant) + ")";
  if (smallest.value > 0) warning += "; try: a smaller unit of length, millimetres for metres";
  return {warning};
}

}  // namespace

std::optional<VolumeFormat> volume_format(const std::filesystem::path& file) {
  std::string extension = file.extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  if (extension == ".inp") return VolumeFormat::inp;
  if (extension == ".msh") return VolumeFormat::msh;
  if (extension == ".vtu") return VolumeFormat::vtu;
  return {};
}

std::string_view known_volume_formats() {
  return ".inp (Abaqus, CalculiX), .msh (Gmsh), .vtu (VTK)";
}

VolumeFileWritten write_volume(const TetMesh& mesh, const std::filesystem::path& file,
                               const VolumeFileOptions& options) {
  VolumeFileWritten written;
  switch (known_format(file)) {
    case VolumeFormat::inp:
      write_inp(mesh, file, {.unit = options.unit, .provenance = options.provenance});
      written.warnings = calculix_warnings(mesh, file);
      break;
    case VolumeFormat::msh:
      write_msh(mesh, file, {.version = options.msh_version});
      break;
    case VolumeFormat::vtu:
      write_vtu(mesh, file, {.unit = options.unit, .provenance = options.provenance});
      break;
  }
  return written;
}

TetMesh read_volume(const std::filesystem::path& file) {
  switch (known_format(file)) {
    case VolumeFormat::inp:
      return read_inp(file);
    case VolumeFormat::msh:
      return read_msh(file);
    case VolumeFormat::vtu:
      return read_vtu(file);
  }
  return {};
}

}  // namespace scan2fea
