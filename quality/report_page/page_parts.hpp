// The page's frame, its style and its script, as they were when this was built.
#pragma once

#include <string_view>

namespace scan2fea {

std::string_view page_template();  // HTML with {{NAME}} where something is to be put
std::string_view page_style();
std::string_view page_script();  // with the libraries that it uses; holds no "</script"

}  // namespace scan2fea
