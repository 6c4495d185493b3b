#include "preproc/mesh/require_memory.hpp"

#include "preproc/mesh/error.hpp"
#include "preproc/mesh/error_text.hpp"

#include <algorithm>
#include <sys/resource.h>
#include <unistd.h>

namespace scan2fea {
namespace {

double most_bytes() {
  const double machine = static_cast<double>(sysconf(_SC_PHYS_PAGES)) * static_cast<double>(sysconf(_SC_PAGESIZE));
  rlimit own{};
  if (getrlimit(RLIMIT_AS, &own) != 0 || own.rlim_cur == RLIM_INFINITY) return machine;
  return std::min(machine, static_cast<double>(own.rlim_cur));
}

}  // namespace

void require_memory(double count, double bytes_each, const std::string& elements, const std::string& advice) {
  const double most = most_bytes();
  if (count * bytes_each <= most) return;
  throw NotMeshable({.what = "about " + error_text(count, 3) + " " + elements + " do not fit into the memory",
                     .where = {},
                     .value = error_text(count * bytes_each / 1e9, 3) + " GB",
                     .limit = error_text(most / 1e9, 3) + " GB",
                     .advice = advice});
}

}  // namespace scan2fea
