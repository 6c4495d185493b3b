#include "preproc/command/flags.hpp"

#include "preproc/command/choice_flag.hpp"
#include "preproc/command/gate_flags.hpp"
#include "preproc/command/option_text.hpp"
#include "preproc/command/print_configuration.hpp"
#include "preproc/command/repeated_flag.hpp"
#include "preproc/mesh/error_text.hpp"
#include "preproc/mesh/length_unit.hpp"

#include <algorithm>
#include <cmath>
#include <sstream>
#include <utility>

namespace scan2fea::command {
namespace {

void require_length(const char* flag, double length) {
  if (!std::isfinite(length) || length <= 0)
    throw CLI::ValidationError(flag, "'" + error_text(length) + "' is no length above 0");
}

// "wall=5:0.1:1.3": the set's name may hold what a name may, so that the last = counts.
LayerOptions parse_layers(const std::string& flag, const std::string& text) {
  constexpr double most_layers = 50, most_growth = 3;
  LayerOptions layers;
  const std::size_t equal = text.rfind('=');
  if (equal != std::string::npos) layers.set = text.substr(0, equal);
  std::vector<std::optional<double>> numbers;
  std::istringstream parts(equal == std::string::npos ? text : text.substr(equal + 1));
  for (std::string part; std::getline(parts, part, ':');) numbers.push_back(number_in(part));
  const bool are_there = numbers.size() == 3 && text.back() != ':' &&
                         std::ranges::all_of(numbers, [](const auto& n) { return n.has_value(); });
  if (!are_there || equal == 0)
    throw CLI::ValidationError(flag, "'" + text + "' is not SET=N:FIRST:GROWTH or N:FIRST:GROWTH; try: wall=5:0.1:1.3");
  const double count = *numbers[0], first = *numbers[1], growth = *numbers[2];
  if (count < 1 || count > most_layers || count != std::floor(count))
    throw CLI::ValidationError(
        flag, "'" + text + "' asks for " + error_text(count) + " layers (limit: a whole number from 1 to 50); try: 5");
  if (first <= 0)
    throw CLI::ValidationError(
        flag, "'" + text + "': a first layer of " + error_text(first) + " (limit: a height above 0, model units)");
  if (growth < 1 || growth > most_growth)
    throw CLI::ValidationError(flag,
                               "'" + text + "': a growth of " + error_text(growth) + " (limit: 1 to 3); try: 1.3");
  layers.heights = {.count = static_cast<int>(count), .first = first, .growth = growth};
  return layers;
}

// From half of the diagonal on one point in the middle is near enough to all others.
RelativeLength deviation_in(const std::string& text) {
  constexpr double most_of_diagonal = 0.5;
  const RelativeLength deviation = parse_length("--deviation", text, '%');
  if (deviation.relative && deviation.value >= most_of_diagonal)
    throw CLI::ValidationError("--deviation", "'" + text +
                                                  "' of the diagonal: a single point is as near to the scan (limit: "
                                                  "50%); try: 0.2%, or --faces");
  return deviation;
}

}  // namespace

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
  const OptionGroup group(command, "Files");
  const auto short_name = [](std::string& text) {
    const std::optional<std::string> known = length_unit(text);
    if (known) text = *known;
    return known ? std::string() : "'" + text + "' is none of " + std::string(known_length_units);
  };
  command.add_option("--unit", unit, "Length unit of the input, recorded in what is written")
      ->transform(CLI::Validator(short_name, ""))
      ->type_name("UNIT");
}

void add_common_flags(CLI::App& command, CommonFlags& flags) {
  command.add_option("input", flags.input, "What to read")->required()->type_name("FILE");
  {
    const OptionGroup group(command, "Files");
    add_from_flag(command, flags.formats.from);
    add_unit_flag(command, flags.unit);
    add_force_flag(command, flags.force);
    command.add_option("--config", flags.config, "Options from a TOML file, under the flags' names")
        ->type_name("FILE.toml");
  }
  add_figure_flags(command, flags);
  const OptionGroup group(command, "Running");
  command.add_option("--threads", flags.threads, "Number of threads. The result does not depend on it")
      ->transform(whole_between(0, 1024, "0 for all"))
      ->default_str("all")
      ->type_name("N");
  add_display_flags(command, flags);
  add_print_configuration_flag(command);
}

