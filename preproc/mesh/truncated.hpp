// Files that end before what they promise.
#pragma once

namespace scan2fea {

inline constexpr const char* truncated_advice = "exporting or copying the scan again";  // what to try

}  // namespace scan2fea
