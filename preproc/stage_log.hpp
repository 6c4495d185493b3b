// Times stages, and hands their records on.
#pragma once

#include "preproc/pipeline.hpp"

#include <cstdint>
#include <string>
#include <vector>

namespace scan2fea {

class StageLog {
 public:
  StageLog(std::vector<StageRecord>& records, const StageListener& listener) : records_(records), listener_(listener) {}

  template <class Work>
  void run(const std::string& name, Work work) {
    const auto start = begin();
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
};

}  // namespace scan2fea
