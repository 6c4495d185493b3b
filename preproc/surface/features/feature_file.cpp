#include "preproc/surface/features/feature_file.hpp"

#include "preproc/mesh/input_file.hpp"
#include "preproc/mesh/output_file.hpp"
#include "preproc/mesh/text_scanner.hpp"

#include <charconv>
#include <limits>
#include <string>

namespace scan2fea {
namespace {

// The shortest decimal that reads back as the value.
template <class Number>
void append(std::string& text, Number value) {
  char digits[32];
  const auto [last, error] = std::to_chars(digits, digits + sizeof digits, value);
  text += ' ';
  text.append(digits, last);
}

// The point of `v` or `v/vt`, where v counts from 1, or back from the last point so far.
std::uint32_t read_index(TextScanner& line, std::size_t points_so_far, std::size_t points) {
  const char* start = line.position();
  const std::int64_t index = line.integer('/');
  line.finish_word();
  const auto so_far = static_cast<std::int64_t>(points_so_far);
  if (index == 0 || index > static_cast<std::int64_t>(points) || index < -so_far)
    line.fail(start, "point index out of range", std::to_string(index), std::to_string(points) + " points");
  return static_cast<std::uint32_t>(index > 0 ? index - 1 : so_far + index);
}

}  // namespace

FeatureLines lines_of(const SurfaceMesh& mesh, const std::vector<FeatureEdge>& edges) {
  constexpr std::uint32_t unused = std::numeric_limits<std::uint32_t>::max();
  std::vector<std::uint32_t> point_of(mesh.vertices.size(), unused);
  for (const FeatureEdge& e : edges)
    for (const std::uint32_t v : e) point_of[v] = 0;
  FeatureLines lines;
  for (std::size_t v = 0; v < point_of.size(); ++v) {
    if (point_of[v] == unused) continue;
    point_of[v] = static_cast<std::uint32_t>(lines.points.size());
    lines.points.push_back(mesh.vertices[v]);
  }
  for (const FeatureEdge& e : edges) lines.segments.push_back({point_of[e[0]], point_of[e[1]]});
  return lines;
}

std::string text_of(const FeatureLines& lines) {
  std::string text = "# feature edges, written by scan2fea\n";
  for (const Vec3& p : lines.points) {
    text += 'v';
    for (const double coordinate : p) append(text, coordinate);
    text += '\n';
  }
  for (const auto& segment : lines.segments) {
    text += 'l';
    for (const std::uint32_t point : segment) append(text, std::uint64_t{point} + 1);
    text += '\n';
  }
  return text;
}

void write_feature_lines(const FeatureLines& lines, const std::filesystem::path& file) {
  const std::string text = text_of(lines);
  OutputFile output(file);
  output.stream().write(text.data(), static_cast<std::streamsize>(text.size()));
  output.commit();
}

FeatureLines read_feature_lines(const std::filesystem::path& path) {
  const InputFile file(path);
  FeatureLines lines;
  for (TextScanner line(file); line.skip_space(); line.skip_line())
    if (line.word() == "v") lines.points.push_back(line.point());
  // A line may name points that stand behind it.
  std::size_t points_so_far = 0;
  for (TextScanner line(file); line.skip_space(); line.skip_line()) {
    const char* start = line.position();
    const std::string_view keyword = line.word();
    if (keyword == "v") ++points_so_far;
    if (keyword != "l") continue;
    if (!line.skip_blanks()) line.fail(start, "a line has too few points", "0", "2");
    std::uint32_t from = read_index(line, points_so_far, lines.points.size());
    if (!line.skip_blanks()) line.fail(start, "a line has too few points", "1", "2");
    do {
      const std::uint32_t to = read_index(line, points_so_far, lines.points.size());
      if (to != from) lines.segments.push_back({from, to});
      from = to;
    } while (line.skip_blanks());
  }
  return lines;
}

}  // namespace scan2fea
