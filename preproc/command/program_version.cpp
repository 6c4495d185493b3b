#include "preproc/command/program_version.hpp"

#include "preproc/command/provenance.hpp"
#include "quality/report.hpp"

#include <CLI/Version.hpp>
#include <nlohmann/json.hpp>
#include <scan2fea/version.hpp>
#include <tbb/version.h>

namespace scan2fea::command {

// Gmsh is not among them: its formats are read and written by sources of our own.
std::string version_text() {
  std::string text = std::string("scan2fea ") + library_version + "\n";
  text += std::string("figures   ") + report_schema + "\n";
  const auto add = [&](const std::string& name, const std::string& version) {
    text += name + std::string(name.size() < 10 ? 10 - name.size() : 1, ' ') + version + "\n";
  };
  const Json program = program_json();
  for (const char* name : {"TetGen", "CGAL", "Eigen"}) add(name, program["libraries"][name].get<std::string>());
  add("oneTBB", TBB_VERSION_STRING);
  add("CLI11", CLI11_VERSION);
  text.pop_back();
  return text;
}

}  // namespace scan2fea::command
