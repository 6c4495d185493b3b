#include "quality/figure_path.hpp"

#include "quality/figure_names.hpp"
#include "quality/report_schema.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <set>

namespace scan2fea {
namespace {

using testing::HasSubstr;

Json report() {
  return Json::parse(R"({
    "surface": {"closed": true, "genus": null, "area": 6, "edge_ratio": {"mean": 1.5}},
    "deviation": {"hausdorff_pct_diagonal": 0.2, "rms_pct_diagonal": 0.1, "farthest_point": [1, 2, 3]},
    "faces": [{"name": "FACE_1", "kind": "plane", "area": 4, "place": [0, 0, 1], "normal": [0, 0, 1]},
              {"name": "FACE_2", "kind": "cylinder", "area": 2, "radius": 3, "hollow": true, "place": [5, 0, 0]}],
    "bodies": [{"name": "pin.v2", "volume": 7}, {"name": "pin", "volume": 9}],
    "contacts": [{"bodies": ["pin", "plate"], "set": "INTERFACE_pin_plate", "largest_gap": 0.01, "place": [1, 1, 1]}],
    "lost": [],
    "made_up": [{"what": "closed hole", "place": [1, 0, 0], "size": 2, "area": 3},
                {"what": "bridge", "place": [2, 0, 0], "size": 5}],
    "size": {"box": [1, 2, 3], "diagonal": 4},
    "histograms": [{"measure": "edge_ratio", "of": "triangles", "low": 1, "high": 2, "counts": [5, 6, 7]}],
    "worst_elements": {"by": "min_angle_deg", "elements": [{"element": 17, "place": [9, 9, 9], "min_angle_deg": 12}]},
    "compared": {"first": {"surface": {"area": 5}}}
  })");
}

std::optional<double> value(const std::string& name) {
  const Json figures = report();
  const auto found = find_figure_path(name, &figures);
  EXPECT_TRUE(found) << name;
  return found ? found->value : std::nullopt;
}

TEST(FigurePath, KeysEntriesNumbersAndAxes) {
  EXPECT_EQ(value("surface.edge_ratio.mean"), 1.5);
  EXPECT_EQ(value("surface.closed"), 1);
  EXPECT_EQ(value("faces.FACE_2.radius"), 3);
  EXPECT_EQ(value("faces.1.area"), 2);
  EXPECT_EQ(value("faces.FACE_2.hollow"), 1);
  EXPECT_EQ(value("faces.FACE_1.normal.z"), 1);
  EXPECT_EQ(value("contacts.INTERFACE_pin_plate.largest_gap"), 0.01);
  EXPECT_EQ(value("size.box.y"), 2);
  EXPECT_EQ(value("histograms.edge_ratio.counts.2"), 7);
  EXPECT_EQ(value("histograms.edge_ratio.counts.sum"), 18);
  EXPECT_EQ(value("worst_elements.elements.0.min_angle_deg"), 12);
  EXPECT_EQ(value("compared.first.surface.area"), 5);
}

TEST(FigurePath, NamesMayHoldPoints) {
  EXPECT_EQ(value("bodies.pin.v2.volume"), 7);
  EXPECT_EQ(value("bodies.pin.volume"), 9);
}

TEST(FigurePath, OfAllEntries) {
  EXPECT_EQ(value("faces.count"), 2);
  EXPECT_EQ(value("faces.area.sum"), 6);
  EXPECT_EQ(value("faces.area.min"), 2);
  EXPECT_EQ(value("faces.area.mean"), 3);
  EXPECT_EQ(value("faces.radius.max"), 3) << "of those that have one";
  EXPECT_EQ(value("made_up.area.sum"), 3);
  EXPECT_EQ(value("lost.count"), 0);
  EXPECT_EQ(value("lost.area.sum"), 0);
  EXPECT_EQ(value("lost.size.max"), 0);
  EXPECT_EQ(value("lost.size.min"), std::nullopt);
  EXPECT_EQ(value("lost.size.mean"), std::nullopt);
}

TEST(FigurePath, PlacesAreThoseOfTheEntryOrOfTheReport) {
  const Json figures = report();
  EXPECT_EQ(find_figure_path("deviation.hausdorff_pct_diagonal", &figures)->place, Json({1, 2, 3}));
  EXPECT_FALSE(find_figure_path("deviation.rms_pct_diagonal", &figures)->place);
  EXPECT_EQ(find_figure_path("faces.FACE_2.area", &figures)->place, Json({5, 0, 0}));
  EXPECT_EQ(find_figure_path("faces.area.max", &figures)->place, Json({0, 0, 1}));
  EXPECT_EQ(find_figure_path("made_up.size.max", &figures)->place, Json({2, 0, 0}));
  EXPECT_FALSE(find_figure_path("faces.area.sum", &figures)->place) << "a sum is nowhere";
  const auto worst = find_figure_path("worst_elements.elements.0.min_angle_deg", &figures);
  EXPECT_EQ(worst->element, 17U);
  EXPECT_EQ(worst->place, Json({9, 9, 9}));
}

TEST(FigurePath, WhatHasNoValueSaysWhy) {
  const Json figures = report();
  for (const char* name : {"surface.genus", "surface.edge_ratio.max", "faces.FACE_9.area", "faces.7.area",
                           "faces.FACE_1.radius", "stages.renewal.seconds", "volume_mesh.order"}) {
    const auto found = find_figure_path(name, &figures);
    ASSERT_TRUE(found) << name;
    EXPECT_FALSE(found->value) << name;
    EXPECT_NE(found->missing, "") << name;
  }
  EXPECT_EQ(find_figure_path("faces.FACE_9.area", &figures)->missing, "there is no FACE_9; there are FACE_1, FACE_2");
}

TEST(FigurePath, WhatIsNoFigureIsNotFound) {
  for (const char* name : {"",
                           ".",
                           "surface",
                           "surface.",
                           "surface.edge_ratio",
                           "surface.edge_ratio.",
                           "faces",
                           "faces.FACE_1",
                           "faces.FACE_1.kind",
                           "faces.FACE_1.normal",
                           "faces.FACE_1.normal.w",
                           "faces.area",
                           "faces.kind.max",
                           "unit",
                           "size.box",
                           "gates.count",
                           "stages.paint.seconds",
                           "stages.repair.colour",
                           "lost.sum",
                           "surface.area.max",
                           "deviation.farthest_point"})
    EXPECT_FALSE(find_figure_path(name)) << name;
}

// The list is made of the same schema, but by another walk.
TEST(FigureNames, EachIsAFigureByItsName) {
  std::set<std::string> names;
  for (const NamedFigure& figure : all_figures()) {
    EXPECT_TRUE(names.insert(figure.name).second) << figure.name << " twice";
    if (figure.section == "compared") continue;
    std::string name = figure.name;  // an entry's name, and its number
    for (std::size_t at = name.find(".N."); at != std::string::npos; at = name.find(".N.")) name.replace(at, 3, ".0.");
    if (name.ends_with(".N")) name.replace(name.size() - 1, 1, "0");
    EXPECT_TRUE(find_figure_path(name)) << name;
  }
  EXPECT_TRUE(names.contains("stages.repair.lost_volume"));
  EXPECT_TRUE(names.contains("faces.NAME.area"));
  EXPECT_TRUE(names.contains("worst_elements.elements.N.scaled_jacobian"));
}

TEST(FigureNames, EachHasAMeaningAndAKnownUnit) {
  const std::set<std::string> units{"",       "degrees", "%",    "% of the diagonal", "length", "area",
                                    "volume", "seconds", "bytes"};
  for (const NamedFigure& figure : all_figures()) {
    EXPECT_NE(figure.meaning, "") << figure.name;
    EXPECT_TRUE(units.contains(figure.unit)) << figure.name << ": " << figure.unit;
    EXPECT_EQ(figure.name.find("_deg") != std::string::npos, figure.unit == "degrees") << figure.name;
    if (figure.name.ends_with("_pct")) {
      EXPECT_EQ(figure.unit, "%") << figure.name;
    }
  }
}

TEST(FigureNames, TheNearestAreSuggestedWithTheEntriesThatWereNamed) {
  EXPECT_THAT(nearest_figures("faces.FACE_3.aera"), HasSubstr("faces.FACE_3.area"));
  EXPECT_THAT(nearest_figures("stages.repair.lost_volum"), HasSubstr("stages.repair.lost_volume"));
  EXPECT_THAT(nearest_figures("hausdorf_pct_diagonal"), HasSubstr("deviation.hausdorff_pct_diagonal"));
}

}  // namespace
}  // namespace scan2fea