void add_figure_flags(CLI::App& command, CommonFlags& flags) {
  const OptionGroup group(command, "Figures, gates and reports");
  command.add_option("--json", flags.json, "Write all figures as JSON (- for stdout)")->type_name("FILE");
  command.add_option("--report", flags.report, "Write report.html and report.json into this folder")
      ->check(CLI::Validator(
          [](std::string& folder) {
            return folder.empty() || folder == "-" ? "'" + folder + "' is no folder; try: report" : std::string();
          },
          ""))
      ->type_name("DIR");
  command.add_flag("--report-pdf", flags.report_pdf, "Print the report as report.pdf, too, by Chromium")
      ->needs("--report");
  add_gate_flags(command, flags);
  command.add_option("--seed", flags.seed, "Of the random points by which distances are measured")
      ->transform(whole_between(0, std::pow(2.0, 64) - 1, "1"))
      ->capture_default_str()
      ->type_name("N");
}

void add_display_flags(CLI::App& command, DisplayFlags& flags) {
  const OptionGroup group(command, "Running");
  command.add_flag("--quiet", flags.quiet, "No messages but errors");
  command.add_flag("--verbose", flags.verbose, "Also all figures of each stage, and why it came out as it did");
  add_choice<ProgressMode>(command, "--progress", flags.progress,
                           {{"auto", ProgressMode::automatic},
                            {"off", ProgressMode::off},
                            {"bar", ProgressMode::bar},
                            {"json", ProgressMode::json}},
                           "How far it is: a bar if stderr is a terminal, none, a bar, or stderr in lines of JSON");
}

void add_output_flag(CLI::App& command, std::filesystem::path& output) {
  const OptionGroup group(command, "Files");
  command
      .add_option("-o,--output", output, "What to write; its extension tells the format, or --to of -, which is stdout")
      ->required()
      ->type_name("FILE");
}

void add_time_limit_flag(CLI::App& command, std::optional<double>& seconds) {
  const OptionGroup group(command, "Running");
  command
      .add_option("--time-limit", seconds,
                  "Of the whole command, seconds: the best mesh that there is by then, or exit code 4")
      ->check(positive("seconds"))
      ->type_name("S");
}

void add_force_flag(CLI::App& command, bool& force) {
  const OptionGroup group(command, "Files");
  command.add_flag("--force", force, "Overwrite outputs that exist, reports too");
}

void add_size_flags(CLI::App& command, SizeFlags& flags) {
  const OptionGroup group(command, "How many triangles, at most one of");
  CLI::Option* faces = command.add_option("--faces", flags.faces, "Wanted number of surface triangles")
                           ->transform(whole_between(4, std::size_t{1} << 31, "some thousands"))
                           ->type_name("N");
  CLI::Option* ratio = command.add_option("--ratio", flags.ratio, "Wanted triangles over those of the input")
                           ->check(positive("0.1"))
                           ->type_name("R");
  CLI::Option* edge_length = command.add_option("--edge-length", flags.edge_length, "Wanted mean edge, model units")
                                 ->check(positive("a hundredth of the part's size"))
                                 ->type_name("L");
  CLI::Option* deviation =
      command
          .add_option_function<std::string>(
              "--deviation", [&flags](const std::string& text) { flags.deviation = deviation_in(text); },
              "Largest distance to the scan, model units or % of the bounding box's diagonal. The default is aimed at; "
              "what is given holds for all points, or is an error")
          ->default_str("0.2%")
          ->type_name("D");
  const std::vector<CLI::Option*> sizes{faces, ratio, edge_length, deviation};
  for (CLI::Option* one : sizes)
    for (CLI::Option* other : sizes)
      if (one != other) one->excludes(other);
}

