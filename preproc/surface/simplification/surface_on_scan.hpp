// What a surface was made of, for who wants to fit more of it.
#pragma once

#include "preproc/surface/features/feature_net.hpp"
#include "preproc/surface/simplification/prepared_scan.hpp"

namespace scan2fea {

struct SurfaceOnScan {
  PreparedScanPointer scan;  // with the creases that the surface keeps
  FeatureNet net;
};

}  // namespace scan2fea
