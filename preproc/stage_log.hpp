// Times stages, says when one begins, and hands their records on.
#pragma once

#include "preproc/pipeline.hpp"

#include <cstdint>
#include <string>
#include <vector>

namespace scan2fea {

class StageLog {
 public:
  StageLog(std::vector<StageRecord>& records, const StageListener& listener, const Progress& progress)
      : records_(records), listener_(listener), progress_(progress) {}

  template <class Work>
  void run(const std::string& name, Work work) {
    const auto start = begin();
    progress_.begin(name);
    StageRecord record;
    record.name = name;
    work(record);
    end(std::move(record), start);
  }

 private:
  static Progress::Clock::time_point begin();
  void end(StageRecord record, Progress::Clock::time_point start);

  std::vector<StageRecord>& records_;
  const StageListener& listener_;
  const Progress& progress_;
};

}  // namespace scan2fea
