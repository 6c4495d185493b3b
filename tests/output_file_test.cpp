#include "preproc/mesh/output_file.hpp"

#include "preproc/mesh/error.hpp"
#include "tests/error_from.hpp"
#include "tests/temporary_folder.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <csignal>
#include <fcntl.h>
#include <string>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/time.h>
#include <unistd.h>

namespace scan2fea {
namespace {

using testing::HasSubstr;

std::size_t files_in(const TemporaryFolder& folder) {
  return static_cast<std::size_t>(std::distance(std::filesystem::directory_iterator(folder.path()), {}));
}

TEST(OutputFile, AppearsWhenCommitted) {
  const TemporaryFolder folder;
  {
    OutputFile output(folder / "part.inp");
    output.stream() << "all of it";
    EXPECT_FALSE(std::filesystem::exists(folder / "part.inp"));
    output.commit();
  }
  EXPECT_EQ(contents(folder / "part.inp"), "all of it");
  EXPECT_EQ(files_in(folder), 1u);
}

TEST(OutputFile, LeavesNothingBehindAFailure) {
  const TemporaryFolder folder;
  write_text(folder / "part.inp", "what stood there before");
  EXPECT_THROW(
      {
        OutputFile output(folder / "part.inp");
        output.stream() << "half of i" << std::flush;
        throw Cancelled();
      },
      Cancelled);
  EXPECT_EQ(contents(folder / "part.inp"), "what stood there before");
  EXPECT_EQ(files_in(folder), 1u);
}

TEST(OutputFile, ReplacesTheFileThatStoodThere) {
  const TemporaryFolder folder;
  OutputFile output(write_text(folder / "part.inp", "a longer text than the new one"));
  output.stream() << "new";
  output.commit();
  EXPECT_EQ(contents(folder / "part.inp"), "new");
}

TEST(OutputFile, TwoOfOneTargetDoNotMeet) {
  const TemporaryFolder folder;
  OutputFile first(folder / "part.inp");
  OutputFile second(folder / "part.inp");
  EXPECT_NE(first.temporary_path(), second.temporary_path());
  first.stream() << "first";
  second.stream() << "second";
  second.commit();
  first.commit();
  EXPECT_EQ(contents(folder / "part.inp"), "first");
}

TEST(OutputFile, TemporaryKeepsFolderAndExtension) {
  const TemporaryFolder folder;
  OutputFile output(folder / "part.v2.MSH");
  EXPECT_EQ(output.temporary_path().extension(), ".msh");
  EXPECT_EQ(output.temporary_path().parent_path(), folder.path());
}

TEST(OutputFile, IsTakenAwayBySignalHandlersUntilItIsCommitted) {
  const TemporaryFolder folder;
  OutputFile lost(folder / "lost.msh"), kept(folder / "kept.msh");
  EXPECT_TRUE(std::filesystem::exists(lost.temporary_path()));
  kept.commit();
  remove_unfinished_outputs();
  EXPECT_FALSE(std::filesystem::exists(lost.temporary_path()));
  EXPECT_EQ(files_in(folder), 1u);
  EXPECT_THROW(lost.commit(), IoError);
}

TEST(OutputFile, IsNotSeenBeforeItIsCommitted) {
  const TemporaryFolder folder;
  OutputFile output(folder / "part.inp");
  output.stream() << std::string(100'000, 'x') << std::flush;
  // File systems that know no files without names show a temporary one.
  const int nameless = ::open(folder.path().c_str(), O_TMPFILE | O_WRONLY, 0600);
  EXPECT_EQ(files_in(folder), nameless >= 0 ? 0u : 1u);
  output.commit();
  EXPECT_EQ(contents(folder / "part.inp").size(), 100'000u);
  EXPECT_EQ(files_in(folder), 1u);
}

TEST(OutputFile, MakesItsFolderWhenItIsCommitted) {
  const TemporaryFolder folder;
  OutputFile one(folder / "a/b/one.txt", OutputFile::Folder::is_made);
  OutputFile other(folder / "a/b/other.txt", OutputFile::Folder::is_made);
  one.stream() << "1";
  one.finish();
  EXPECT_FALSE(std::filesystem::exists(folder / "a"));
  one.commit();
  other.commit();
  EXPECT_EQ(contents(folder / "a/b/one.txt"), "1");
  EXPECT_TRUE(std::filesystem::exists(folder / "a/b/other.txt"));
  EXPECT_EQ(files_in(folder), 1u);
}

TEST(OutputFile, TakesWhatAnotherWriterWroteAtItsPath) {
  const TemporaryFolder folder;
  OutputFile output(folder / "part.msh");
  std::ofstream(output.temporary_path()) << "by another library";
  output.commit();
  EXPECT_EQ(contents(folder / "part.msh"), "by another library");
}

TEST(OutputFile, HasThePermissionsOfAnyNewFile) {
  const TemporaryFolder folder;
  OutputFile output(folder / "part.inp");
  output.commit();
  const auto any = std::filesystem::status(write_text(folder / "any", "")).permissions();
  EXPECT_EQ(std::filesystem::status(folder / "part.inp").permissions(), any);
}

TEST(OutputFile, WritesThroughALink) {
  const TemporaryFolder folder;
  write_text(folder / "real.inp", "old");
  std::filesystem::create_symlink(folder / "real.inp", folder / "link.inp");
  OutputFile output(folder / "link.inp");
  output.stream() << "new";
  output.commit();
  EXPECT_TRUE(std::filesystem::is_symlink(folder / "link.inp"));
  EXPECT_EQ(contents(folder / "real.inp"), "new");
}

TEST(OutputFile, FilesOfOneOutputArePutInPlaceTogether) {
  const TemporaryFolder folder;
  OutputFiles all;
  OutputFiles of_a_writer(&all);
  of_a_writer.open(folder / "nodes").stream() << "1";
  of_a_writer.add(folder / "elements", "2");
  of_a_writer.commit();
  EXPECT_FALSE(std::filesystem::exists(folder / "nodes"));
  EXPECT_EQ(contents(all.begin()->readable_path()), "1");
  write_text(folder / "of an earlier mesh", "");
  all.remove(folder / "of an earlier mesh");
  all.commit();
  EXPECT_EQ(contents(folder / "nodes") + contents(folder / "elements"), "12");
  EXPECT_EQ(files_in(folder), 2u);
}

std::string first_of_many, last_of_many;
volatile std::sig_atomic_t seen = 0, seen_in_part = 0;

void look_at_many(int) {
  const bool first = ::access(first_of_many.c_str(), F_OK) == 0, last = ::access(last_of_many.c_str(), F_OK) == 0;
  seen = seen + 1;
  if (first != last) seen_in_part = seen_in_part + 1;
}

// What a signal that ends the process leaves is all of the files or none.
TEST(OutputFiles, NoSignalComesBetweenTwoOfThem) {
  const TemporaryFolder folder;
  const auto name = [&](int i) { return folder / ("part_" + std::to_string(i) + ".vtu"); };
  constexpr int count = 500;  // a file each, more than a process may open by default
  first_of_many = name(0);
  last_of_many = name(count - 1);
  rlimit before{}, few{};
  ASSERT_EQ(getrlimit(RLIMIT_NOFILE, &before), 0);
  few = {.rlim_cur = std::min<rlim_t>(256, before.rlim_max), .rlim_max = before.rlim_max};
  ASSERT_EQ(setrlimit(RLIMIT_NOFILE, &few), 0);
  const auto old_handler = std::signal(SIGALRM, look_at_many);
  OutputFiles outer;
  {
    OutputFiles files(&outer);
    for (int i = 0; i < count; ++i) files.add(name(i), "text\n");
    files.commit();
  }
  EXPECT_EQ(files_in(folder), 0u);
  const itimerval often{.it_interval = {0, 50}, .it_value = {0, 50}}, never{};
  setitimer(ITIMER_REAL, &often, nullptr);
  outer.commit();
  while (seen == 0) {
  }
  setitimer(ITIMER_REAL, &never, nullptr);
  std::signal(SIGALRM, old_handler);
  setrlimit(RLIMIT_NOFILE, &before);
  EXPECT_EQ(seen_in_part, 0);
  EXPECT_EQ(files_in(folder), static_cast<std::size_t>(count));
}

TEST(OutputFile, RefusesAMissingFolder) {
  const TemporaryFolder folder;
  const auto error = error_from<IoError>([&] { OutputFile output(folder / "missing/part.inp"); });
  EXPECT_THAT(error.what(), HasSubstr("missing/part.inp"));
  EXPECT_EQ(error.exit_code(), 6);
}

TEST(OutputFile, RefusesDirectoriesAndDevices) {
  const TemporaryFolder folder;
  std::filesystem::create_directory(folder / "part.inp");
  EXPECT_THROW(OutputFile(folder / "part.inp"), IoError);
  EXPECT_THROW(OutputFile("/dev/null"), IoError);
}

TEST(OutputFile, TellsThatTheDiskIsFull) {
  const TemporaryFolder folder;
  write_text(folder / "part.inp", "old");
  // A limit on the size of files fails a write as a full disk does.
  struct rlimit before {};
  ASSERT_EQ(getrlimit(RLIMIT_FSIZE, &before), 0);
  const auto old_handler = std::signal(SIGXFSZ, SIG_IGN);
  struct rlimit small = before;
  small.rlim_cur = 1000;
  ASSERT_EQ(setrlimit(RLIMIT_FSIZE, &small), 0);
  {
    OutputFile output(folder / "part.inp");
    output.stream() << std::string(100'000, 'x');
    EXPECT_THROW(output.commit(), IoError);
  }
  setrlimit(RLIMIT_FSIZE, &before);
  std::signal(SIGXFSZ, old_handler);
  EXPECT_EQ(contents(folder / "part.inp"), "old");
  EXPECT_EQ(files_in(folder), 1u);
}

}  // namespace
}  // namespace scan2fea
