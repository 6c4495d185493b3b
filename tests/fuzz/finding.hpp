// How a fuzz target says that what it ran is wrong: libFuzzer keeps the input of a process that aborts.
#pragma once

#include "preproc/mesh/error.hpp"

#include <cstdio>
#include <cstdlib>
#include <string>

namespace scan2fea::fuzz {

[[noreturn]] inline void fail(const std::string& finding) {
  std::fprintf(stderr, "finding: %s\n", finding.c_str());
  std::abort();
}

inline void require(bool holds, const char* what) {
  if (!holds) fail(what);
}

// An error that is of no use to whoever reads it is a finding, too.
inline void require_told(const Error& error) {
  if (error.parts().what.empty() || error.parts().where.empty())
    fail(std::string("an error without what or where: ") + error.what());
  require(std::string(error.what()).find('\n') == std::string::npos, "an error takes more than a line");
}

}  // namespace scan2fea::fuzz
