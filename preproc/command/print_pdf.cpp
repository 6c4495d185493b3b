#include "preproc/command/print_pdf.hpp"

#include "preproc/mesh/error.hpp"

#include <chrono>
#include <csignal>
#include <cstdlib>
#include <fcntl.h>
#include <fstream>
#include <iterator>
#include <spawn.h>
#include <sstream>
#include <sys/wait.h>
#include <thread>
#include <unistd.h>
#include <vector>

namespace scan2fea::command {
namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

class WorkFolder {
 public:
  WorkFolder() : path_((fs::temp_directory_path() / "scan2fea-pdf-XXXXXX").string()) {
    if (::mkdtemp(path_.data()) == nullptr)
      throw IoError(
          {.what = "no temporary folder can be made", .where = path_, .value = {}, .limit = {}, .advice = "TMPDIR"});
  }
  ~WorkFolder() {
    std::error_code ignored;
    fs::remove_all(path_, ignored);
  }
  WorkFolder(const WorkFolder&) = delete;
  WorkFolder& operator=(const WorkFolder&) = delete;
  fs::path operator/(const char* name) const { return fs::path(path_) / name; }

 private:
  std::string path_;
};

// With all that it starts in a group of its own, so that all of it ends with the time.
bool run_silently(const fs::path& program, const std::vector<std::string>& arguments, std::chrono::seconds limit) {
  std::vector<char*> argv{const_cast<char*>(program.c_str())};
  for (const std::string& argument : arguments) argv.push_back(const_cast<char*>(argument.c_str()));
  argv.push_back(nullptr);
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  for (const int stream : {STDOUT_FILENO, STDERR_FILENO})
    posix_spawn_file_actions_addopen(&actions, stream, "/dev/null", O_WRONLY, 0);
  posix_spawnattr_t attributes;
  posix_spawnattr_init(&attributes);
  posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETPGROUP);
  pid_t child = 0;
  const int error = ::posix_spawn(&child, program.c_str(), &actions, &attributes, argv.data(), environ);
  posix_spawnattr_destroy(&attributes);
  posix_spawn_file_actions_destroy(&actions);
  if (error != 0) return false;
  int status = 0;
  for (const auto end = Clock::now() + limit; ::waitpid(child, &status, WNOHANG) == 0;
       std::this_thread::sleep_for(std::chrono::milliseconds(20))) {
    if (Clock::now() < end) continue;
    ::kill(-child, SIGKILL);
    ::waitpid(child, &status, 0);
    return false;
  }
  return WIFEXITED(status) && WEXITSTATUS(status) == 0;
}

std::vector<std::string> flags_of_chromium(const WorkFolder& folder) {
  std::vector<std::string> flags{"--headless=new",
                                 "--no-first-run",
                                 "--disable-extensions",
                                 "--use-gl=angle",
                                 "--use-angle=swiftshader",
                                 "--enable-unsafe-swiftshader",
                                 "--no-pdf-header-footer",
                                 "--virtual-time-budget=20000",  // ms, for the page's script
                                 "--user-data-dir=" + (folder / "profile").string(),
                                 "--print-to-pdf=" + (folder / "report.pdf").string()};
  if (::geteuid() == 0) flags.emplace_back("--no-sandbox");  // it does not start otherwise
  flags.push_back("file://" + (folder / "report.html").string());
  return flags;
}

}  // namespace

fs::path require_chromium() {
  const char* path = std::getenv("PATH");
  for (const char* name : {"chromium", "chromium-browser", "google-chrome"}) {
    std::istringstream folders(path != nullptr ? path : "");
    for (std::string folder; std::getline(folders, folder, ':');)
      if (const fs::path program = fs::path(folder) / name; ::access(program.c_str(), X_OK) == 0) return program;
  }
  throw IoError({.what = "report.pdf is printed by Chromium, which is not installed",
                 .where = "--report-pdf",
                 .value = {},
                 .limit = {},
                 .advice = "apt-get install chromium, or print report.html"});
}

std::string printed_as_pdf(const std::string& page) {
  const WorkFolder folder;
  std::ofstream(folder / "report.html", std::ios::binary) << page;
  constexpr std::chrono::seconds limit(60);
  const bool done = run_silently(require_chromium(), flags_of_chromium(folder), limit);
  std::ifstream stream(folder / "report.pdf", std::ios::binary);
  std::string pdf{std::istreambuf_iterator<char>(stream), {}};
  if (!done || !pdf.starts_with("%PDF"))
    throw IoError({.what = "Chromium did not print the report",
                   .where = "--report-pdf",
                   .value = {},
                   .limit = "60 s",
                   .advice = "print report.html"});
  return pdf;
}

}  // namespace scan2fea::command
