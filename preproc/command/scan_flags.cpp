// The flags of the stages before simplification.
#include "preproc/command/choice_flag.hpp"
#include "preproc/command/flags.hpp"
#include "preproc/command/repeated_flag.hpp"
#include "preproc/surface/thinning/read_thinned_scan.hpp"

#include <algorithm>

namespace scan2fea::command {
namespace {

const Choices<ThickenTo> thicken_sides{
    {"both", ThickenTo::both}, {"front", ThickenTo::front}, {"back", ThickenTo::back}};

// A whole number counts bodies; a length has a point or an exponent.
KeptBodies parse_bodies(const std::string& text) {
  if (text == "all") return AllBodies{};
  if (text == "largest") return LargestBodies{};
  if (!text.empty() && text.find_first_not_of("0123456789") == std::string::npos && text.size() < 10 &&
      std::stoul(text) > 0)
    return LargestBodies{std::stoul(text)};
  const std::optional<double> length = number_in(text);
  if (text.find_first_of(".e") == std::string::npos || !length || *length <= 0)
    throw CLI::ValidationError("--keep",
                               "'" + text + "' is none of largest, all, a number of bodies (2), a length (2.0)");
  return BodiesAbove{*length};
}

}  // namespace

void add_reconstruct_flags(CLI::App& command, ReconstructOptions& options) {
  const OptionGroup group(command, clouds_group);
  add_choice<ReconstructionMethod>(
      command, "--reconstruction", options.method,
      named({ReconstructionMethod::automatic, ReconstructionMethod::advancing_front, ReconstructionMethod::poisson}),
      "How a cloud becomes a surface: through its points, or smooth and near them");
  command.add_option("--largest-cloud", options.largest_cloud, "Thin a cloud to at most so many points")
      ->default_str("100000, or twice --faces")
      ->transform(whole_between(1000, 100'000'000, "100000"))
      ->type_name("N");
  add_repeated(command, "--scanner", 3, "X Y Z", "Where the scanner stood, whatever the cloud tells",
               [&options](const double* v) { options.scanners.emplace_back(v[0], v[1], v[2]); })
      ->delimiter(',');
}

void add_thinning_flag(CLI::App& command, std::optional<std::size_t>& largest_scan) {
  largest_scan = ThinningLimit{}.largest;
  const OptionGroup group(command, "Files");
  command
      .add_option(
          "--largest-scan", largest_scan,
          "Thin a scan of more triangles to a quarter of so many while it is read, or four times what is asked for")
      ->transform(whole_between(1000, 1'000'000'000, "8000000"))
      ->type_name("N");
}

void add_repair_flags(CLI::App& command, RepairOptions& options) {
  const OptionGroup group(command, "Repair");
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
            if (!length.relative || length.value > 1)
              throw CLI::ValidationError("--largest-hole", "'" + text + "' is no share of the size, as 35% is; try: " +
                                                               (length.value <= 100 ? text + "%, or all" : "all"));
            options.largest_hole_of_diagonal = length.value;
          },
          "Close holes up to this size, % of their component's diagonal, or all")
      ->default_str("35%")
      ->type_name("P%|all");
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
      ->type_name("T[:SIDE]");
  command
      .add_option_function<std::string>(
          "--keep", [&options](const std::string& text) { options.bodies = parse_bodies(text); },
          "Bodies that stay: the largest, all, the N largest, or those above a length in model units (5.0); by default "
          "all but what is small beside the largest: a tenth of its size and a thousandth of its volume")
      ->type_name("largest|all|N|L");
}

void add_enrich_flags(CLI::App& command, EnrichOptions& options, std::string& domain) {
  const OptionGroup group(command, enrichment_group);
  command
      .add_option_function<std::string>(
          "--scheme",
          [&options](const std::string& name) {
            if (name != "sound" && name != "literal") refuse_choice("--scheme", name, {"sound", "literal"});
            if (name == "literal") options = EnrichOptions::literal();
          },
          "literal: section 2 of the paper as it is written, for comparison")
      ->default_str("sound")
      ->type_name("sound|literal");
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
      ->check(positive("the spacing of the points"))
      ->type_name("R");
  add_choice<Lifting>(command, "--lifting", options.lifting,
                      named({Lifting::triharmonic, Lifting::moving_least_squares, Lifting::modified_quadratic_shepard,
                             Lifting::hermite, Lifting::shepard}),
                      "How new points find their height where no primitive tells it");
  command
      .add_flag("--primitives,!--no-primitives", options.primitives,
                "Planes, cylinders, cones, spheres and tori of a part tell heights and creases, or do not")
      ->default_str("--primitives");
  command
      .add_option("--domain", domain,
                  "Enrich there only: an expression as for --set, such as \"ball(10,5,2, 8)\" or \"FACE_3\"")
      ->type_name("EXPRESSION");
}

}  // namespace scan2fea::command
