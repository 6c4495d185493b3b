// Text in XML and HTML.
#pragma once

#include <string>
#include <string_view>

namespace scan2fea {

// For content and for values in double quotes.
std::string escaped(std::string_view text);

}  // namespace scan2fea
