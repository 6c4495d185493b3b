#include "preproc/command/flags.hpp"

#include "preproc/command/choice_flag.hpp"
#include "preproc/command/gate_flags.hpp"
#include "preproc/mesh/length_unit.hpp"

#include <CLI/Validators.hpp>

#include <algorithm>
#include <cmath>
#include <utility>

namespace scan2fea::command {
namespace {

// CLI11's own positive-number check lets inf and nan pass.
const CLI::Validator positive(
    [](std::string& text) {
      char* end = nullptr;
      const double value = std::strtod(text.c_str(), &end);
      const bool number = end != text.c_str() && *end == '\0' && std::isfinite(value);
      return number && value > 0 ? std::string() : "must be a number above 0, is '" + text + "'";
    },
    "NUMBER > 0");

// The values of an enumeration under the names that the library gives them.
template <class Enum, std::size_t n>
Choices<Enum> named(const Enum (&values)[n]) {
  Choices<Enum> choices;
  for (const Enum value : values) choices.emplace_back(std::string(name_of(value)), value);
  return choices;
}

const Choices<ThickenTo> thicken_sides{
    {"both", ThickenTo::both}, {"front", ThickenTo::front}, {"back", ThickenTo::back}};

// A whole number counts bodies; a length has a point or an exponent.
KeptBodies parse_bodies(const std::string& text) {
  if (text == "all") return AllBodies{};
  if (text == "largest") return LargestBodies{};
  if (!text.empty() && text.find_first_not_of("0123456789") == std::string::npos && text.size() < 10 &&
      std::stoul(text) > 0)
    return LargestBodies{std::stoul(text)};
  char* end = nullptr;
  const double length = std::strtod(text.c_str(), &end);
  if (text.find_first_of(".e") == std::string::npos || *end != '\0' || !std::isfinite(length) || length <= 0)
    throw CLI::ValidationError("--keep",
                               "'" + text + "' is none of largest, all, a number of bodies (2), a length (2.0)");
  return BodiesAbove{length};
}

// An option of `numbers` numbers that may be given several times: in a row where a file gives them.
CLI::Option* add_repeated(CLI::App& command, const char* name, int numbers, const char* type, const char* help,
                          const std::function<void(const double*)>& take) {
  return command
      .add_option_function<std::vector<double>>(
          name,
          [take, numbers](const std::vector<double>& values) {
            for (std::size_t i = 0; i < values.size(); i += static_cast<std::size_t>(numbers)) take(values.data() + i);
          },
          help)
      ->type_size(numbers)
      ->expected(1, CLI::detail::expected_max_vector_size)
      ->allow_extra_args(false)
      ->type_name(type);
}

}  // namespace

RelativeLength parse_length(const std::string& flag, const std::string& text, char suffix) {
  RelativeLength length;
  length.relative = !text.empty() && text.back() == suffix;
  const std::string number = length.relative ? text.substr(0, text.size() - 1) : text;
  char* end = nullptr;
  length.value = std::strtod(number.c_str(), &end);
  if (number.empty() || *end != '\0' || !std::isfinite(length.value) || length.value <= 0)
    throw CLI::ValidationError(flag, "'" + text + "' is no length above 0, as 0.5" +
                                         (suffix == no_suffix ? " is" : std::string(" or 0.5") + suffix + " are"));
  if (suffix == '%' && length.relative) length.value /= 100;
  return length;
}

TargetSize SizeFlags::target() const {
  if (faces) return FaceCount{*faces};
  if (ratio) return FaceRatio{*ratio};
  if (edge_length) return MeanEdgeLength{*edge_length};
  if (!deviation) return SimplifyOptions{}.size;
  return LargestDeviation{
      .distance = deviation->value,
      .unit = deviation->relative ? LargestDeviation::Unit::of_diagonal : LargestDeviation::Unit::model};
}

void add_unit_flag(CLI::App& command, std::optional<std::string>& unit) {
  const auto short_name = [](std::string& text) {
    const std::optional<std::string> known = length_unit(text);
    if (known) text = *known;
    return known ? std::string() : "'" + text + "' is none of " + std::string(known_length_units);
  };
  command.add_option("--unit", unit, "Length unit of the input, recorded in what is written")
      ->transform(CLI::Validator(short_name, "UNIT"))
      ->type_name("UNIT");
}

void add_common_flags(CLI::App& command, CommonFlags& flags) {
  command.add_option("input", flags.input, "What to read")->required()->type_name("FILE");
  add_unit_flag(command, flags.unit);
  command.add_option("--json", flags.json, "Write all figures as JSON (- for stdout)")->type_name("FILE");
  command.add_option("--report", flags.report, "Write report.html and report.json into this folder")->type_name("DIR");
  command.add_flag("--report-pdf", flags.report_pdf, "Print the report as report.pdf, too, by Chromium")
      ->needs("--report");
  command.add_option("--threads", flags.threads, "Number of threads; 0 for all. The result does not depend on it")
      ->check(CLI::Range(0, 1024))
      ->type_name("N");
  command.add_option("--seed", flags.seed, "Of the random points by which distances are measured")
      ->capture_default_str()
      ->type_name("N");
  command.add_option("--config", flags.config, "Options from a TOML file, under the flags' names")->type_name("FILE");
  add_force_flag(command, flags.force);
  command.add_flag("--quiet", flags.quiet, "No messages but errors");
  add_gate_flags(command, flags);
}

void add_output_flag(CLI::App& command, std::filesystem::path& output) {
  command.add_option("-o,--output", output, "What to write; its extension tells the format")
      ->required()
      ->type_name("FILE");
}

void add_time_limit_flag(CLI::App& command, std::optional<double>& seconds) {
  command
      .add_option("--time-limit", seconds,
                  "Of the whole command, seconds: the best mesh that there is by then, or exit code 4")
      ->check(positive)
      ->type_name("S");
}

void add_force_flag(CLI::App& command, bool& force) {
  command.add_flag("--force", force, "Overwrite outputs that exist, reports too");
}

void add_size_flags(CLI::App& command, SizeFlags& flags) {
  CLI::Option* faces = command.add_option("--faces", flags.faces, "Wanted number of surface triangles")
                           ->check(CLI::Range(std::size_t{4}, std::size_t{1} << 31))
                           ->type_name("N");
  CLI::Option* ratio = command.add_option("--ratio", flags.ratio, "Wanted triangles over those of the input")
                           ->check(positive)
                           ->type_name("R");
  CLI::Option* edge_length = command.add_option("--edge-length", flags.edge_length, "Wanted mean edge, model units")
                                 ->check(positive)
                                 ->type_name("L");
  CLI::Option* deviation =
      command
          .add_option_function<std::string>(
              "--deviation",
              [&flags](const std::string& text) { flags.deviation = parse_length("--deviation", text, '%'); },
              "Largest distance to the scan, model units or % of the bounding box's diagonal; the default is 0.2%")
          ->type_name("D");
  const std::vector<CLI::Option*> sizes{faces, ratio, edge_length, deviation};
  for (CLI::Option* one : sizes)
    for (CLI::Option* other : sizes)
      if (one != other) one->excludes(other);
}

void add_reconstruct_flags(CLI::App& command, ReconstructOptions& options) {
  add_choice<ReconstructionMethod>(
      command, "--reconstruction", options.method,
      named({ReconstructionMethod::automatic, ReconstructionMethod::advancing_front, ReconstructionMethod::poisson}),
      "How a cloud becomes a surface: through its points, or smooth and near them");
  command
      .add_option("--largest-cloud", options.largest_cloud,
                  "Thin a cloud to at most so many points; the default is 100000, or twice --faces")
      ->check(CLI::Range(std::size_t{1000}, std::size_t{100'000'000}))
      ->type_name("N");
  add_repeated(command, "--scanner", 3, "X Y Z",
               "Where the scanner stood, whatever the cloud tells; may be given several times",
               [&options](const double* v) { options.scanners.emplace_back(v[0], v[1], v[2]); })
      ->delimiter(',');
}

void add_repair_flags(CLI::App& command, RepairOptions& options) {
  add_choice<RepairLevel>(
      command, "--repair", options.level,
      {{"off", RepairLevel::off},
       {"gentle", RepairLevel::gentle},
       {"full", RepairLevel::full},
       {"wrap", RepairLevel::wrap}},
      "How far repair may go: not at all, without moving or making up anything, as far as it takes, "
      "or, where that fails, to a surface around the scan");
  add_choice<Holes>(command, "--holes", options.holes, {{"close", Holes::close}, {"keep", Holes::keep}},
                    "What becomes of holes; kept ones make a surface that no volume fits in");
  command
      .add_option_function<std::string>(
          "--largest-hole",
          [&options](const std::string& text) {
            if (text == "all") {
              options.largest_hole_of_diagonal.reset();
              return;
            }
            const RelativeLength length = parse_length("--largest-hole", text, '%');
            if (!length.relative) throw CLI::ValidationError("--largest-hole", "takes a percentage or 'all'");
            options.largest_hole_of_diagonal = length.value;
          },
          "Close holes up to this size, % of their component's diagonal, or 'all'; the default is 35%")
      ->type_name("P%");
  command
      .add_option_function<std::string>(
          "--thickness",
          [&options](const std::string& text) {
            const std::size_t colon = text.find(':');
            const std::string side = colon == std::string::npos ? "both" : text.substr(colon + 1);
            const RelativeLength length = parse_length("--thickness", text.substr(0, colon), no_suffix);
            const auto named = std::find_if(thicken_sides.begin(), thicken_sides.end(),
                                            [&](const auto& choice) { return choice.first == side; });
            if (named == thicken_sides.end())
              throw CLI::ValidationError("--thickness", "'" + text + "' is no length with :both, :front or :back");
            options.thickness = Thickness{length.value, named->second};
          },
          "Make a solid of this thickness of an open sheet, to both sides of it or, with :front or :back after the "
          "length, to one")
      ->type_name("T");
  command
      .add_option_function<std::string>(
          "--keep", [&options](const std::string& text) { options.bodies = parse_bodies(text); },
          "Bodies that stay: 'largest', 'all', the N largest, or those above a length in model units (5.0); by default "
          "all but what is small beside the largest: a tenth of its size and a thousandth of its volume")
      ->type_name("BODIES");
}

void add_enrich_flags(CLI::App& command, EnrichOptions& options, std::string& domain) {
  command
      .add_option_function<std::string>(
          "--scheme",
          [&options](const std::string& name) {
            if (name == "literal") options = EnrichOptions::literal();
          },
          "literal: section 2 of the paper as it is written, for comparison; sound, the default")
      ->check(CLI::IsMember({"sound", "literal"}))
      ->type_name("NAME");
  Choices<std::optional<StarObjective>> places;
  for (const auto& [name, objective] :
       named({StarObjective::entropy_weighted, StarObjective::shannon, StarObjective::a_entropy,
              StarObjective::regularised_a_entropy, StarObjective::mean_edge_ratio}))
    places.emplace_back(name, objective);
  add_choice(command, "--place-by", options.place_by, places,
             "Move new points to where this objective of their star is best; by default they stay on the bisector");
  command
      .add_option("--sampling-radius", options.sampling_radius,
                  "R_s, the spacing that the points should have, model units; by default the scan's own, evened out")
      ->check(positive)
      ->type_name("R");
  add_choice<Lifting>(command, "--lifting", options.lifting,
                      named({Lifting::triharmonic, Lifting::moving_least_squares, Lifting::modified_quadratic_shepard,
                             Lifting::hermite, Lifting::shepard}),
                      "How new points find their height where no primitive tells it");
  command.add_flag("--primitives,!--no-primitives", options.primitives,
                   "Planes, cylinders, cones, spheres and tori of a part tell heights and creases");
  command
      .add_option("--domain", domain,
                  "Enrich there only: an expression as for --set, such as \"ball(10,5,2, 8)\" or \"FACE_3\"")
      ->type_name("EXPRESSION");
}

namespace {

void add_size_limit_flags(CLI::App& command, SizeLimits& limits) {
  add_repeated(
      command, "--size-box", 7, "X Y Z X Y Z L", "Edges of at most L in this box; may be given several times",
      [&limits](const double* v) {
        limits.boxes.push_back({.box = {.low = {v[0], v[1], v[2]}, .high = {v[3], v[4], v[5]}}, .length = v[6]});
      });
  add_repeated(command, "--size-ball", 5, "X Y Z R L", "Edges of at most L in this ball; may be given several times",
               [&limits](const double* v) {
                 limits.balls.push_back({.ball = {.centre = {v[0], v[1], v[2]}, .radius = v[3]}, .length = v[4]});
               });
  command
      .add_option_function<int>(
          "--elements-across", [&limits](int elements) { limits.elements_across = elements; },
          "Edges short enough for so many elements across every wall, 1 to 10")
      ->check(CLI::Range(1, 10))
      ->type_name("N");
}

}  // namespace

void add_simplify_flags(CLI::App& command, SimplifyOptions& options) {
  CLI::Option* method =
      add_choice<SimplifyMethod>(command, "--method", options.method,
                                 {{"lattice", SimplifyMethod::lattice}, {"collapse", SimplifyMethod::collapse}},
                                 "How to simplify; lattice is the default");
  Choices<std::optional<StarObjective>> objectives;
  for (const auto& [name, objective] :
       named({StarObjective::entropy_weighted, StarObjective::shannon, StarObjective::a_entropy,
              StarObjective::regularised_a_entropy, StarObjective::mean_edge_ratio}))
    objectives.emplace_back(name, objective);
  objectives.emplace_back("midpoint", std::nullopt);
  CLI::Option* objective = add_choice(command, "--objective", options.collapse.objective, objectives,
                                      "Where collapse puts the kept vertex: by a star objective, or the midpoint");
  CLI::Option* cost =
      add_choice(command, "--cost", options.collapse.cost,
                 named({CollapseCost::bending_energy, CollapseCost::quadric_error, CollapseCost::edge_length}),
                 "Which edge collapse contracts next");
  for (CLI::Option* needs_collapse : {objective, cost})
    needs_collapse->each([&options, method, needs_collapse](const std::string&) {
      if (method->count() > 0 && options.method != SimplifyMethod::collapse)
        throw CLI::ValidationError("belongs to --method collapse");
      options.method = SimplifyMethod::collapse;
    });
  add_choice<Sizing>(command, "--sizing", options.sizing,
                     {{"uniform", Sizing::uniform}, {"curvature", Sizing::curvature}, {"error", Sizing::error}},
                     "Where triangles are small; curvature is the default");
  command.add_option("--gradation", options.gradation, "How fast edge lengths may change, 0.02 to 1")
      ->capture_default_str()
      ->check(CLI::Range(0.02, 1.0))
      ->type_name("G");
  add_size_limit_flags(command, options.limits);
  add_feature_angle_flag(command, options.features);
}

void add_feature_angle_flag(CLI::App& command, FeatureOptions& features) {
  command
      .add_option_function<std::string>(
          "--feature-angle",
          [&features](const std::string& text) {
            if (text == "off") {
              features.angle_deg.reset();
              return;
            }
            char* end = nullptr;
            const double angle = std::strtod(text.c_str(), &end);
            if (text.empty() || *end != '\0' || !(angle > 0 && angle < 180))
              throw CLI::ValidationError("--feature-angle", "'" + text + "' is neither off nor degrees, 0 to 180");
            features.angle_deg = angle;
            features.continuation_angle_deg = std::min(features.continuation_angle_deg, angle);
          },
          "Creases whose faces' normals differ by more are kept, degrees (40); off: none")
      ->type_name("DEG|off");
}

void add_feature_file_flags(CLI::App& command, FeatureFileFlags& flags) {
  command.add_option("--features", flags.write, "Write the scan's edges that were to be kept, as lines in OBJ")
      ->type_name("FILE.obj");
  command
      .add_option("--features-from", flags.read,
                  "Keep the scan's edges along the lines of this OBJ, instead of those that --feature-angle would find")
      ->excludes("--feature-angle")
      ->type_name("FILE.obj");
}

void add_set_flag(CLI::App& command, std::vector<std::string>& sets) {
  command
      .add_option("--set", sets,
                  "A part of the surface gets a name: NAME=EXPRESSION, as fixed=plane(z<0.5mm), "
                  "load=cylinder(z, r=5+-0.2), tip=box(0,0,0, 1,1,1) and not FACE_3 (repeatable; scan2fea faces lists)")
      ->type_name("NAME=EXPRESSION")
      ->allow_extra_args(false);
}

void add_face_flags(CLI::App& command, bool& name_faces, std::optional<Idealise>& idealise) {
  command.add_flag("--name-faces", name_faces, "Each face of the scan is a set: FACE_1, ... (see scan2fea faces)");
  add_choice<std::optional<Idealise>>(
      command, "--idealise", idealise, {{"off", std::nullopt}, {"plane", Idealise::plane}, {"all", Idealise::all}},
      "Put the scan's vertices onto the planes, or onto all shapes, that its faces have within the noise; off by "
      "default");
}

void add_symmetry_flag(CLI::App& command, std::optional<SymmetryOptions>& symmetry) {
  add_choice<std::optional<SymmetryOptions>>(
      command, "--symmetry", symmetry,
      {{"off", std::nullopt}, {"auto", SymmetryOptions{}}, {"x", {{0}}}, {"y", {{1}}}, {"z", {{2}}}},
      "Mesh one half of a part and mirror it: across the plane that is found, or one across this axis; off by default");
}

void add_effort_flag(CLI::App& command, PipelineOptions& options) {
  const Choices<Effort> efforts{{"low", Effort::low}, {"normal", Effort::normal}, {"high", Effort::high}};
  command
      .add_option_function<Effort>(
          "--effort",
          [&options](Effort effort) {
            if (options.simplify) options.simplify->effort = effort;
            if (options.tetrahedralize) options.tetrahedralize->optimise = optimise_options(effort);
          },
          "Time spent on shape and fidelity; normal is the default (low, normal, high)")
      ->transform(CLI::CheckedTransformer(efforts))
      ->type_name("NAME");
}

void add_tetrahedralize_flags(CLI::App& command, TetrahedralizeOptions& options, int& order) {
  command.add_option("--order", order, "1: 4-node tetrahedra, 2: 10-node")
      ->capture_default_str()
      ->check(CLI::IsMember({1, 2}))
      ->type_name("1|2");
  command
      .add_option_function<std::string>(
          "--interior-size",
          [&options](const std::string& text) {
            const RelativeLength length = parse_length("--interior-size", text, 'x');
            options.interior_size = {
                .value = length.value,
                .unit = length.relative ? InteriorSize::Unit::of_surface : InteriorSize::Unit::model};
          },
          "Edge length inside, model units or times the surface's (1.6x, the default)")
      ->type_name("L");
  command.add_option("--max-volume", options.max_volume, "Largest tetrahedron, model units cubed")
      ->check(positive)
      ->type_name("V");
  command.add_option("--grading", options.grading, "TetGen's radius-edge bound, 1.1 to 2")
      ->capture_default_str()
      ->check(CLI::Range(1.1, 2.0))
      ->type_name("Q");
}

void add_contact_flag(CLI::App& command, std::optional<double>& tolerance) {
  command
      .add_option(
          "--contact", tolerance,
          "Gaps and overlaps of bodies up to this are closed, model units; by default what two tessellations of "
          "one surface may be apart")
      ->check(positive)
      ->type_name("TOL");
}

}  // namespace scan2fea::command
