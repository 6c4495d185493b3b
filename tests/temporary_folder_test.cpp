#include "tests/temporary_folder.hpp"

#include "preproc/mesh/error.hpp"
#include "tests/error_from.hpp"

#include <gmock/gmock.h>

#include <cstdlib>
#include <optional>

namespace scan2fea {
namespace {

using testing::HasSubstr;

// TMPDIR as it was, in the end.
class TemporaryFolderTest : public testing::Test {
 protected:
  TemporaryFolderTest() {
    if (const char* set = std::getenv("TMPDIR")) before_ = set;
  }
  ~TemporaryFolderTest() override { before_ ? setenv("TMPDIR", before_->c_str(), 1) : unsetenv("TMPDIR"); }

 private:
  std::optional<std::string> before_;
};

TEST_F(TemporaryFolderTest, GoesWithAllThatIsInIt) {
  std::filesystem::path place;
  {
    const TemporaryFolder folder, other;
    place = folder.path();
    EXPECT_NE(place, other.path());
    std::filesystem::create_directory(folder / "inner");
    EXPECT_EQ(contents(write_text(folder / "inner/file", "text")), "text");
    EXPECT_EQ(std::filesystem::status(place).permissions(), std::filesystem::perms::owner_all);
  }
  EXPECT_FALSE(std::filesystem::exists(place));
}

TEST_F(TemporaryFolderTest, LiesInTmpdir) {
  const TemporaryFolder outer;
  setenv("TMPDIR", outer.path().c_str(), 1);
  EXPECT_EQ(TemporaryFolder().path().parent_path(), outer.path());
}

TEST_F(TemporaryFolderTest, SaysWhereNoneCanBeMade) {
  const TemporaryFolder outer;
  const std::string missing = outer / "missing";
  setenv("TMPDIR", missing.c_str(), 1);
  const auto error = error_from<IoError>([] { TemporaryFolder(); });
  EXPECT_EQ(error.parts().where, missing);
  EXPECT_THAT(error.what(), HasSubstr("cannot make a temporary folder"));
  EXPECT_THAT(error.what(), HasSubstr("set TMPDIR"));
}

}  // namespace
}  // namespace scan2fea
