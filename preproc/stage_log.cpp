#include "preproc/stage_log.hpp"

#include <chrono>
#include <cstdio>
#include <fstream>
#include <utility>

namespace scan2fea {
namespace {

// Linux keeps a high-water mark of resident memory that can be set back, which gives each stage its own peak.
void restart_peak_memory() {
  std::ofstream("/proc/self/clear_refs") << 5;
}

std::uint64_t peak_memory_bytes() {
  std::ifstream status("/proc/self/status");
  for (std::string line; std::getline(status, line);) {
    unsigned long long kilobytes = 0;
    if (std::sscanf(line.c_str(), "VmHWM: %llu kB", &kilobytes) == 1) return kilobytes * 1024;
  }
  return 0;
}

}  // namespace

Progress::Clock::time_point StageLog::begin() {
  restart_peak_memory();
  return Progress::Clock::now();
}

void StageLog::end(StageRecord record, Progress::Clock::time_point start) {
  record.seconds = std::chrono::duration<double>(Progress::Clock::now() - start).count();
  record.peak_bytes = peak_memory_bytes();
  records_.push_back(std::move(record));
  if (listener_) listener_(records_.back());
}

}  // namespace scan2fea
