// Any bytes are options of a command, or an error that names the place. The command of this target has an option of
// each kind that the real ones have.
#include "preproc/command/configuration.hpp"
#include "tests/fuzz/finding.hpp"
#include "tests/fuzz/input_on_disk.hpp"

#include <CLI/CLI.hpp>

#include <optional>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace scan2fea;
  CLI::App root;
  CLI::App* run = root.add_subcommand("run");
  CLI::App* check = root.add_subcommand("check");
  std::optional<std::size_t> faces;
  std::optional<double> length;
  std::string method;
  std::vector<std::string> gates;
  bool quiet = false;
  CLI::Option* by_faces = run->add_option("--faces", faces)->check(CLI::PositiveNumber);
  run->add_option("--edge-length", length)->excludes(by_faces);
  run->add_option("--method", method)->check(CLI::IsMember({"lattice", "collapse"}));
  run->add_option("--require", gates)->allow_extra_args(false);
  run->add_flag("--quiet", quiet);
  check->add_option("--reference", method);
  try {
    command::apply_configuration(root, *run, fuzz::input_on_disk("part.toml", data, size));
  } catch (const InvalidInput& error) {
    fuzz::require_told(error);
  } catch (const WrongUsage& error) {
    fuzz::require_told(error);
  }
  return 0;
}
