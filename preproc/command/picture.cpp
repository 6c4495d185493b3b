#include "quality/picture/picture.hpp"

#include "export/units.hpp"
#include "preproc/command/choice_flag.hpp"
#include "preproc/command/flags.hpp"
#include "preproc/command/loaded_mesh.hpp"
#include "preproc/command/option_text.hpp"
#include "preproc/command/output_files.hpp"
#include "preproc/command/picture_flags.hpp"
#include "preproc/command/progress_display.hpp"
#include "preproc/command/sub_commands.hpp"
#include "preproc/mesh/error.hpp"
#include "preproc/mesh/error_text.hpp"
#include "preproc/mesh/file_extension.hpp"
#include "preproc/mesh/numbers.hpp"
#include "quality/curved_surface.hpp"
#include "quality/picture/cut_open.hpp"
#include "quality/picture/legend.hpp"
#include "quality/picture/png.hpp"

#include <algorithm>
#include <array>
#include <span>
#include <string_view>

namespace scan2fea::command {
namespace {

// The names of --colour, and of those that show a measure its name and the legend's title.
struct Colouring {
  const char *name, *measure, *title;
};
constexpr auto colourings =
    std::to_array<Colouring>({{"none", nullptr, nullptr},
                              {"deviation", "deviation", "Deviation, "},
                              {"edge-ratio", "edge_ratio", "Edge ratio"},
                              {"min-angle", "min_angle_deg", "Smallest angle, degrees"},
                              {"scaled-jacobian", "scaled_jacobian", "Scaled Jacobian"},
                              {"min-dihedral", "min_dihedral_deg", "Smallest dihedral, degrees"},
                              {"max-dihedral", "max_dihedral_deg", "Largest dihedral, degrees"},
                              {"face", nullptr, nullptr},
                              {"measured", nullptr, nullptr}});

Choices<const Colouring*> choices() {
  Choices<const Colouring*> list;
  for (const Colouring& colouring : colourings) list.emplace_back(colouring.name, &colouring);
  return list;
}

struct PictureFlags {
  std::filesystem::path input, output;
  const Colouring* colour = nullptr;
  std::vector<std::filesystem::path> references;  // several are bodies
  std::optional<ColourRange> range;
  std::optional<CutFlag> cut;
  Vec3 eye = view_direction("iso");  // from the model
  PictureSize size;
  bool edges = false;
  std::optional<std::string> unit;
  bool force = false;
  std::optional<std::string> from;
  DisplayFlags display;

