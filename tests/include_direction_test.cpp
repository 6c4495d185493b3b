// Includes point one way: a folder uses what its CMake target links, and a target links only what was made before it.
//
// The compiler cannot tell, since all headers are found from the project's root. CMake writes what each folder's target
// links, in the order in which the folders were added (include_rules.txt); this test holds every #include against it.
#include "tests/temporary_folder.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <map>
#include <regex>
#include <set>
#include <sstream>
#include <string>
#include <vector>

namespace scan2fea {
namespace {

namespace fs = std::filesystem;

struct Rule {
  std::string folder;           // "preproc/surface/lattice"
  std::set<std::string> links;  // folders of the targets that its own one links
};

// One folder a line: `folder: folder folder ...`, bottom up.
std::vector<Rule> read_rules(const fs::path& file) {
  std::vector<Rule> rules;
  std::ifstream lines(file);
  for (std::string line; std::getline(lines, line);) {
    const std::size_t colon = line.find(':');
    Rule rule{line.substr(0, colon), {}};
    std::istringstream links(line.substr(colon + 1));
    for (std::string link; links >> link;) rule.links.insert(link);
    rules.push_back(rule);
  }
  return rules;
}

// All that an #include names, in quotes or in angle brackets.
std::vector<std::string> included_headers(const fs::path& source) {
  static const std::regex include(R"(^\s*#\s*include\s*["<]([^">]+)[">].*)");
  std::vector<std::string> headers;
  std::ifstream lines(source);
  std::smatch found;
  for (std::string line; std::getline(lines, line);)
    if (std::regex_match(line, found, include)) headers.push_back(found[1]);
  return headers;
}

bool is_source(const fs::path& file) {
  static const std::set<std::string> extensions{".cpp", ".cc", ".cxx", ".hpp", ".h", ".hxx", ".inl", ".ipp"};
  return extensions.contains(file.extension().string());
}

// Whether the header is one of the project's, as files find it: from the root, or beside the file that includes it.
bool is_ours(const fs::path& root, const fs::path& source, const std::string& header) {
  return fs::exists(root / header) || fs::exists(root / source.parent_path() / header);
}

// Tests and examples use all folders but the command's (fuzzing alone reads its configuration files); `build` and
// folders with a dot hold no sources of ours.
bool is_checked(const std::string& top) {
  return !top.starts_with('.') && top != "build";
}

bool is_allowed(const std::map<std::string, std::set<std::string>>& links, const std::string& folder,
                const std::string& used) {
  if (used == folder) return true;
  if (folder == "tests/fuzz") return true;
  if (folder.starts_with("tests") || folder.starts_with("examples")) return used != "preproc/command";
  const auto own = links.find(folder);
  return own != links.end() && own->second.contains(used);
}

// "file includes header" for each include that the rules do not allow. A folder without a rule may include nothing of
// the project, so that no new one is forgotten.
std::vector<std::string> wrong_includes(const fs::path& root, const std::vector<Rule>& rules) {
  std::map<std::string, std::set<std::string>> links;
  for (const Rule& rule : rules) links[rule.folder] = rule.links;
  std::vector<std::string> wrong;
  for (const fs::directory_entry& top : fs::directory_iterator(root)) {
    if (!top.is_directory() || !is_checked(top.path().filename().string())) continue;
    for (const fs::directory_entry& entry : fs::recursive_directory_iterator(top)) {
      if (!entry.is_regular_file() || !is_source(entry.path())) continue;
      const fs::path source = entry.path().lexically_relative(root);
      const std::string folder = source.parent_path().generic_string();
      for (const std::string& header : included_headers(entry.path())) {
        const std::string used = fs::path(header).parent_path().generic_string();
        if (is_ours(root, source, header) && !is_allowed(links, folder, used))
          wrong.push_back(source.generic_string() + " includes " + header);
      }
    }
  }
  return wrong;
}

const fs::path project = SCAN2FEA_PROJECT;
const fs::path rules_file = SCAN2FEA_INCLUDE_RULES;

TEST(IncludeDirection, EveryFolderUsesOnlyWhatItsTargetLinks) {
  EXPECT_THAT(wrong_includes(project, read_rules(rules_file)), testing::IsEmpty());
}

TEST(IncludeDirection, EveryTargetLinksOnlyWhatWasMadeBeforeIt) {
  const std::vector<Rule> rules = read_rules(rules_file);
  ASSERT_GT(rules.size(), 1u);
  std::set<std::string> made;
  for (const Rule& rule : rules) {
    for (const std::string& link : rule.links) EXPECT_TRUE(made.contains(link)) << rule.folder << " links " << link;
    made.insert(rule.folder);
  }
}

// The repository's own rules, on a copy with one include that points up, however it is written.
TEST(IncludeDirection, FindsAPlantedWrongInclude) {
  for (const char* include : {"#include \"preproc/surface/lattice/lattice.hpp\"",
                              "  # include <preproc/surface/lattice/lattice.hpp>  // up"}) {
    const TemporaryFolder copy;
    for (const char* top : {"preproc", "quality", "export"})
      fs::copy(project / top, copy / top, fs::copy_options::recursive);
    std::ofstream(copy / "preproc/surface/kernel/adjacency.hpp", std::ios::app) << include << "\n";
    EXPECT_THAT(
        wrong_includes(copy.path(), read_rules(rules_file)),
        testing::ElementsAre("preproc/surface/kernel/adjacency.hpp includes preproc/surface/lattice/lattice.hpp"));
  }
}

TEST(IncludeDirection, FindsAFolderWithoutARule) {
  const TemporaryFolder tree;
  for (const char* folder : {"clouds", "quality"}) fs::create_directories(tree / folder);
  std::ofstream(tree / "quality/report.hpp") << "#pragma once\n";
  std::ofstream(tree / "clouds/stage.h") << "#include \"quality/report.hpp\"\n#include <vector>\n";
  EXPECT_THAT(wrong_includes(tree.path(), read_rules(rules_file)),
              testing::ElementsAre("clouds/stage.h includes quality/report.hpp"));
}

TEST(IncludeDirection, NoTestIncludesTheCommand) {
  const TemporaryFolder tree;
  for (const char* folder : {"tests", "preproc/command"}) fs::create_directories(tree / folder);
  std::ofstream(tree / "preproc/command/flags.hpp") << "#pragma once\n";
  std::ofstream(tree / "tests/flags_test.cpp") << "#include \"preproc/command/flags.hpp\"\n";
  EXPECT_THAT(wrong_includes(tree.path(), read_rules(rules_file)),
              testing::ElementsAre("tests/flags_test.cpp includes preproc/command/flags.hpp"));
}

}  // namespace
}  // namespace scan2fea
