#include "preproc/mesh/byte_order.hpp"
#include "preproc/mesh/surface_formats.hpp"
#include "preproc/mesh/text_scanner.hpp"
#include "preproc/mesh/triangle_rows.hpp"
#include "preproc/mesh/truncated.hpp"
#include "preproc/mesh/vertex_welder.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace scan2fea {
namespace {

constexpr std::size_t count_offset = 80;
constexpr std::size_t header_size = 84;
constexpr std::size_t triangle_size = 50;  // normal, three corners, two bytes of attributes
constexpr std::size_t corner_offset = 12;  // the normal is passed over: it follows from the corners, and is often 0
constexpr std::size_t corner_size = 12;

std::size_t promised_triangles(std::string_view bytes) {
  return load<std::uint32_t>(bytes.data() + count_offset, std::endian::little);
}

// Programs write "solid" at the start of binary files too, so the count and control characters are what tells.
bool looks_like_text(std::string_view bytes) {
  constexpr std::size_t sample = 1024;  // a binary file has its count in it, and some nineteen triangles
  return std::ranges::none_of(bytes.substr(0, sample), [](char c) {
    const auto code = static_cast<unsigned char>(c);
    return code < 0x20 && c != '\t' && c != '\n' && c != '\v' && c != '\f' && c != '\r';
  });
}

Vec3 read_corner(const InputFile& file, const char* at) {
  Vec3 point;
  for (std::size_t k = 0; k < 3; ++k) {
    const float value = load<float>(at + 4 * k, std::endian::little);
    if (!std::isfinite(value)) file.fail_at_byte(at + 4 * k, "not a finite coordinate", std::to_string(value));
    point[static_cast<int>(k)] = static_cast<double>(value);
  }
  return point;
}

// The corners of facets welded: with a block of triangles its vertices go, too.
class Facets {
 public:
  Facets(std::size_t expected, const TakeBlock& take)
      : rows_(take), expected_(rows_.at_once(expected)), welder_(vertices_of(expected_)) {
    rows_.mesh.triangles.reserve(expected_);
  }

  std::size_t count() const { return rows_.count(); }
  void prefetch(const Vec3& corner) const { welder_.prefetch(corner); }
  std::uint32_t vertex_at(const Vec3& corner) { return welder_.add(corner); }
  void add(const Triangle& facet) {
    rows_.mesh.triangles.push_back(facet);
    if (!rows_.is_block()) return;
    rows_.mesh.vertices = welder_.take_vertices();
    rows_.hand_over();
    welder_ = VertexWelder(vertices_of(expected_));
  }
  SurfaceMesh finish() {
    rows_.mesh.vertices = welder_.take_vertices();
    return rows_.finish();
  }

 private:
  // As many as a closed surface of genus 0 has.
  static std::size_t vertices_of(std::size_t triangles) { return triangles / 2 + 2; }

  TriangleRows rows_;
  std::size_t expected_;
  VertexWelder welder_;
};

SurfaceMesh read_binary(const InputFile& file, const TakeBlock& take) {
  const std::string_view bytes = file.bytes();
  if (bytes.size() < header_size)
    file.fail("neither an ASCII STL nor long enough for a binary one", std::to_string(bytes.size()) + " bytes",
              std::to_string(header_size) + " bytes at least", "exporting the scan again");
  const std::size_t promised = promised_triangles(bytes);
  const std::size_t held = (bytes.size() - header_size) / triangle_size;
  if (promised > held)
    file.fail_at_byte(bytes.data() + count_offset, "the header promises more triangles than the file holds",
                      std::to_string(promised), std::to_string(held), truncated_advice);
  if (promised < held)
    file.fail_at_byte(bytes.data() + count_offset, "the file holds more triangles than its header says",
                      std::to_string(held), std::to_string(promised), "exporting the scan again");

  Facets facets(promised, take);
  const auto point = [&](std::size_t t, std::size_t k) {
    return read_corner(file, bytes.data() + header_size + t * triangle_size + corner_offset + k * corner_size);
  };
  // Welding waits for memory otherwise: the places of corners in its table are fetched so many triangles ahead.
  constexpr std::size_t ahead = 8;
  for (std::size_t t = 0; t < promised; ++t) {
    if (t + ahead < promised)
      for (std::size_t k = 0; k < 3; ++k) facets.prefetch(point(t + ahead, k));
    facets.add({facets.vertex_at(point(t, 0)), facets.vertex_at(point(t, 1)), facets.vertex_at(point(t, 2))});
  }
  return facets.finish();
}

// Line by line: the keywords that hold nothing (`outer loop`, normals, names) are passed over.
SurfaceMesh read_ascii(const InputFile& file, std::vector<NamedSet>* sets, const TakeBlock& take) {
  Facets facets(0, take);
  Triangle corners{};
  std::size_t count = 0;
  bool inside_solid = false;
  constexpr std::size_t no_set = std::numeric_limits<std::size_t>::max();
  std::size_t solid = no_set;  // of `sets`
  TextScanner line(file);
  for (; line.skip_space(); line.skip_line()) {
    const char* start = line.position();
    const std::string_view keyword = line.word();
    if (is_keyword(keyword, "vertex")) {
      if (count == 3) line.fail(start, "a facet has more than three vertices", {}, {}, "triangulating the surface");
      corners[count++] = facets.vertex_at(line.point());
    } else if (is_keyword(keyword, "endfacet")) {
      if (count != 3) line.fail(start, "a facet ends before its third vertex", std::to_string(count), "3");
      if (solid != no_set) (*sets)[solid].members.push_back(static_cast<std::uint32_t>(facets.count()));
      facets.add(corners);
      count = 0;
    } else if (is_keyword(keyword, "solid") || is_keyword(keyword, "endsolid")) {
      inside_solid = is_keyword(keyword, "solid");
      solid = no_set;
      if (sets != nullptr && inside_solid && line.skip_blanks()) solid = find_or_add_set(*sets, line.word());
      if (count != 0) line.fail(start, "a solid begins or ends inside a facet");
    } else if (!is_keyword(keyword, "facet") && !is_keyword(keyword, "outer") && !is_keyword(keyword, "endloop")) {
      line.fail(start, "not a keyword of STL", std::string(keyword.substr(0, 40)), {},
                "checking that this is an STL file");
    }
  }
  if (inside_solid) line.fail(line.position(), "the file ends before endsolid", {}, {}, truncated_advice);
  // One solid is the whole, whatever it is called: programs write their own name there.
  if (sets != nullptr && sets->size() == 1 && sets->front().members.size() == facets.count()) sets->clear();
  return facets.finish();
}

}  // namespace

bool is_binary_stl(const InputFile& file) {
  const std::string_view bytes = file.bytes();
  return bytes.size() > header_size && bytes.size() == header_size + triangle_size * promised_triangles(bytes);
}

SurfaceMesh read_stl(const InputFile& file, std::vector<NamedSet>* sets, const TakeBlock& take) {
  return is_binary_stl(file) || !looks_like_text(file.bytes()) ? read_binary(file, take) : read_ascii(file, sets, take);
}

}  // namespace scan2fea