namespace {

void add_size_limit_flags(CLI::App& command, SizeLimits& limits) {
  const OptionGroup group(command, "Where triangles are small");
  add_repeated(
      command, "--size-box", 7, "X Y Z X Y Z L", "Edges of at most L in this box, between two corners",
      [&limits](const double* v) {
        require_length("--size-box", v[6]);
        limits.boxes.push_back({.box = {.low = {v[0], v[1], v[2]}, .high = {v[3], v[4], v[5]}}, .length = v[6]});
      });
  add_repeated(command, "--size-ball", 5, "X Y Z R L", "Edges of at most L in this ball", [&limits](const double* v) {
    require_length("--size-ball", v[3]);
    require_length("--size-ball", v[4]);
    limits.balls.push_back({.ball = {.centre = {v[0], v[1], v[2]}, .radius = v[3]}, .length = v[4]});
  });
  command
      .add_option_function<int>(
          "--elements-across", [&limits](int elements) { limits.elements_across = elements; },
          "Edges short enough for so many elements across every wall, 1 to 10")
      ->transform(whole_between(1, 10, "2"))
      ->type_name("N");
}

}  // namespace

void add_simplify_flags(CLI::App& command, SimplifyOptions& options) {
  add_method_flags(command, options);
  add_size_limit_flags(command, options.limits);
  add_feature_angle_flag(command, options.features);
  const OptionGroup group(command, "Where triangles are small");
  add_choice<Sizing>(command, "--sizing", options.sizing,
                     {{"uniform", Sizing::uniform}, {"curvature", Sizing::curvature}, {"error", Sizing::error}},
                     "Where triangles are small: nowhere, where the surface is curved, or where a first result is far "
                     "from the scan");
  command.add_option("--gradation", options.gradation, "How fast edge lengths may change, 0.02 to 1")
      ->capture_default_str()
      ->check(between(0.02, 1, "0.12"))
      ->type_name("G");
}

void add_method_flags(CLI::App& command, SimplifyOptions& options) {
  const OptionGroup group(command, "How triangles are made");
  CLI::Option* method =
      add_choice<SimplifyMethod>(command, "--method", options.method,
                                 {{"lattice", SimplifyMethod::lattice}, {"collapse", SimplifyMethod::collapse}},
                                 "How to simplify: by a lattice of triangles, or as the paper does");
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
}

void add_feature_angle_flag(CLI::App& command, FeatureOptions& features) {
  const OptionGroup group(command, "How triangles are made");
  command
      .add_option_function<std::string>(
          "--feature-angle",
          [&features](const std::string& text) {
            if (text == "off") {
              features.angle_deg.reset();
              return;
            }
            const std::optional<double> angle = number_in(text);
            if (!angle || *angle <= 0 || *angle >= 180)
              throw CLI::ValidationError("--feature-angle",
                                         "'" + text + "' is neither off nor degrees above 0 and below 180");
            features.angle_deg = *angle;
            features.continuation_angle_deg = std::min(features.continuation_angle_deg, *angle);
          },
          "Creases whose faces' normals differ by more are kept, degrees; off: none")
      ->default_str("40")
      ->type_name("DEG|off");
}

void add_feature_file_flags(CLI::App& command, FeatureFileFlags& flags) {
  const OptionGroup group(command, "How triangles are made");
  command.add_option("--features", flags.write, "Write the scan's edges that were to be kept, as lines in OBJ")
      ->type_name("FILE.obj");
  command
      .add_option("--features-from", flags.read,
                  "Keep the scan's edges along the lines of this OBJ, instead of those that --feature-angle would find")
      ->excludes("--feature-angle")
      ->type_name("FILE.obj");
}

void add_set_flag(CLI::App& command, std::vector<std::string>& sets) {
  const OptionGroup group(command, "Named faces and symmetry");
  command
      .add_option("--set", sets,
                  "A part of the surface gets a name: NAME=EXPRESSION, as fixed=plane(z<0.5mm), "
                  "load=cylinder(z, r=5+-0.2), tip=box(0,0,0, 1,1,1) and not FACE_3; scan2fea faces lists them")
      ->type_name("NAME=EXPRESSION")
      ->allow_extra_args(false);
}

void add_face_flags(CLI::App& command, bool& name_faces, std::optional<Idealise>& idealise) {
  const OptionGroup group(command, "Named faces and symmetry");
  command.add_flag("--name-faces", name_faces, "Each face of the scan is a set: FACE_1, ... (see scan2fea faces)");
  add_choice<std::optional<Idealise>>(
      command, "--idealise", idealise, {{"off", std::nullopt}, {"plane", Idealise::plane}, {"all", Idealise::all}},
      "Put the scan's vertices onto the planes, or onto all shapes, that its faces have within the noise");
}

