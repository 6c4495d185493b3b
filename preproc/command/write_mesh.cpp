#include "preproc/command/write_mesh.hpp"

#include "export/formats.hpp"
#include "preproc/command/quality_fields.hpp"
#include "preproc/mesh/write_surface.hpp"

#include <algorithm>
#include <utility>

namespace scan2fea::command {
namespace {

// As PLY has it.
Field measured_vertices(const NamedSurface& surface, std::size_t count) {
  Field measured{
      .name = "measured", .values = std::vector<double>(surface.mesh.vertices.size(), 0), .names = {"measured"}};
  std::fill_n(measured.values.begin(), count, 1);
  return measured;
}

}  // namespace

bool holds_fields(const std::optional<Holdings>& holds) {
  return holds && holds->fields;
}

Notes write_mesh(const TetMesh& mesh, const std::filesystem::path& file, const MeasuredFrom& from,
                 FileOptions options) {
  const FileFormat* format = find_format(file);
  if (format != nullptr && holds_fields(format->volume)) add_quality_fields(mesh, from.reference, options);
  return write_volume(mesh, file, options);
}

Notes write_mesh(const NamedSurface& surface, const std::filesystem::path& file, const MeasuredFrom& from,
                 FileOptions options) {
  if (from.measured_vertices && is_surface_file(file)) {
    write_surface(surface.mesh, file,
                  {.measured = from.measured_vertices,
                   .unit = surface.unit,
                   .face_sets = {},
                   .ascii = options.ascii,
                   .together = options.together});
    return {};
  }
  const FileFormat* format = find_format(file);
  if (format != nullptr && holds_fields(format->surface)) {
    add_quality_fields(surface, from.reference, options);
    if (from.measured_vertices) options.node_fields.push_back(measured_vertices(surface, *from.measured_vertices));
  }
  return write_surface(surface, file, options);
}

}  // namespace scan2fea::command
