#include "preproc/command/call.hpp"

#include "export/formats.hpp"
#include "export/surface_files.hpp"
#include "export/units.hpp"
#include "preproc/command/console.hpp"
#include "preproc/command/declared_commands.hpp"
#include "preproc/command/wrong_usage.hpp"
#include "preproc/mesh/error.hpp"
#include "preproc/mesh/length_unit.hpp"
#include "preproc/mesh/read_cloud.hpp"

#include <tbb/task_arena.h>

#include <algorithm>
#include <array>

namespace scan2fea::command {
namespace {

constexpr std::string_view files_group = "What files hold";

std::string keyword_of(const std::string& option) {
  std::string keyword = option.substr(option.find_first_not_of('-'));
  std::ranges::replace(keyword, '-', '_');
  return keyword;
}

const SubCommand& find_command(const std::vector<SubCommand>& commands, const std::string& name) {
  return *std::ranges::find(commands, name, [](const SubCommand& command) { return command.app->get_name(); });
}

// What they ask for would be passed over.
void require_output_for_its_options(const CLI::App& command) {
  const CLI::Option* output = command.get_option_no_throw("--output");
  if (output == nullptr || output->count() > 0) return;
  for (const OptionText& option : options_of(command))
    if (option.group == files_group && option.option->count() > 0)
      throw WrongUsage({.what = "an option of files, and no file to write",
                        .where = command.get_name(),
                        .value = keyword_of(option.names.back()),
                        .limit = {},
                        .advice = "output=, or the same option of write"});
}

std::vector<std::string> command_line(const CLI::App& command, const std::vector<Keyword>& keywords) {
  std::vector<std::string> line{"scan2fea", command.get_name()};
  for (const Keyword& keyword : keywords) {
    std::string name = keyword.name;
    std::ranges::replace(name, '_', '-');
    const CLI::Option* option = command.get_option_no_throw("--" + name);
    for (const std::vector<std::string>& at_a_time : keyword.values) {
      if (option != nullptr && option->get_expected_max() == 0) {
        line.push_back("--" + name + (at_a_time.front() == "true" ? "" : "=" + at_a_time.front()));
        continue;
      }
      if (option != nullptr) line.push_back("--" + name);
      line.insert(line.end(), at_a_time.begin(), at_a_time.end());
    }
  }
  return line;
}

}  // namespace

int call(const std::string& name, const std::vector<Keyword>& keywords, Caller& caller) {
  CLI::App root;
  const std::vector<SubCommand> commands = declare_commands(root);
  const SubCommand& command = find_command(commands, name);
  command.flags->caller = &caller;
  apply_keywords(*command.app, keywords);
  require_output_for_its_options(*command.app);
  caller.arguments = command_line(*command.app, keywords);
  const CLI::Option* threads = command.app->get_option_no_throw("--threads");
  const int count = threads != nullptr && threads->count() > 0 ? threads->as<int>() : 0;
  if (count <= 0) return command.execute();
  // Of this call alone: others of the process may be on.
  return tbb::task_arena(count).execute([&] { return command.execute(); });
}

std::vector<CallOption> options_of_call(const std::string& name) {
  CLI::App root;
  const std::vector<SubCommand> commands = declare_commands(root);
  std::vector<CallOption> options;
  for (const OptionText& option : options_of(*find_command(commands, name).app)) {
    const std::string keyword = keyword_of(option.names.back());
    if (option.is_positional || keyword == "reference" || !is_keyword(*option.option)) continue;
    options.push_back({.name = keyword_of(option.value.empty() ? option.names.front() : option.names.back()),
                       .value = option.value,
                       .text = option.text,
                       .default_value = option.default_value,
                       .group = option.group,
                       .choices = option.choices,
                       .is_repeatable = option.is_repeatable,
                       .at_a_time = std::max(1, option.option->get_type_size_max())});
  }
  return options;
}

SharedMesh read_into_memory(const std::filesystem::path& file, const std::string& unit) {
  MemoryMesh mesh{.held = MeshFile(), .name = file, .first_element = first_element_of(file)};
  MeshFile read;
  const FileFormat* format = find_format(file);
  if (format != nullptr && format->read != read_plain_surface) {
    read = read_mesh(file);
  } else {
    NamedScan scan = read_named_scan(file);
    if (auto* cloud = std::get_if<PointCloud>(&scan)) {
      mesh.held = std::move(*cloud);
      return std::make_shared<MemoryMesh>(std::move(mesh));
    }
    read.mesh = std::get<NamedSurface>(std::move(scan));
  }
  for (const std::string& warning : read.warnings) warn(file.string() + ": " + warning);
  const std::optional<std::string> given = unit.empty() ? std::nullopt : length_unit(unit);
  if (!unit.empty() && !given)
    throw WrongUsage({.what = "unknown unit of length",
                      .where = "unit",
                      .value = unit,
                      .limit = {},
                      .advice = std::string(known_length_units)});
  std::visit([&](auto& held) { held.unit = settled_unit(held.unit, given, file.string()); }, read.mesh);
  mesh.held = std::move(read);
  return std::make_shared<MemoryMesh>(std::move(mesh));
}

}  // namespace scan2fea::command
