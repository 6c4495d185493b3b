// A disk that is full, of a small file system in memory, while a file of any format is written: exit code 6, the
// earlier file as it was, and nothing else beside it.
#include "export/formats.hpp"
#include "preproc/mesh/write_surface.hpp"
#include "tests/analytic_meshes.hpp"
#include "tests/part_with_sets.hpp"
#include "tests/temporary_folder.hpp"

#include <gmock/gmock.h>

#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <string>
#include <sys/wait.h>

namespace scan2fea {
namespace {

// Runs `script` in bash in a name space of its own, where it may mount what others do not see.
struct Ran {
  int status;
  std::string printed;
};
Ran run_apart(const std::filesystem::path& folder, const std::string& script) {
  write_text(folder / "script", script);
  const std::string command = "unshare --user --map-root-user --mount bash '" + (folder / "script").string() + "' 2>&1";
  FILE* pipe = popen(command.c_str(), "r");
  std::string printed;
  for (int byte; (byte = std::fgetc(pipe)) != EOF;) printed += static_cast<char>(byte);
  const int status = WEXITSTATUS(pclose(pipe));
  return {status, std::move(printed)};
}

class FullDisk : public testing::Test {
 protected:
  void SetUp() override {
    std::filesystem::create_directory(folder_ / "disk");
    if (run_apart(folder_.path(), "mount -t tmpfs -o size=64k tmpfs '" + (folder_ / "disk").string() + "'").status != 0)
      GTEST_SKIP() << "no file system can be mounted here";
  }

  // What stands on the disk after the conversion of `input`, and what it said.
  Ran convert(const std::filesystem::path& input, const std::string& name, const std::string& flags) {
    const std::string disk = (folder_ / "disk").string();
    return run_apart(folder_.path(), "mount -t tmpfs -o size=64k tmpfs '" + disk + "'\necho earlier > '" + disk + "/" +
                                         name + "'\n'" SCAN2FEA_COMMAND "' convert '" + input.string() + "' -o '" +
                                         disk + "/" + name + "' --force " + flags + "\ncode=$?\nls -A '" + disk +
                                         "'\ncat '" + disk + "/" + name + "'\nexit $code\n");
  }

  TemporaryFolder folder_;
};

TEST_F(FullDisk, LeavesTheEarlierFileWhateverTheFormat) {
  TetMesh mesh = analytic::tetrahedra_of_box({4, 2, 1}, {16, 12, 10}, 1);
  mesh.boundary = find_boundary(mesh.tetrahedra);
  write_volume(mesh, folder_ / "part.inp");
  NamedSurface ball;
  ball.mesh = analytic::sphere(1, 4);
  write_surface(ball, folder_ / "ball.vtp");
  for (const FileFormat& format : file_formats()) {
    if (format.write_volume == nullptr && format.write_surface == nullptr) continue;
    const std::string name = format.extension == ".header" ? "mesh.header" : "part" + std::string(format.extension);
    const bool of_volume = format.write_volume != nullptr;
    const Ran ran = convert(of_volume ? folder_ / "part.inp" : folder_ / "ball.vtp", name,
                            format.parts == Parts::never ? "" : "--parts 3");
    EXPECT_EQ(ran.status, 6) << name << ": " << ran.printed;
    EXPECT_THAT(ran.printed, testing::EndsWith("\n" + name + "\nearlier\n")) << name;
    std::printf("%s: %s", name.c_str(), ran.printed.c_str());
  }
}

}  // namespace
}  // namespace scan2fea