  // Where nothing was said, what there is to be seen.
  std::string_view colour_by() const {
    if (colour != nullptr) return colour->name;
    return references.empty() ? "none" : "deviation";
  }
};

void require_usable(const PictureFlags& flags) {
  if (lower_case_extension(flags.output) != ".png")
    throw WrongUsage({.what = "a picture is a PNG file",
                      .where = flags.output.string(),
                      .value = flags.output.extension().string(),
                      .limit = {},
                      .advice = "-o PICTURE.png"});
  if (flags.colour_by() == "deviation" && flags.references.empty())
    throw WrongUsage({.what = "nothing to measure the deviation from",
                      .where = "--colour deviation",
                      .value = {},
                      .limit = {},
                      .advice = "--reference SCAN"});
  if (flags.range && (flags.colour_by() == "none" || flags.colour_by() == "face" || flags.colour_by() == "measured"))
    throw WrongUsage({.what = "colours without a scale have no range",
                      .where = "--range",
                      .value = "--colour " + std::string(flags.colour_by()),
                      .limit = {},
                      .advice = "--colour edge-ratio, or another measure"});
  std::vector<std::filesystem::path> inputs{flags.input};
  inputs.insert(inputs.end(), flags.references.begin(), flags.references.end());
  require_writable({{flags.output}}, inputs, flags.force);
}

const std::vector<double>& values_of(const MeasuredElements& measure, const ElementMeasures& all) {
  const bool of_faces = measure.of == "triangles";
  if (measure.measure == "deviation") return all.deviation;
  if (measure.measure == "edge_ratio") return of_faces ? all.face_edge_ratio : all.edge_ratio;
  if (measure.measure == "min_angle_deg") return all.face_min_angle_deg;
  if (measure.measure == "min_dihedral_deg") return all.min_dihedral_deg;
  return measure.measure == "max_dihedral_deg" ? all.max_dihedral_deg : all.scaled_jacobian;
}

[[noreturn]] void fail(const char* what, const PictureFlags& flags, const char* advice) {
  throw WrongUsage({.what = what,
                    .where = flags.input.string(),
                    .value = "--colour " + std::string(flags.colour_by()),
                    .limit = {},
                    .advice = advice});
}

ElementColours colours_of(const LoadedMesh& mesh, const ElementMeasures& measures, const std::string& unit,
                          const PictureFlags& flags) {
  const std::string_view by = flags.colour_by();
  const std::size_t faces = measures.faces.triangles.size();
  const std::vector<NamedSet>& sets = mesh.volume_mesh ? mesh.volume_mesh->face_sets : mesh.face_sets;
  if (by == "none") return {.of_faces = std::vector<Rgb>(faces, neutral_colour), .of_tetrahedra = {}, .legend = {}};
  if (by == "measured") return colours_of_made_up(sets, faces);
  if (by == "face") {
    ElementColours colours = colours_of_sets(sets, faces);
    if (colours.legend.names.empty())
      fail("the mesh has no sets of faces", flags, "scan2fea faces IN -o FACES.vtu, and a picture of that");
    return colours;
  }
  const Colouring& colouring = *std::ranges::find(colourings, by, &Colouring::name);
  const std::vector<MeasuredElements> histograms = histograms_of(measures);
  const MeasuredElements* found = find_measure(histograms, colouring.measure);
  if (found == nullptr) fail("a surface has no tetrahedra to colour", flags, "--colour edge-ratio, or min-angle");
  MeasuredElements measure = *found;
  if (flags.range) {
    const BarScale scale{.low = flags.range->low, .high = flags.range->high, .bars = measure.scale.bars};
    measure = count_elements(measure.measure, measure.of, values_of(measure, measures), scale);
  }
  std::vector<std::uint32_t> behind;
  if (mesh.volume_mesh)
    for (std::size_t f = 0; f < faces; ++f) behind.push_back(mesh.volume_mesh->boundary[f].tetrahedron);
  std::string title = colouring.title;
  if (by == "deviation") title += unit.empty() ? "model units" : unit;
  return colours_of_measure(measure, std::move(title), behind);
}

// Of two sides of a cut the one nearer to the eye is taken away.
Cut cut_before(const CutFlag& flag, const Vec3& eye, const SurfaceMesh& mesh) {
  const BoundingBox box = bounding_box(mesh.vertices);
  Cut cut{.normal = flag.normal, .offset = flag.offset.value_or(flag.normal.dot(0.5 * (box.low + box.high)))};
  if (cut.normal.dot(eye) < 0) cut = {.normal = -cut.normal, .offset = -cut.offset};
  double least = infinity, largest = -infinity;
  for (const Vec3& p : mesh.vertices) {
    least = std::min(least, flag.normal.dot(p));
    largest = std::max(largest, flag.normal.dot(p));
  }
  if (flag.offset && (*flag.offset <= least || *flag.offset >= largest))
    throw WrongUsage({.what = "the plane of the cut misses the part",
                      .where = "--cut",
                      .value = error_text(*flag.offset),
                      .limit = "between " + error_text(least) + " and " + error_text(largest),
                      .advice = "the normal alone, which cuts through the middle"});
  return cut;
}

// What is drawn: triangles with their colours, and which of their sides are edges of the mesh, where not all are.
struct Shown {
  SurfaceMesh mesh;
  std::vector<Rgb> colours;
  std::vector<std::array<bool, 3>> sides;
};

// Curved ones in flat pieces that no eye tells from them.
Shown shown(const TetMesh& mesh, std::span<const BoundaryFace> faces, std::vector<Rgb> colours, double pixel) {
  Shown shown;
  if (mesh.order() == 1) {
    shown.mesh.vertices = mesh.nodes;
    for (const BoundaryFace f : faces) shown.mesh.triangles.push_back(boundary_triangle(mesh, f));
    shown.colours = std::move(colours);
    return shown;
  }
  FlatPieces pieces = flat_pieces(mesh, faces, 0.1 * pixel);
  shown.mesh = std::move(pieces.mesh);
  constexpr double rounding = 1e-9;
  for (std::size_t f = 0; f < pieces.of_piece.size(); ++f) {
    shown.colours.push_back(colours[pieces.of_piece[f]]);
    std::array<bool, 3>& sides = shown.sides.emplace_back();
    for (std::size_t k = 0; k < 3; ++k) {
      const Eigen::Vector2d &p = pieces.places[f][(k + 1) % 3], &q = pieces.places[f][(k + 2) % 3];
      sides[k] = std::max(p.x(), q.x()) < rounding || std::max(p.y(), q.y()) < rounding ||
                 std::min(p.sum(), q.sum()) > 1 - rounding;
    }
  }
  return shown;
}

// Of a volume mesh that is cut open, whole elements.
Shown cut_open(const TetMesh& mesh, const Cut& cut, const ElementColours& colours, double pixel) {
  const SeenFaces seen = seen_faces(mesh, cut);
  constexpr Rgb of_inside{226, 229, 233};  // where the colours say nothing of it
  std::vector<Rgb> list;
  for (std::size_t i = 0; i < seen.faces.size(); ++i) {
    const std::uint32_t face = seen.boundary_face[i];
    list.push_back(face != SeenFaces::inside       ? colours.of_faces[face]
                   : colours.of_tetrahedra.empty() ? of_inside
                                                   : colours.of_tetrahedra[seen.faces[i].tetrahedron]);
  }
  return shown(mesh, seen.faces, std::move(list), pixel);
}

Raster drawn(const LoadedMesh& mesh, const SurfaceMesh& faces, const ElementColours& colours,
             const PictureFlags& flags) {
  const std::uint32_t width = flags.size.width - legend_width(colours.legend, flags.size.width, flags.size.height);
  const bool is_from_above = flags.eye.normalized().cross(Vec3::UnitZ()).norm() < 1e-6;
  PictureView view = view_of_all(faces, -flags.eye, is_from_above ? Vec3::UnitY() : Vec3::UnitZ(),
                                 static_cast<double>(width) / flags.size.height);
  std::optional<Cut> cut;
  if (flags.cut) cut = cut_before(*flags.cut, flags.eye, faces);
  PictureOptions options{.width = width, .height = flags.size.height, .edges = flags.edges};
  if (!mesh.volume_mesh) {
    view.cut = cut;
    return draw_raster(faces, colours.of_faces, view, options);
  }
  const TetMesh& volume = *mesh.volume_mesh;
  const double pixel = view.height / flags.size.height;
  const Shown seen =
      cut ? cut_open(volume, *cut, colours, pixel)
          : shown(volume, std::span(volume.boundary.data(), volume.outer_faces()), colours.of_faces, pixel);
  options.sides = seen.sides;
  return draw_raster(seen.mesh, seen.colours, view, options);
}

int picture(const PictureFlags& flags) {
  require_usable(flags);
  ProgressDisplay display(flags.display);
  display.begin("read");
  const LoadedMesh mesh = load_mesh(file_to_read(flags.input, flags.from));
  const std::string unit = settled_unit(mesh.unit, flags.unit, flags.input.string());
  const LoadedReference reference = load_references(flags.references, unit);
  const bool is_measured = flags.colour_by() == "deviation";
  const SurfaceMesh* scan = is_measured && reference.surface ? &*reference.surface : nullptr;
  const std::vector<Vec3>* points = is_measured && reference.cloud ? &reference.cloud->points : nullptr;
  const ElementMeasures measures = mesh.volume_mesh ? measure_elements(*mesh.volume_mesh, scan, points)
                                                    : measure_elements(mesh.surface, scan, points);
  ElementColours colours = colours_of(mesh, measures, unit, flags);
  if (2 * legend_width(colours.legend, flags.size.width, flags.size.height) > flags.size.width) {
    colours.legend = {};
    display.line("the picture is too narrow for what its colours mean");
  }
  const Raster raster = with_legend(drawn(mesh, measures.faces, colours, flags), colours.legend, flags.size.width);
  OutputFiles outputs;
  outputs.add(flags.output, png(raster.width, raster.height, raster.rgba));
  outputs.commit();
  display.line(flags.output.string() + ": " + std::to_string(raster.width) + " x " + std::to_string(raster.height) +
               " pixels, of " + std::to_string(measures.faces.triangles.size()) + " triangles");
  return 0;
}

}  // namespace

SubCommand add_picture(CLI::App& root) {
  const auto flags = std::make_shared<PictureFlags>();
  CLI::App* app = root.add_subcommand("picture", "Draws a mesh as a PNG: coloured, cut open, from any side");
  app->group(look_group);
  app->footer(
      "Examples:\n"
      "  scan2fea picture part.vtu -o part.png --reference scan.ply\n"
      "  scan2fea picture part.inp -o cut.png --colour scaled-jacobian --cut y=18 --edges");
  app->add_option("input", flags->input, "What to read: a surface, or a volume mesh")->required()->type_name("FILE");
  {
    const OptionGroup files(*app, "Files");
    app->add_option("-o,--output", flags->output, "What to write")->required()->type_name("FILE.png");
    add_from_flag(*app, flags->from);
  }
  add_choice<const Colouring*>(*app, "--colour", flags->colour, choices(), "By what elements are coloured");
  app->add_option("--reference", flags->references, "What the deviation is measured from; of several bodies, each")
      ->type_name("FILE")
      ->allow_extra_args(false);
  const OptionGroup group(*app, "What is drawn");
  add_picture_flags(*app, flags->range, flags->cut, flags->eye, flags->size);
  app->add_flag("--edges", flags->edges, "Draw the edges of the elements");
  add_unit_flag(*app, flags->unit);
  add_force_flag(*app, flags->force);
  add_display_flags(*app, flags->display);
  return {app, [flags] { return picture(*flags); }};
}

}  // namespace scan2fea::command
