// A program of somebody else: a scan becomes a mesh that a solver reads.
#include <scan2fea/export/formats.hpp>
#include <scan2fea/preproc/mesh/read_surface.hpp>
#include <scan2fea/preproc/pipeline.hpp>
#include <scan2fea/version.hpp>

#include <cstdio>

int main(int, char** argv) {
  scan2fea::PipelineOptions options;
  options.simplify->size = scan2fea::FaceCount{1000};
  const auto result = scan2fea::run_pipeline(scan2fea::read_surface(argv[1]), options);
  scan2fea::write_volume(*result.volume_mesh, argv[2]);
  std::printf("scan2fea %s: %zu tetrahedra\n", scan2fea::library_version, result.volume_mesh->tetrahedra.size());
}
