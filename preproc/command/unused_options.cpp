#include "preproc/command/unused_options.hpp"

#include "preproc/command/option_text.hpp"
#include "preproc/mesh/joined.hpp"

namespace scan2fea::command {

std::vector<std::string> unused_options(const MakeMeshJob& job, const ReadInputs& inputs) {
  std::vector<std::string> list;
  if (job.declared == nullptr) return list;
  const auto tell = [&](const char* why, const char* group, const char* but) {
    std::vector<std::string> given = given_in_group(*job.declared, group);
    std::erase(given, but);
    if (!given.empty()) list.push_back(std::string("not used, since ") + why + ": " + joined(given));
  };
  if (std::holds_alternative<SurfaceMesh>(inputs.scan)) tell("the input is a surface", clouds_group, "");
  if (!job.enrich) tell("there is no --enrich", enrichment_group, "");
  if (inputs.bodies.empty()) tell("there is one body", bodies_group, "--one-body");
  return list;
}

}  // namespace scan2fea::command
