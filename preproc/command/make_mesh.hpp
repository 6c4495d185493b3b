// What run, surface, reconstruct, repair, enrich, simplify and tetrahedralize have in common: read, work, measure,
// gate, write.
#pragma once

#include "preproc/bodies/body_complex.hpp"
#include "preproc/command/flags.hpp"
#include "preproc/command/written_file_flags.hpp"

namespace scan2fea::command {

// Whether the input may be a point cloud, or is one even where it has faces.
enum class TakesClouds { no, too, only };

struct MakeMeshJob {
  CommonFlags common;
  std::filesystem::path output;
  SizeFlags size;
  FeatureFileFlags features;
  std::vector<std::string> sets;       // NAME=EXPRESSION
  const CLI::App* declared = nullptr;  // the sub-command, where options of it may not count
  PipelineOptions pipeline;
  std::optional<double> time_limit;  // of the whole command, seconds
  TakesClouds takes_clouds = TakesClouds::no;
  bool enrich = false;  // --enrich of the commands in which that stage is a choice
  EnrichOptions enrich_options;
  std::string enrich_domain;                       // an expression; empty: everywhere
  std::vector<std::filesystem::path> more_bodies;  // besides the input, which then is one, too
  JoinOptions joining;                             // of several bodies
  bool one_body = false;                           // whatever groups the input has
  std::optional<std::size_t> largest_scan;         // triangles; larger ones are thinned. Without, none is
  std::optional<DeckKind> deck;
  std::size_t parts = 0;  // of a volume mesh; 0: it is not divided
  MshVersion msh_version = MshVersion::v4_1;
  NumberFlags numbering;
};

// Input, output, reports, and all flags of the surface stages, for the commands that run them one after the other.
void add_surface_flags(CLI::App& command, MakeMeshJob& job);

// Returns the command's exit status: 0, or 1 if a gate failed, and then nothing is written but the report.
int make_mesh(MakeMeshJob job);

}  // namespace scan2fea::command
