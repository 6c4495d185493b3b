#include "export/run_metis.hpp"

#include "preproc/mesh/error.hpp"

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <fcntl.h>
#include <limits>
#include <metis.h>
#include <string>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

namespace scan2fea {
namespace {

static_assert(sizeof(idx_t) == sizeof(std::int32_t), "graphs have METIS's numbers of 32 bits");

[[noreturn]] void fail(std::string what, std::string value) {
  throw NotMeshable({.what = std::move(what),
                     .where = "--parts",
                     .value = std::move(value),
                     .limit = {},
                     .advice = "more memory, or a single file, which the solver divides itself"});
}

// Memory that a child writes into and its parent reads.
class SharedNumbers {
 public:
  explicit SharedNumbers(std::size_t count) : bytes_(count * sizeof(idx_t)) {
    memory_ = ::mmap(nullptr, bytes_, PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
    if (memory_ == MAP_FAILED) fail("there is no memory for the parts of the mesh", std::strerror(errno));
  }
  ~SharedNumbers() { ::munmap(memory_, bytes_); }
  SharedNumbers(const SharedNumbers&) = delete;
  SharedNumbers& operator=(const SharedNumbers&) = delete;

  idx_t* data() { return static_cast<idx_t*>(memory_); }

 private:
  std::size_t bytes_;
  void* memory_ = nullptr;
};

// An interrupt ends the child at once, and neither speaks nor cleans up for its parent, as its handlers would. Whoever
// kills the parent kills the child, also where that was before this line.
void be_a_child_of(pid_t parent) {
  for (const int signal : {SIGINT, SIGTERM, SIGHUP, SIGALRM}) std::signal(signal, SIG_DFL);
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (::getppid() != parent) ::_exit(1);
  const int nowhere = ::open("/dev/null", O_WRONLY);
  for (const int stream : {STDOUT_FILENO, STDERR_FILENO}) ::dup2(nowhere, stream);
}

int call_metis(Graph& graph, idx_t parts, bool contiguous, idx_t* part) {
  idx_t vertices = graph.size(), constraints = 1, cut = 0;
  idx_t options[METIS_NOPTIONS];
  METIS_SetDefaultOptions(options);
  options[METIS_OPTION_CONTIG] = contiguous ? 1 : 0;
  options[METIS_OPTION_SEED] = 1;
  return METIS_PartGraphKway(&vertices, &constraints, graph.first.data(), graph.neighbours.data(), nullptr, nullptr,
                             nullptr, &parts, nullptr, nullptr, options, &cut, part);
}

}  // namespace

std::uint64_t largest_metis_number() {
  return static_cast<std::uint64_t>(std::numeric_limits<idx_t>::max());
}

// A child by fork alone: METIS needs no more than memory, which the C library lets a child of several threads have.
std::vector<std::uint32_t> run_metis(Graph& graph, std::int32_t parts, bool contiguous) {
  const auto count = static_cast<std::size_t>(graph.size());
  SharedNumbers part(count);
  const pid_t parent = ::getpid(), child = ::fork();
  if (child < 0) fail("no process can be started for METIS", std::strerror(errno));
  if (child == 0) {
    be_a_child_of(parent);
    ::_exit(call_metis(graph, parts, contiguous, part.data()) == METIS_OK ? 0 : 1);
  }
  int status = 0;
  while (::waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  if (!WIFEXITED(status) || WEXITSTATUS(status) != 0)
    fail("METIS, which divides the mesh, failed", WIFSIGNALED(status)
                                                      ? "signal " + std::to_string(WTERMSIG(status))
                                                      : "status " + std::to_string(WEXITSTATUS(status)));
  std::vector<std::uint32_t> result(count);
  std::transform(part.data(), part.data() + count, result.begin(),
                 [](idx_t p) { return static_cast<std::uint32_t>(p); });
  return result;
}

}  // namespace scan2fea
