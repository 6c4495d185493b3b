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

std::vector<std::string> included_headers(const fs::path& source) {
  const std::string keyword = "#include \"";
  std::vector<std::string> headers;
  std::ifstream lines(source);
  for (std::string line; std::getline(lines, line);)
    if (line.starts_with(keyword)) headers.push_back(line.substr(keyword.size(), line.rfind('"') - keyword.size()));
  return headers;
}

// "file includes header, and its folder links ..." for each include that the rules do not allow. A folder without a
// rule may include nothing of the project, so that no new one is forgotten.
std::vector<std::string> wrong_includes(const fs::path& root, const std::vector<Rule>& rules) {
  std::map<std::string, std::set<std::string>> allowed;
  for (const Rule& rule : rules) allowed[rule.folder] = rule.links;
  std::vector<std::string> wrong;
  for (const char* top : {"preproc", "quality", "export"}) {
    for (const fs::directory_entry& entry : fs::recursive_directory_iterator(root / top)) {
      const fs::path extension = entry.path().extension();
      if (extension != ".cpp" && extension != ".hpp") continue;
      const fs::path source = entry.path().lexically_relative(root);
      const std::string folder = source.parent_path().generic_string();
      for (const std::string& header : included_headers(entry.path())) {
        const std::string used = fs::path(header).parent_path().generic_string();
        if (used != folder && !allowed[folder].contains(used))
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

// The repository's own rules, on a copy with one include that points up.
TEST(IncludeDirection, FindsAPlantedWrongInclude) {
  const TemporaryFolder copy;
  for (const char* top : {"preproc", "quality", "export"})
    fs::copy(project / top, copy / top, fs::copy_options::recursive);
  const fs::path planted = copy / "preproc/surface/kernel/adjacency.hpp";
  std::ofstream(planted, std::ios::app) << "#include \"preproc/surface/lattice/lattice.hpp\"\n";
  EXPECT_THAT(
      wrong_includes(copy.path(), read_rules(rules_file)),
      testing::ElementsAre("preproc/surface/kernel/adjacency.hpp includes preproc/surface/lattice/lattice.hpp"));
}

TEST(IncludeDirection, FindsAFolderWithoutARule) {
  const TemporaryFolder tree;
  for (const char* top : {"preproc/new", "quality", "export"}) fs::create_directories(tree / top);
  std::ofstream(tree / "preproc/new/stage.cpp") << "#include \"quality/report.hpp\"\n";
  EXPECT_THAT(wrong_includes(tree.path(), read_rules(rules_file)),
              testing::ElementsAre("preproc/new/stage.cpp includes quality/report.hpp"));
}

}  // namespace
}  // namespace scan2fea
