#include "quality/report_page/page_parts.hpp"

#include "quality/taken_in.hpp"

SCAN2FEA_TAKE_IN(page_template, SCAN2FEA_PAGE_TEMPLATE);
SCAN2FEA_TAKE_IN(page_style, SCAN2FEA_PAGE_STYLE);
SCAN2FEA_TAKE_IN(page_script, SCAN2FEA_PAGE_SCRIPT);

namespace scan2fea {

std::string_view page_template() {
  return {scan2fea_page_template, static_cast<std::size_t>(scan2fea_page_template_end - scan2fea_page_template)};
}

std::string_view page_style() {
  return {scan2fea_page_style, static_cast<std::size_t>(scan2fea_page_style_end - scan2fea_page_style)};
}

std::string_view page_script() {
  return {scan2fea_page_script, static_cast<std::size_t>(scan2fea_page_script_end - scan2fea_page_script)};
}

}  // namespace scan2fea
