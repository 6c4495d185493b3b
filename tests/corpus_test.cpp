// The command tests/corpus, on a folder as a user has it: a sound part, one open on a side, and a file that broke off.
#include "preproc/mesh/write_surface.hpp"
#include "tests/analytic_meshes.hpp"
#include "tests/temporary_folder.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <sys/wait.h>

namespace scan2fea {
namespace {

using ::testing::ContainsRegex;

struct Table {
  int exit_code;
  std::string text;
};

Table table_of(const std::filesystem::path& folder, const std::string& flags = {}) {
  const TemporaryFolder output;
  const std::filesystem::path out = output / "table";
  // Sanitizers reserve terabytes of addresses.
  const std::string line = std::string("'") + SCAN2FEA_CORPUS + "' '" + folder.string() + "' --scan2fea '" +
                           SCAN2FEA_COMMAND + "' --gigabytes inf " + flags + " >'" + out.string() + "' </dev/null";
  const int status = std::system(line.c_str());
  return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, contents(out)};
}

class Corpus : public ::testing::Test {
 protected:
  void SetUp() override {
    std::filesystem::create_directory(folder_ / "more");
    SurfaceMesh box = analytic::box({30, 20, 10}, 5);
    write_surface(box, folder_ / "box.off");
    SurfaceMesh torn = box;
    torn.triangles.pop_back();
    write_surface(torn, folder_ / "more/torn.stl");
    box.triangles.resize(box.triangles.size() / 6);
    write_surface(box, folder_ / "sheet.ply");
    write_text(folder_ / "broken.off", "OFF\n8 12 0\n0 0 0\n");
    write_text(folder_ / "notes.txt", "no mesh");
  }

  TemporaryFolder folder_;
};

TEST_F(Corpus, TellsWhatBecameOfEachFileAndWhy) {
  const Table table = table_of(folder_.path());
  EXPECT_EQ(table.exit_code, 0);  // refusals are no failures
  EXPECT_THAT(table.text, ContainsRegex(R"(\| box\.off \| valid \| none \| [0-9]+ \| [0-9]+ \| [0-9.]+° \| 0 / 0 \|)"));
  EXPECT_THAT(table.text, ContainsRegex(R"(\| more/torn\.stl \| valid \| filled \|)"));
  EXPECT_THAT(table.text, ContainsRegex(R"(\| sheet\.ply \| refused \|.*its opening is too large)"));
  EXPECT_THAT(table.text, ContainsRegex(R"(\| broken\.off \| refused \|.*broken\.off:)"));
  EXPECT_EQ(std::count(table.text.begin(), table.text.end(), '\n'), 6);
}

TEST_F(Corpus, FailsWhereALimitIsTooLow) {
  const Table table = table_of(folder_.path(), "--only box.off --seconds 0.001");
  EXPECT_EQ(table.exit_code, 1);
  EXPECT_THAT(table.text, ContainsRegex(R"(\| box\.off \| too slow)"));
}

}  // namespace
}  // namespace scan2fea
