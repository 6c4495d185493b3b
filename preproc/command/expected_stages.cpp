#include "preproc/command/expected_stages.hpp"

#include <algorithm>
#include <system_error>

namespace scan2fea::command {
namespace {

// Seconds on two threads, from the Horse, the bunny, fandisk and the bracket, within a factor of three. Of a triangle
// or point of the scan, of a triangle of the result, of a tetrahedron, or in all.
constexpr double read_byte = 2e-8;
constexpr double reconstruct_point = 1.5e-4, repair_triangle = 3e-6, enrich_triangle = 2e-4, faces_triangle = 5e-5,
                 join_triangle = 2e-5;
constexpr double simplify_scan_triangle = 3e-6, simplify_triangle = 1.2e-4, searched_triangle = 2.5e-4;
constexpr double fill_tetrahedron = 2e-5, curve_tetrahedron = 6e-5;
constexpr double measure_scan_triangle = 3e-6, measure_triangle = 4e-5, elements_triangle = 8e-5,
                 report_triangle = 5e-6, report_alone = 1;
constexpr double write_tetrahedron = 2e-6;

// Of what is not known before it is made: how many triangles keep to the default deviation, over the scan's, and how
// many bytes a triangle has in a file.
constexpr double of_scan_by_deviation = 0.2, most_by_deviation = 50000, file_bytes_a_triangle = 45;
constexpr double tetrahedra_a_triangle = 4;

double bytes_of(const std::filesystem::path& file) {
  std::error_code error;
  const std::uintmax_t bytes = std::filesystem::file_size(file, error);
  return error ? 0 : static_cast<double>(bytes);
}

double wanted_triangles(const MakeMeshJob& job, const ExpectedWork& work) {
  if (work.triangles) return *work.triangles;
  if (!job.pipeline.simplify) return work.scan_triangles;
  if (job.size.faces) return static_cast<double>(*job.size.faces);
  if (job.size.ratio) return *job.size.ratio * work.scan_triangles;
  return std::min(of_scan_by_deviation * work.scan_triangles, most_by_deviation);
}

double of_effort(const MakeMeshJob& job) {
  const Effort effort = job.pipeline.simplify ? job.pipeline.simplify->effort : Effort::normal;
  return effort == Effort::low ? 0.7 : effort == Effort::high ? 5 : 1;
}

void add_surface_stages(const MakeMeshJob& job, const ExpectedWork& work, double triangles,
                        std::vector<ExpectedStage>& stages) {
  const PipelineOptions& options = job.pipeline;
  const double scan = work.scan_triangles;
  if (work.is_cloud) stages.push_back({"reconstruct", reconstruct_point * scan});
  if (options.repair) stages.push_back({"repair", repair_triangle * scan});
  if (options.enrich || job.enrich) stages.push_back({"enrich", enrich_triangle * scan});
  if (work.is_of_bodies) stages.push_back({"contact", join_triangle * scan});
  if (!job.sets.empty() || options.name_faces || options.idealise) stages.push_back({"faces", faces_triangle * scan});
  if (options.symmetry) stages.push_back({"symmetry", faces_triangle * scan});
  const double a_triangle =
      job.size.target().index() == SizeFlags{}.target().index() ? searched_triangle : simplify_triangle;
  if (options.simplify)
    stages.push_back({"simplify", of_effort(job) * (simplify_scan_triangle * scan + a_triangle * triangles)});
  if (options.symmetry) stages.push_back({"mirror", 0.01});
  if (work.is_of_bodies) stages.push_back({"interfaces", 0.2});
}

}  // namespace

ExpectedWork expected_work(const MakeMeshJob& job) {
  double bytes = bytes_of(job.common.input);
  for (const std::filesystem::path& more : job.more_bodies) bytes += bytes_of(more);
  return {.scan_triangles = bytes / file_bytes_a_triangle};
}

std::vector<ExpectedStage> expected_stages(const MakeMeshJob& job, const ExpectedWork& work) {
  const double triangles = wanted_triangles(job, work), tetrahedra = tetrahedra_a_triangle * triangles;
  std::vector<ExpectedStage> stages{{"read", read_byte * file_bytes_a_triangle * work.scan_triangles}};
  if (!work.triangles) add_surface_stages(job, work, triangles, stages);
  if (job.pipeline.tetrahedralize) stages.push_back({"tetrahedralize", fill_tetrahedron * tetrahedra});
  if (job.pipeline.slide) stages.push_back({"slide", fill_tetrahedron * tetrahedra});
  if (!job.pipeline.layers.empty()) stages.push_back({"layers", fill_tetrahedron * tetrahedra});
  if (job.pipeline.tetrahedralize && job.pipeline.order == 2)
    stages.push_back({"second order", curve_tetrahedron * tetrahedra});
  stages.push_back({"write", write_tetrahedron * tetrahedra});
  const double a_triangle = measure_triangle + (job.common.json || job.common.report ? elements_triangle : 0);
  stages.push_back({"measure", measure_scan_triangle * work.scan_triangles + a_triangle * triangles});
  if (job.common.report)
    stages.push_back({"report", report_alone + report_triangle * (work.scan_triangles + triangles)});
  return stages;
}

std::vector<ExpectedStage> expected_faces(double scan_triangles) {
  return {{"repair", repair_triangle * scan_triangles}, {"faces", faces_triangle * scan_triangles}};
}

std::vector<ExpectedStage> expected_measuring(const std::vector<std::filesystem::path>& files,
                                              const CommonFlags& flags) {
  double bytes = 0;
  for (const std::filesystem::path& file : files) bytes += bytes_of(file);
  const double triangles = bytes / file_bytes_a_triangle;
  std::vector<ExpectedStage> stages{{"read", read_byte * bytes}, {"measure", measure_triangle * triangles}};
  if (flags.report) stages.push_back({"report", report_alone + report_triangle * triangles});
  return stages;
}

}  // namespace scan2fea::command
