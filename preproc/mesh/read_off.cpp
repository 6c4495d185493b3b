#include "preproc/mesh/polygon.hpp"
#include "preproc/mesh/surface_formats.hpp"
#include "preproc/mesh/text_scanner.hpp"
#include "preproc/mesh/triangle_rows.hpp"
#include "preproc/mesh/truncated.hpp"

#include <algorithm>
#include <limits>

namespace scan2fea {
namespace {

// The shortest texts of a vertex and of a face, without the line break that the last may lack.
constexpr std::size_t shortest_vertex = std::string_view("0 0 0").size();
constexpr std::size_t shortest_face = std::string_view("3 0 1 2").size();

// OFF with any of the prefixes ST, C, N, 4, n that Geomview defines, in that order.
bool is_magic(std::string_view word) {
  if (!word.ends_with("OFF")) return false;
  word.remove_suffix(3);
  for (const std::string_view prefix : {"ST", "C", "N", "4", "n"})
    if (word.starts_with(prefix)) word.remove_prefix(prefix.size());
  return word.empty();
}

// The header keyword, which Geomview allows to leave out.
void read_magic(TextScanner& scanner) {
  TextScanner ahead = scanner;
  if (!ahead.skip_space()) return;
  const char* start = ahead.position();
  const std::string_view magic = ahead.word();
  if (!is_magic(magic)) return;
  if (magic.find_first_of("4n") != std::string_view::npos)
    ahead.fail(start, "vertices of OFF are not in three dimensions", std::string(magic), "OFF, COFF, NOFF, STOFF");
  scanner = ahead;
  if (ahead.word() == "BINARY") ahead.fail(start, "binary OFF is not read", {}, {}, "ASCII OFF, or binary PLY");
}

std::size_t read_count(TextScanner& scanner, std::string_view of_what, std::size_t shortest) {
  if (!scanner.skip_space()) scanner.fail(scanner.position(), "the file ends before its counts");
  const char* start = scanner.position();
  const std::int64_t count = scanner.integer();
  const auto most = static_cast<std::int64_t>(
      std::min<std::size_t>(scanner.bytes_left() / shortest, std::numeric_limits<std::uint32_t>::max()));
  if (count < 0 || count > most)
    scanner.fail(start, "the header promises more " + std::string(of_what) + " than the file can hold",
                 std::to_string(count), std::to_string(most), truncated_advice);
  return static_cast<std::size_t>(count);
}

void to_row(TextScanner& scanner, std::string_view of_what, std::size_t row, std::size_t count) {
  if (!scanner.skip_space())
    scanner.fail(scanner.position(), "the file ends before its last " + std::string(of_what), std::to_string(row),
                 std::to_string(count), truncated_advice);
}

}  // namespace

bool is_off(const InputFile& file) {
  TextScanner scanner(file);
  return scanner.skip_space() && is_magic(scanner.word());
}

SurfaceMesh read_off(const InputFile& file, const TakeBlock& take) {
  TextScanner scanner(file);
  read_magic(scanner);
  const std::size_t vertices = read_count(scanner, "vertices", shortest_vertex);
  const std::size_t faces = read_count(scanner, "faces", shortest_face);
  scanner.skip_line();  // the number of edges, which nobody keeps right

  TriangleRows rows(take);
  SurfaceMesh& mesh = rows.mesh;
  mesh.vertices.reserve(vertices);
  for (std::size_t v = 0; v < vertices; ++v, scanner.skip_line()) {
    to_row(scanner, "vertex", v, vertices);
    mesh.vertices.push_back(scanner.point());  // normals, colours and texture may follow
  }

  mesh.triangles.reserve(rows.at_once(faces));
  std::vector<std::uint32_t> corners;
  for (std::size_t f = 0; f < faces; ++f, scanner.skip_line()) {
    to_row(scanner, "face", f, faces);
    const char* start = scanner.position();
    const std::int64_t count = scanner.integer();
    if (count < 3) scanner.fail(start, "a face has too few corners", std::to_string(count), "3");
    corners.clear();
    for (std::int64_t k = 0; k < count; ++k) {
      scanner.skip_blanks();
      const char* at = scanner.position();
      const std::int64_t index = scanner.integer();
      if (index < 0 || index >= static_cast<std::int64_t>(vertices))
        scanner.fail(at, "vertex index out of range", std::to_string(index), std::to_string(vertices) + " vertices");
      corners.push_back(static_cast<std::uint32_t>(index));
    }
    append_polygon(mesh, corners);  // a colour may follow
    rows.end_row();
  }
  return rows.finish();
}

}  // namespace scan2fea
