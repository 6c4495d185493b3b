// The page's units, and the page as a text; tests/report_in_browser.py uses it as a reader does.
#include "quality/report_page/report_page.hpp"

#include "quality/picture/colour_maps.hpp"
#include "quality/picture/deflate.hpp"
#include "quality/picture/picture.hpp"
#include "quality/report_page/html.hpp"
#include "quality/report_page/packed_arrays.hpp"
#include "quality/report_page/page_sections.hpp"
#include "quality/report_page/thinned_view.hpp"
#include "tests/analytic_meshes.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <zlib.h>

namespace scan2fea {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

std::string expanded(const std::string& bytes, std::size_t room) {
  std::string text(room, '\0');
  uLongf size = room;
  EXPECT_EQ(uncompress(reinterpret_cast<Bytef*>(text.data()), &size, reinterpret_cast<const Bytef*>(bytes.data()),
                       bytes.size()),
            Z_OK);
  text.resize(size);
  return text;
}

TEST(Deflate, Base64IsThatOfTheStandard) {  // RFC 4648, section 10
  EXPECT_EQ(base64(""), "");
  EXPECT_EQ(base64("f"), "Zg==");
  EXPECT_EQ(base64("fo"), "Zm8=");
  EXPECT_EQ(base64("foo"), "Zm9v");
  EXPECT_EQ(base64("foob"), "Zm9vYg==");
  EXPECT_EQ(base64("\xff\xfe\xfd"), "//79");
}

TEST(Deflate, ZlibExpandsIt) {
  const std::string text(10000, 'x');
  EXPECT_LT(deflated(text).size(), 100U);
  EXPECT_EQ(expanded(deflated(text), 10000), text);
}

TEST(PackedArrays, IndicesAreWrittenAsDifferences) {
  PackedArrays arrays;
  std::vector<std::uint32_t> triangles;
  for (std::uint32_t t = 0; t < 3000; ++t) triangles.insert(triangles.end(), {t, t + 1, t + 2});
  arrays.add_indices("t", triangles, 3);
  EXPECT_LT(arrays.text().size(), triangles.size() / 10) << "a row of indices is nearly nothing";
  EXPECT_EQ(arrays.directory()["t"]["count"], 9000);
}

double luminance(const Rgb& c) {
  const auto linear = [](double x) { return std::pow(x / 255, 2.2); };
  return 0.2126 * linear(c[0]) + 0.7152 * linear(c[1]) + 0.0722 * linear(c[2]);
}

TEST(ColourMaps, OneGetsDarkerAllTheWayAndTheOtherToBothEnds) {
  const ColourMap &sequential = sequential_colours(), &diverging = diverging_colours();
  for (std::size_t i = 8; i < 256; i += 8) EXPECT_LT(luminance(sequential[i]), luminance(sequential[i - 8])) << i;
  for (std::size_t i = 8; i < 128; i += 8) EXPECT_GT(luminance(diverging[i]), luminance(diverging[i - 8])) << i;
  for (std::size_t i = 136; i < 256; i += 8) EXPECT_LT(luminance(diverging[i]), luminance(diverging[i - 8])) << i;
  EXPECT_GT(diverging[0][2], diverging[0][0]) << "blue where it is negative";
  EXPECT_GT(diverging[255][0], diverging[255][2]);
}

TEST(Html, WhatAUserNamesIsNoMarkup) {
  EXPECT_EQ(html::escaped("<a href=\"x\">&"), "&lt;a href=&quot;x&quot;&gt;&amp;");
}

TEST(Html, FiguresHoldTheWholeNumber) {
  const Json report{{"surface", {{"edge_ratio", {{"mean", 1.0573928347}}}}}};
  EXPECT_EQ(html::figure(report, "surface.edge_ratio.mean"),
            "<data data-figure=\"surface.edge_ratio.mean\" value=\"1.0573928347\">1.057</data>");
  EXPECT_EQ(html::figure(report, "surface.edge_ratio.max"), "");
  EXPECT_EQ(html::number(12604), "12\u2009604");
  EXPECT_EQ(html::number(-123), "-123");
  EXPECT_EQ(html::number(nullptr), "none");
}

TEST(ThinnedView, KeepsAllWhereThereAreFew) {
  const SurfaceMesh ball = analytic::sphere(1, 3);
  const ThinnedView view = thinned_view(ball, 1'000'000);
  EXPECT_FALSE(view.is_thinned);
  EXPECT_EQ(view.mesh.triangles, ball.triangles);
}

TEST(ThinnedView, KeepsToTheNumberAndNearTheSurface) {
  const SurfaceMesh ball = analytic::sphere(10, 6);  // 81,920 triangles
  const ThinnedView view = thinned_view(ball, 5000);
  EXPECT_TRUE(view.is_thinned);
  EXPECT_LE(view.mesh.triangles.size(), 5000U);
  EXPECT_GT(view.mesh.triangles.size(), 1500U) << "no coarser than need be";
  ASSERT_EQ(view.origin.size(), view.mesh.triangles.size());
  for (std::size_t f = 0; f < view.origin.size(); ++f) {
    const Vec3 shown = centroid(view.mesh, view.mesh.triangles[f]);
    EXPECT_LT((shown - centroid(ball, ball.triangles.at(view.origin[f]))).norm(), 1.0);
    EXPECT_NEAR(shown.norm(), 10, 0.2);
  }
}

// Of a PNG that draw_picture made: how many pixels are covered. Its rows hold differences to the left.
std::size_t covered_pixels(const std::string& png, std::size_t width, std::size_t height) {
  const std::size_t data = png.find("IDAT") + 4;
  const std::string rows = expanded(png.substr(data, png.find("IEND") - data - 8), (4 * width + 1) * height);
  EXPECT_EQ(rows.size(), (4 * width + 1) * height);
  std::size_t covered = 0;
  for (std::size_t y = 0; y < height; ++y) {
    unsigned char alpha = 0;
    for (std::size_t x = 0; x < width; ++x) {
      alpha = static_cast<unsigned char>(alpha + rows[(4 * width + 1) * y + 1 + 4 * x + 3]);
      covered += alpha > 127 ? 1 : 0;
    }
  }
  return covered;
}

TEST(Picture, ABallCoversADisk) {
  const SurfaceMesh ball = analytic::sphere(10, 5);
  const std::vector<Rgb> colours(ball.triangles.size(), {200, 100, 50});
  const PictureView view{.towards = {0, 1, 0}, .up = {0, 0, 1}, .centre = {0, 0, 0}, .height = 40};
  const std::string png = draw_picture(ball, colours, view, {.width = 200, .height = 160});
  EXPECT_TRUE(png.starts_with("\x89PNG\r\n\x1a\n"));
  EXPECT_NEAR(static_cast<double>(covered_pixels(png, 200, 160)), M_PI * 40 * 40, 0.02 * M_PI * 40 * 40);
}

TEST(Picture, AllOfTheModelIsInTheWholeView) {
  const SurfaceMesh box = analytic::box({40, 3, 2}, 1);
  const PictureView view = view_of_all(box, {-1, 1, -1}, {0, 0, 1});
  const Vec3 away = view.towards, right = away.cross(view.up).normalized(), up = right.cross(away);
  for (const Vec3& p : box.vertices) {
    EXPECT_LE(std::abs(up.dot(p - view.centre)), 0.5 * view.height);
    EXPECT_LE(std::abs(right.dot(p - view.centre)), 0.5 * view.height * 4 / 3);
  }
}

std::string page_of(const SurfaceMesh& mesh, const SurfaceMesh* reference, const std::string& title) {
  Report figures;
  figures.input = title;
  figures.surface = measure_surface(mesh);
  if (reference != nullptr) figures.deviation = measure_deviation(mesh, *reference, {.samples = 1000, .seed = 1});
  const Json report = to_json(figures);
  const ElementMeasures measures = measure_elements(mesh, reference);
  return report_page({.title = title,
                      .report = report,
                      .measures = measures,
                      .histograms = histograms_of(measures),
                      .volume_mesh = nullptr,
                      .reference = reference,
                      .face_sets = {},
                      .worst = {},
                      .first_element = 0,
                      .element_numbers = {}});
}

TEST(ReportPage, NeedsNothingFromOutside) {
  const SurfaceMesh ball = analytic::sphere(10, 3);
  const std::string page = page_of(ball, &ball, "ball");
  for (const char* outside : {"src=\"http", "href=\"http", "url(http", "@import", "{{"})
    EXPECT_THAT(page, Not(HasSubstr(outside)));
  EXPECT_TRUE(page.starts_with("<!doctype html>"));
}

TEST(ReportPage, NamesOfFilesAreNoMarkup) {
  const SurfaceMesh ball = analytic::sphere(10, 2);
  const std::string page = page_of(ball, nullptr, "</script><script>alert(1)</script>");
  EXPECT_THAT(page, Not(HasSubstr("<script>alert")));
}

TEST(ReportPage, IsTheSameAgain) {
  const SurfaceMesh ball = analytic::sphere(10, 3), other = analytic::sphere(10.1, 3);
  EXPECT_EQ(page_of(ball, &other, "ball"), page_of(ball, &other, "ball"));
}

TEST(ReportPage, OfAHundredThousandTrianglesIsSmall) {
  const SurfaceMesh ball = analytic::sphere(10, 6);  // 81,920, and as many of the reference
  EXPECT_LT(page_of(ball, &ball, "ball").size(), 8'000'000U);
}

TEST(ReportPage, FaultsAreNamedInTheVerdict) {
  SurfaceMesh open = analytic::sphere(10, 3);
  open.triangles.pop_back();
  Report figures;
  figures.surface = measure_surface(open);
  EXPECT_THAT(verdict_section(to_json(figures)), HasSubstr("not closed"));
}

TEST(ReportPage, OneFaultIsInTheSingular) {
  Json report = to_json(Report{.input = "m", .surface = measure_surface(analytic::sphere(10, 2))});
  report["surface"]["self_intersections"] = 1;
  EXPECT_THAT(verdict_section(report), HasSubstr("</data> pair of triangles crosses"));
  report["surface"]["self_intersections"] = 2;
  EXPECT_THAT(verdict_section(report), HasSubstr("</data> pairs of triangles cross"));
}

TEST(Html, PercentIsZeroWithinRoundingAndKnownOrNot) {
  EXPECT_EQ(html::percent(-2.63e-9), "0\u00a0%");
  EXPECT_EQ(html::percent(0.0254), "0.0254\u00a0%");
  EXPECT_EQ(html::percent(nullptr), "not known");
}

// What the mesh does not tell of, a spike of the reference, is a point of the reference.
TEST(ReportPage, TheFarthestPointIsOfTheSurfaceThatHasIt) {
  const SurfaceMesh ball = analytic::sphere(10, 3);
  SurfaceMesh spiked = ball;
  spiked.vertices[5] *= 1.3;
  const auto verdict = [](const SurfaceMesh& mesh, const SurfaceMesh& reference) {
    Report figures;
    figures.surface = measure_surface(mesh);
    figures.deviation = measure_deviation(mesh, reference, {.samples = 1000, .seed = 1});
    return verdict_section(to_json(figures));
  };
  EXPECT_THAT(verdict(ball, spiked), HasSubstr("data-show=\"farthest-of-reference\""));
  EXPECT_THAT(verdict(spiked, ball), HasSubstr("data-show=\"farthest-of-mesh\""));
  EXPECT_THAT(verdict(spiked, ball), HasSubstr("at least"));
}

TEST(ReportPage, StagesTellTheirUnits) {
  const Json report{{"unit", "mm"},
                    {"stages",
                     {{{"name", "simplify"},
                       {"seconds", 1.0},
                       {"peak_bytes", 1e6},
                       {"faces_after", 2494.0},
                       {"largest_deviation", 0.163699}}}}};
  EXPECT_THAT(stages_section(report), HasSubstr("Largest deviation at most\u00a00.1637\u00a0mm"));
  EXPECT_THAT(stages_section(report), HasSubstr("faces after\u00a02494"));
}

TEST(ReportPage, CausesAndSetsAreTold) {
  const Json element{{"cause", "beside the surface, on which 3 corners lie"}, {"sets", {"foot", "SALL"}}};
  EXPECT_EQ(cause_of(element), "beside the surface, on which 3 corners lie; in <code>foot</code>, <code>SALL</code>");
}

TEST(ReportPage, EveryMeasureIsAFigureWithALabelAndAMeaning) {
  Report full;
  full.surface.emplace();
  full.deviation.emplace();
  full.points.emplace();
  full.volume_mesh.emplace();
  const Json report = to_json(full);
  for (const NamedFigure& measure : shown_figures()) {
    EXPECT_NE(find_figure(report, measure.name), nullptr) << measure.name;
    EXPECT_NE(measure.label, "") << measure.name;
    EXPECT_NE(measure.meaning, "") << measure.name;
  }
}

TEST(ReportPage, LimitsAreNamedWithTheirSources) {
  Report figures;
  figures.volume_mesh.emplace();
  const std::string section = measures_section(to_json(figures));
  EXPECT_THAT(section, HasSubstr("above 165 warning [A]"));
  EXPECT_THAT(section, HasSubstr("170 or more warning [N]"));
  EXPECT_THAT(section, HasSubstr("<b>[N]</b> Autodesk Nastran"));
  EXPECT_THAT(section, testing::Not(HasSubstr("<b>[V]</b>"))) << "no figure of triangles is shown";
  figures.deviation.emplace();
  EXPECT_THAT(measures_section(to_json(figures)), HasSubstr("\u00b10.8 reached by the paper [P]<"));
}

TEST(ReportPage, GatesTellWhereTheyFailAndWhatTheyAreFrom) {
  Report figures;
  figures.surface = measure_surface(analytic::sphere(10, 2));
  Json report = to_json(figures);
  report["gates"] = {{{"name", "surface.max_angle_deg"},
                      {"operator", "<="},
                      {"value", 171},
                      {"limit", 165},
                      {"pass", false},
                      {"set", "ansys"},
                      {"source", "Ansys <SHPP>"},
                      {"place", {1, 2, 3}},
                      {"element", 42}},
                     {{"name", "surface.genus"},
                      {"operator", "=="},
                      {"value", nullptr},
                      {"limit", 0},
                      {"pass", false},
                      {"reason", "this mesh has none"}}};
  const std::string section = verdict_section(report);
  EXPECT_THAT(section, HasSubstr("2 of 2 gates failed"));
  EXPECT_THAT(section, HasSubstr("element 42 at (1, 2, 3)"));
  EXPECT_THAT(section, HasSubstr("<b>ansys</b> Ansys &lt;SHPP&gt;"));
  EXPECT_THAT(section, HasSubstr("this mesh has none"));
}

}  // namespace
}  // namespace scan2fea