void add_symmetry_flag(CLI::App& command, std::optional<SymmetryOptions>& symmetry) {
  const OptionGroup group(command, "Named faces and symmetry");
  add_choice<std::optional<SymmetryOptions>>(
      command, "--symmetry", symmetry,
      {{"off", std::nullopt}, {"auto", SymmetryOptions{}}, {"x", {{0}}}, {"y", {{1}}}, {"z", {{2}}}},
      "Mesh one half of a part and mirror it: across the plane that is found, or one across this axis");
}

void add_effort_flag(CLI::App& command, PipelineOptions& options) {
  const OptionGroup group(command, "How triangles are made");
  const Choices<Effort> efforts{{"low", Effort::low}, {"normal", Effort::normal}, {"high", Effort::high}};
  command
      .add_option_function<std::string>(
          "--effort",
          [&options, efforts](const std::string& name) {
            const Effort effort = chosen("--effort", name, efforts);
            if (options.simplify) options.simplify->effort = effort;
            if (options.tetrahedralize) options.tetrahedralize->optimise = optimise_options(effort);
          },
          "Time spent on shape and fidelity")
      ->default_str("normal")
      ->type_name(list_of(efforts, "|"));
}

void add_tetrahedralize_flags(CLI::App& command, TetrahedralizeOptions& options, int& order) {
  const OptionGroup group(command, "Tetrahedra");
  add_choice<int>(command, "--order", order, {{"1", 1}, {"2", 2}}, "1: 4-node tetrahedra, 2: 10-node");
  command
      .add_option_function<std::string>(
          "--interior-size",
          [&options](const std::string& text) {
            const RelativeLength length = parse_length("--interior-size", text, 'x');
            options.interior_size = {
                .value = length.value,
                .unit = length.relative ? InteriorSize::Unit::of_surface : InteriorSize::Unit::model};
          },
          "Edge length inside, model units or times the surface's")
      ->default_str("1.6x")
      ->type_name("L");
  command.add_option("--max-volume", options.max_volume, "Largest tetrahedron, model units cubed")
      ->check(positive("the cube of an edge's length, over 8"))
      ->type_name("V");
  command.add_option("--grading", options.grading, "TetGen's radius-edge bound, 1.1 to 2")
      ->capture_default_str()
      ->check(between(1.1, 2, "1.2"))
      ->type_name("Q");
}

void add_slide_flag(CLI::App& command, std::optional<SlideOptions>& slide) {
  const OptionGroup group(command, "Tetrahedra");
  command
      .add_option_function<std::string>(
          "--slide",
          [&slide](const std::string& text) {
            const RelativeLength most = parse_length("--slide", text, '%');
            slide = {.distance = most.value,
                     .unit = most.relative ? LargestDeviation::Unit::of_diagonal : LargestDeviation::Unit::model};
          },
          "Nodes of the surface go along the scan, this far at the most, where that makes better tetrahedra")
      ->type_name("D|P%");
}

void add_layers_flag(CLI::App& command, std::vector<LayerOptions>& layers) {
  const OptionGroup group(command, "Tetrahedra");
  command
      .add_option_function<std::vector<std::string>>(
          "--layers",
          [&layers](const std::vector<std::string>& texts) {
            layers.clear();
            for (const std::string& text : texts) layers.push_back(parse_layers("--layers", text));
          },
          "Layers of flat elements behind a set, or behind all of the surface: their number, the height of the first, "
          "model units, and how many times as high each next one is")
      ->type_name("[SET=]N:FIRST:GROWTH")
      ->allow_extra_args(false);
}

void add_contact_flag(CLI::App& command, std::optional<double>& tolerance) {
  const OptionGroup group(command, bodies_group);
  command
      .add_option(
          "--contact", tolerance,
          "Gaps and overlaps of bodies up to this are closed, model units; by default what two tessellations of "
          "one surface may be apart")
      ->check(positive("the width of the gap"))
      ->type_name("TOL");
}

}  // namespace scan2fea::command
