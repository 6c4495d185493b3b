// What a stage tells of its result: figures, which gates can name, and remarks for people.
#pragma once

#include "preproc/add_layers.hpp"
#include "preproc/pipeline.hpp"
#include "preproc/second_order.hpp"
#include "preproc/slide_boundary.hpp"
#include "preproc/surface/kernel/canonical_frame.hpp"
#include "preproc/symmetry/half_scan.hpp"
#include "preproc/tetrahedra_search.hpp"

#include <optional>

namespace scan2fea {

// Of what is made in another frame, places and lengths in the scan's.
class InScan {
 public:
  // `mirror`: where the scan is the half of another one; null where it is not.
  InScan(const std::optional<CanonicalFrame>& frame, const MirrorFrame* mirror) : frame_(frame), mirror_(mirror) {}
  Vec3 place(const Vec3& p) const {
    const Vec3 in_scan = frame_ ? frame_->place_of(p) : p;
    return mirror_ ? mirror_->from_frame(in_scan) : in_scan;
  }
  double unit() const { return frame_ ? frame_->unit() : 1; }

 private:
  const std::optional<CanonicalFrame>& frame_;
  const MirrorFrame* mirror_;
};

// Each fills the record's figures and texts.
void describe(const ReconstructResult& result, StageRecord& record);
void describe(const RepairResult& result, StageRecord& record);
void describe(const EnrichResult& result, StageRecord& record);
void describe(const MirrorPlane& plane, StageRecord& record);
void describe(const SimplifyResult& result, const InScan& in_scan, StageRecord& record);
void describe(const TetrahedralizeResult& result, const InScan& in_scan, StageRecord& record);
void describe(const RenewalResult& renewal, const InScan& in_scan, StageRecord& record);
void describe(const SlideResult& slid, const InScan& in_scan, StageRecord& record);
void describe(const LayersResult& layers, const InScan& in_scan, StageRecord& record);
void describe(const SecondOrderResult& result, const InScan& in_scan, StageRecord& record);

}  // namespace scan2fea
