#include "quality/report_page/html.hpp"
#include "quality/report_page/page_sections.hpp"

#include <algorithm>

namespace scan2fea {
namespace {

using namespace html;

std::string for_shell(const std::string& word) {
  const bool is_plain = !word.empty() && std::ranges::all_of(word, [](unsigned char c) {
    return std::isalnum(c) || std::string_view("_-./=:,%+@").find(static_cast<char>(c)) != std::string_view::npos;
  });
  if (is_plain) return word;
  std::string text = "'";
  for (const char c : word) text += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return text + "'";
}

std::string command_lines(const Json& report) {
  if (!report.contains("command")) return {};
  std::string line;
  for (const Json& word : report["command"]["arguments"])
    line += (line.empty() ? "" : " ") + for_shell(word.get<std::string>());
  // Its files are there.
  if (std::ranges::find(report["command"]["arguments"], "--force") == report["command"]["arguments"].end())
    line += " --force";
  return "<h3>Make it again</h3>\n<pre id=\"command\">cd " +
         escaped(for_shell(report["command"]["folder"].get<std::string>())) + "\n" + escaped(line) +
         "</pre>\n<p>The same version of the program writes the same bytes, for any number of threads, over those that "
         "are there.</p>\n";
}

// What came through a pipe, was in the memory of a program, or was not written, has no hash.
void add_file(const Json& file, const std::string& what, Table& table) {
  const Json& hash = file["sha256"];
  table.row({what, "<code>" + escaped(file["file"].get<std::string>()) + "</code>", number(file["bytes"]),
             hash.is_null() ? "" : "<code class=\"hash\">" + escaped(hash.get<std::string>()) + "</code>"});
}

std::string file_table(const Json& report) {
  Table table("Files", {"What", "File", "#Bytes", "SHA-256"});
  if (report.contains("inputs"))
    for (const Json& input : report["inputs"]) add_file(input, escaped(input["role"].get<std::string>()), table);
  if (report.contains("outputs"))
    for (const Json& output : report["outputs"]) {
      const std::string role = escaped(output["role"].get<std::string>());
      add_file(output, role + (output["written"].get<bool>() ? ", written" : ", not written: a gate failed"), table);
    }
  return table.text();
}

std::string size_row(const Json& part) {
  return number(part["box"][0], 6) + " \u00d7 " + number(part["box"][1], 6) + " \u00d7 " + number(part["box"][2], 6);
}

std::string size_table(const Json& report) {
  Table table("Sizes",
              {"What", "#Vertices", "#Triangles", "#Box, " + unit_text(report), "#Diagonal, " + unit_text(report)});
  const auto row = [&](const std::string& what, const Json& mesh) {
    table.row({what, number(mesh["vertices"]), number(mesh["triangles"]), size_row(mesh), number(mesh["diagonal"], 6)});
  };
  if (const Json* scan = find_figure(report, "compared.reference"))
    row("reference: what the comparison measures both from", *scan);
  if (report.contains("reference"))
    row(report.contains("compared") ? "first mesh: what the second is measured from"
                                    : "reference: what the figures compare with",
        report["reference"]);
  if (report.contains("size"))
    table.row({report.contains("compared") ? "surface of the second mesh" : "surface of the mesh",
               figure(report, "surface.vertices"), figure(report, "surface.faces"), size_row(report["size"]),
               number(report["size"]["diagonal"], 6)});
  return table.text();
}

std::string versions(const Json& report) {
  if (!report.contains("program")) return {};
  const Json& program = report["program"];
  std::string text = "<h3>Made by</h3>\n<p>" + escaped(program["name"].get<std::string>()) + " " +
                     escaped(program["version"].get<std::string>());
  for (const auto& [name, version] : program["libraries"].items())
    text += ", " + escaped(name) + " " + escaped(version.get<std::string>());
  return text + "; format of the figures: " + escaped(report["schema"].get<std::string>()) + ".</p>\n";
}

}  // namespace

std::string origin_section(const Json& report) {
  return "<h2 id=\"origin\">What went in and came out</h2>\n" + file_table(report) + size_table(report) +
         command_lines(report) + versions(report);
}

}  // namespace scan2fea
