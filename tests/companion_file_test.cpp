#include "preproc/mesh/companion_file.hpp"

#include <gtest/gtest.h>

#include <filesystem>

namespace scan2fea {
namespace {

namespace fs = std::filesystem;

// What an installation does with it: tests/package.
TEST(CompanionFile, LiesBesideTheProgramInTheBuildFolder) {
  const fs::path program = fs::read_symlink("/proc/self/exe");
  const fs::path found = companion_file(program.filename().string());
  EXPECT_TRUE(fs::is_regular_file(found));
  EXPECT_EQ(found, program);
}

TEST(CompanionFile, HasAPlaceEvenWhereItIsMissing) {
  const fs::path expected = fs::read_symlink("/proc/self/exe").replace_filename("no-such-companion");
  EXPECT_EQ(companion_file("no-such-companion"), expected);
}

}  // namespace
}  // namespace scan2fea
