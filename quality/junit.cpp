#include "quality/junit.hpp"

#include "preproc/mesh/error_text.hpp"
#include "quality/escaped.hpp"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <charconv>

namespace scan2fea {
namespace {

// How many bytes of UTF-8 start here, or 0 where they are none, or a character that XML has not.
std::size_t character_at(const std::string& text, std::size_t i) {
  const auto byte = [&](std::size_t k) { return k < text.size() ? static_cast<unsigned char>(text[k]) : 0U; };
  const unsigned first = byte(i);
  if (first < 0x80) return first >= 0x20 || first == '\t' || first == '\n' ? 1 : 0;
  const std::size_t length = first >= 0xF0 && first < 0xF5 ? 4 : first >= 0xE0 ? 3 : 2;
  if (first < 0xC2 || first >= 0xF5) return 0;
  unsigned code = first & (0x7FU >> length);
  for (std::size_t k = 1; k < length; ++k) {
    if ((byte(i + k) & 0xC0U) != 0x80U) return 0;
    code = code << 6U | (byte(i + k) & 0x3FU);
  }
  constexpr unsigned least[] = {0, 0, 0x80, 0x800, 0x10000};
  const bool is_surrogate = code >= 0xD800 && code < 0xE000;
  return code < least[length] || code > 0x10FFFF || is_surrogate || code == 0xFFFE || code == 0xFFFF ? 0 : length;
}

// In XML, where what is no character of it is a question mark, and what would end a line a space.
std::string xml_of(const std::string& text) {
  std::string out;
  for (std::size_t i = 0; i < text.size();) {
    const std::size_t length = character_at(text, i);
    const char c = text[i];
    if (length == 0)
      out += '?';
    else if (c == '\n' || c == '\t')
      out += ' ';
    else
      out += text.substr(i, length);
    i += std::max(length, std::size_t{1});
  }
  return escaped(out);
}

std::string attribute(const char* name, const std::string& value) {
  return std::string(" ") + name + "=\"" + xml_of(value) + "\"";
}

std::string place_text(const Json& place) {
  return error_text(Vec3(place[0].get<double>(), place[1].get<double>(), place[2].get<double>()));
}

// As it was measured, so that what fails by the last digit does not look as if it passed.
std::string number_text(const Json& number) {
  char digits[32];
  char* const end = std::to_chars(digits, digits + sizeof digits, number.get<double>()).ptr;
  return {digits, end};
}

std::string limit_text(const Json& gate) {
  return gate["operator"].get<std::string>() + " " + number_text(gate["limit"]);
}

std::string value_text(const Json& gate) {
  if (gate["value"].is_null()) return "no value, since " + gate.value("reason", "there is none");
  return number_text(gate["value"]);
}

std::string outcome(const Json& gate) {
  std::string text = gate["name"].get<std::string>() + " is " + value_text(gate) + ", limit " + limit_text(gate);
  if (gate.contains("element")) text += ", element " + gate["element"].dump();
  if (gate.contains("place")) text += ", at " + place_text(gate["place"]);
  return text;
}

std::string test_case(const Json& gate, const std::string& class_name, const std::string& file) {
  std::string name = gate["name"].get<std::string>() + " " + limit_text(gate);
  if (gate.contains("set")) name += " (" + gate["set"].get<std::string>() + ")";
  std::string text = "    <testcase" + attribute("name", name) + attribute("classname", class_name) +
                     attribute("file", file) + " time=\"0\">\n";
  const std::string source = gate.contains("source") ? "\nsource: " + xml_of(gate["source"].get<std::string>()) : "";
  if (gate["pass"].get<bool>())
    text += "      <system-out>" + xml_of(outcome(gate)) + source + "</system-out>\n";
  else
    text += "      <failure type=\"gate\"" + attribute("message", outcome(gate)) + ">" + xml_of(outcome(gate)) +
            source + "</failure>\n";
  return text + "    </testcase>\n";
}

}  // namespace

std::string junit_text(const Json& report, const std::string& file) {
  const Json& gates = report["gates"];
  const auto failed = std::ranges::count_if(gates, [](const Json& gate) { return !gate["pass"].get<bool>(); });
  const std::string counts = attribute("tests", std::to_string(gates.size())) +
                             attribute("failures", std::to_string(failed)) + " errors=\"0\" skipped=\"0\" time=\"0\"";
  // Jenkins takes what is before the last point for a package: the file's own would split it.
  std::string class_name = file.substr(file.find_last_of('/') + 1);
  std::ranges::replace(class_name, '.', '_');
  std::string text = "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<testsuites name=\"scan2fea\"" + counts + ">\n" +
                     "  <testsuite" + attribute("name", file) + counts + ">\n";
  for (const Json& gate : gates) text += test_case(gate, "scan2fea." + class_name, file);
  return text + "  </testsuite>\n</testsuites>\n";
}

}  // namespace scan2fea
