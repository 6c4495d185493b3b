#include "export/surface_files.hpp"

#include "export/set_names.hpp"
#include "preproc/mesh/read_surface.hpp"
#include "preproc/mesh/write_surface.hpp"

namespace scan2fea {

Notes write_plain_surface(const NamedSurface& surface, const std::filesystem::path& file, const FileOptions& options) {
  write_surface(
      surface.mesh, file,
      {.measured = {}, .unit = surface.unit, .face_sets = {}, .ascii = options.ascii, .together = options.together});
  return {};
}

Notes write_obj_groups(const NamedSurface& surface, const std::filesystem::path& file, const FileOptions& options) {
  Notes notes;
  const NameRules rules{.longest = 200, .upper_case = false, .allowed = "_-.+:/()", .starts_with_letter = false};
  const std::vector<std::string> names = names_for(surface.face_sets, rules, {}, notes);
  std::vector<NamedSet> sets = surface.face_sets;
  for (std::size_t s = 0; s < sets.size(); ++s) sets[s].name = names[s];
  write_surface(surface.mesh, file,
                {.measured = {},
                 .unit = surface.unit,
                 .face_sets = std::move(sets),
                 .ascii = false,
                 .together = options.together});
  return notes;
}

MeshFile read_plain_surface(const std::filesystem::path& file) {
  return {.mesh = read_named_surface(file), .numbers = {}, .has_own_numbers = false, .warnings = {}};
}

}  // namespace scan2fea
