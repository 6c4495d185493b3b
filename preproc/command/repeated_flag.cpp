#include "preproc/command/repeated_flag.hpp"

#include "preproc/mesh/error_text.hpp"

#include <cmath>
#include <vector>

namespace scan2fea::command {

CLI::Option* add_repeated(CLI::App& command, const char* name, int numbers, const char* type, const char* help,
                          const std::function<void(const double*)>& take) {
  return command
      .add_option_function<std::vector<double>>(
          name,
          [take, numbers, name](const std::vector<double>& values) {
            for (const double value : values)
              if (!std::isfinite(value)) throw CLI::ValidationError(name, "'" + error_text(value) + "' is no number");
            for (std::size_t i = 0; i < values.size(); i += static_cast<std::size_t>(numbers)) take(values.data() + i);
          },
          help)
      ->type_size(numbers)
      ->expected(1, CLI::detail::expected_max_vector_size)
      ->allow_extra_args(false)
      ->type_name(type);
}

}  // namespace scan2fea::command
