// What is drawn, pixel by pixel.
#include "quality/picture/picture.hpp"

#include "quality/picture/cut_open.hpp"
#include "quality/picture/element_colours.hpp"
#include "quality/picture/legend.hpp"
#include "quality/picture/text.hpp"
#include "tests/analytic_meshes.hpp"
#include "tests/structured_tets.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

namespace scan2fea {
namespace {

constexpr Rgb red{200, 0, 0}, blue{0, 0, 200};

std::size_t covered(const Raster& raster) {
  std::size_t count = 0;
  for (std::size_t i = 3; i < raster.rgba.size(); i += 4) count += raster.rgba[i] > 127;
  return count;
}

// Of a picture 100 pixels high that shows 10 model units.
double area_seen(const Raster& raster) {
  return static_cast<double>(covered(raster)) / 100;
}

constexpr PictureOptions small{.width = 120, .height = 100};
const PictureView from_front{.towards = {0, 1, 0}, .up = {0, 0, 1}, .centre = {0, 0, 0}, .height = 10};

SurfaceMesh centred(SurfaceMesh mesh) {
  const BoundingBox box = bounding_box(mesh.vertices);
  for (Vec3& p : mesh.vertices) p -= 0.5 * (box.low + box.high);
  return mesh;
}

TEST(Picture, ACutLeavesOutWhatIsBeyond) {
  const SurfaceMesh box = centred(analytic::box({8, 4, 6}, 1));
  const std::vector<Rgb> colours(box.triangles.size(), red);
  EXPECT_NEAR(area_seen(draw_raster(box, colours, from_front, small)), 48, 1);
  PictureView view = from_front;
  view.cut = Cut{.normal = {1, 0, 0}, .offset = 1};
  EXPECT_NEAR(area_seen(draw_raster(box, colours, view, small)), 30, 1);
}

TEST(Picture, ThroughACutTheInsideIsSeenDarker) {
  const SurfaceMesh box = centred(analytic::box({8, 4, 6}, 1));
  const std::vector<Rgb> colours(box.triangles.size(), red);
  PictureView view = from_front;
  Raster whole = draw_raster(box, colours, view, small);
  view.cut = Cut{.normal = {0, -1, 0}, .offset = 0};
  Raster open = draw_raster(box, colours, view, small);
  EXPECT_EQ(covered(open), covered(whole));
  EXPECT_LT(open.pixel(60, 50)[0], whole.pixel(60, 50)[0]);
}

// Whatever the cut, the elements that stay are seen as one closed surface around their volume.
TEST(SeenFaces, EncloseTheElementsThatStay) {
  for (const int order : {1, 2}) {
    const TetMesh mesh = analytic::tetrahedra_of_box({4, 3, 2}, {4, 3, 2}, order);
    for (const double offset : {-1.0, 0.4, 1.9, 3.1, 9.0}) {
      const Cut cut{.normal = Vec3(1, 1, 0).normalized(), .offset = offset};
      double volume = 0;
      for (std::size_t t = 0; t < mesh.tetrahedra.size(); ++t) {
        const auto& [a, b, c, d] = mesh.tetrahedra[t];
        const std::vector<Vec3>& x = mesh.nodes;
        if (cut.keeps((x[a] + x[b] + x[c] + x[d]) / 4)) volume += (x[b] - x[a]).cross(x[c] - x[a]).dot(x[d] - x[a]) / 6;
      }
      const SeenFaces seen = seen_faces(mesh, cut);
      SurfaceMesh surface{.vertices = mesh.nodes, .triangles = {}};
      for (const BoundaryFace f : seen.faces) surface.triangles.push_back(boundary_triangle(mesh, f));
      EXPECT_NEAR(enclosed_volume(surface), volume, 1e-12) << offset;
      for (std::size_t i = 0; i < seen.faces.size(); ++i) {
        if (seen.boundary_face[i] == SeenFaces::inside) continue;
        const BoundaryFace face = mesh.boundary[seen.boundary_face[i]];
        EXPECT_EQ(face.tetrahedron, seen.faces[i].tetrahedron);
        EXPECT_EQ(boundary_triangle(mesh, face), surface.triangles[i]);
      }
    }
    EXPECT_EQ(seen_faces(mesh, {.normal = {1, 0, 0}, .offset = 9}).faces.size(), mesh.boundary.size());
  }
}

TEST(Text, IsAsWideAsItIsLargeAndStaysInThePicture) {
  EXPECT_NEAR(text_width("0.25", 20), 2 * text_width("0.25", 10), 1e-9);
  EXPECT_GT(text_width("WW", 12), text_width("ii", 12));
  EXPECT_GT(text_width("Fl\u00e4che", 12), text_width("Flche", 12));
  EXPECT_GT(text_width("\xff\xc3", 12), 0);  // no UTF-8
  Raster raster{.width = 40, .height = 20, .rgba = std::vector<std::uint8_t>(40 * 20 * 4, 0)};
  draw_text(raster, "a long text", -5, 15, 14, red);
  draw_text(raster, "above and below", 10, -3, 14, red);
  draw_text(raster, "gjpq", 10, 22, 14, red);
  EXPECT_GT(covered(raster), 20U);
}

ElementColours colours_of(double low, double high, const std::vector<double>& values) {
  return colours_of_measure(count_elements("deviation", "triangles", values, {.low = low, .high = high, .bars = 41}),
                            "Deviation, mm", {});
}

// The bar has at each height the colour that a value there has.
TEST(Legend, TellsTheColourOfAValue) {
  const ElementColours colours = colours_of(-2, 2, {-2, -1, 0, 1, 2});
  constexpr std::uint32_t width = 500;
  const std::uint32_t beside = legend_width(colours.legend, width, 420);
  Raster picture{.width = width - beside, .height = 420, .rgba = {}};
  picture.rgba.assign(std::size_t{4} * picture.width * picture.height, 0);
  Raster raster = with_legend(picture, colours.legend, width);
  ASSERT_EQ(raster.width, width);
  const std::uint32_t x = picture.width + 10;  // in the bar
  std::vector<std::uint32_t> in_bar;
  for (std::uint32_t y = 0; y < raster.height; ++y)
    if (raster.pixel(x, y)[0] != 255 || raster.pixel(x, y)[2] != 255) in_bar.push_back(y);
  const double top = in_bar.front() < 40 ? 40 : in_bar.front(), bottom = in_bar.back();
  for (std::size_t i = 1; i + 1 < colours.of_faces.size(); ++i) {
    const double value = -2.0 + static_cast<double>(i);
    const auto y = static_cast<std::uint32_t>(bottom - (bottom - top) * (value + 2) / 4);
    for (std::size_t c = 0; c < 3; ++c) EXPECT_NEAR(raster.pixel(x, y)[c], colours.of_faces[i][c], 12) << value;
  }
}

TEST(Legend, SaysWhereValuesAreMissing) {
  EXPECT_FALSE(colours_of(-2, 2, {-2, 0, 2}).legend.has_gaps);
  EXPECT_TRUE(colours_of(-2, 2, {-2, std::numeric_limits<double>::quiet_NaN(), 2}).legend.has_gaps);
}

TEST(Legend, IsOpenWhereValuesLieBeyondIt) {
  EXPECT_FALSE(colours_of(-2, 2, {-2, 0, 2}).legend.is_open);
  EXPECT_TRUE(colours_of(-2, 2, {-2, 0, 2.1}).legend.is_open);
}

TEST(Legend, HasAsManyNamesAsThereIsRoomFor) {
  Legend legend{.title = "Set of faces"};
  for (int i = 0; i < 100; ++i) legend.names.push_back({"FACE_" + std::to_string(i), i % 2 == 0 ? red : blue});
  const Raster picture{.width = 10, .height = 200, .rgba = std::vector<std::uint8_t>(10 * 200 * 4, 0)};
  Raster raster = with_legend(picture, legend, 10 + legend_width(legend, 200, 200));
  for (std::uint32_t x = 0; x < raster.width; ++x) {
    const std::uint8_t* last = raster.pixel(x, raster.height - 1);
    EXPECT_TRUE(last[0] == 255 && last[1] == 255 && last[2] == 255) << "nothing is cut off below";
  }
}

TEST(ElementColours, OfSetsAreTheFirstOnes) {
  const std::vector<NamedSet> sets{{"a", {0, 1}}, {"FILLED", {3}}, {"b", {1, 2, 7}}};
  const ElementColours colours = colours_of_sets(sets, 5);
  ASSERT_EQ(colours.legend.names.size(), 2U);
  EXPECT_EQ(colours.of_faces[1], colours.legend.names[0].colour);
  EXPECT_EQ(colours.of_faces[2], colours.legend.names[1].colour);
  EXPECT_EQ(colours.of_faces[3], neutral_colour);
  const ElementColours made = colours_of_made_up(sets, 5);
  EXPECT_EQ(made.of_faces[3], made.legend.names[1].colour);
  EXPECT_EQ(std::ranges::count(made.of_faces, neutral_colour), 4);
}

}  // namespace
}  // namespace scan2fea
