// The error that a call ends in, for tests of what it says.
#pragma once

#include "preproc/mesh/error.hpp"

#include <gtest/gtest.h>

#include <stdexcept>
#include <string_view>

namespace scan2fea {

// The test fails where the call does not, or with another kind of error. A message is one line.
template <class Kind, class Call>
Kind error_from(const Call& call) {
  try {
    call();
  } catch (const Kind& error) {
    EXPECT_EQ(std::string_view(error.what()).find('\n'), std::string_view::npos);
    return error;
  }
  throw std::logic_error("the call has not failed");
}

}  // namespace scan2fea
