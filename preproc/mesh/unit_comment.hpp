// The unit of length in a comment: in the header of formats that have no field for it.
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace scan2fea {

// "unit of length: mm", to stand behind the format's mark of a comment.
std::string unit_comment(std::string_view unit);

// The unit in a line that holds such a comment.
std::optional<std::string> unit_in_comment(std::string_view line);

}  // namespace scan2fea
