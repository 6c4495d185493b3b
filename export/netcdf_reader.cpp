#include "export/netcdf.hpp"
#include "preproc/mesh/byte_order.hpp"

#include <algorithm>
#include <array>

namespace scan2fea {
namespace {

constexpr std::int32_t tag_dimension = 10, tag_variable = 11, tag_attribute = 12;

// Of the types 1 to 6 of all versions, and 7 to 11 of CDF-5; 0 for none of them.
std::uint64_t size_of_type(std::int32_t type) {
  constexpr std::array<std::uint64_t, 12> sizes{0, 1, 1, 2, 4, 4, 8, 1, 2, 4, 8, 8};
  return type < 1 || type > 11 ? 0 : sizes[static_cast<std::size_t>(type)];
}

constexpr std::int32_t type_char = 2, type_float = 5, type_double = 6;

}  // namespace

// Reads the header from front to back. Numbers of sizes and counts have 32 bits, in CDF-5 64.
class NetcdfReader::Header {
 public:
  Header(const InputFile& file, NetcdfReader& reader) : file_(file), reader_(reader) {}

  void read() {
    const std::string_view magic = take(4);
    if (magic.starts_with("\x89HDF"))
      file_.fail("netCDF-4, which is HDF5, is not read", {}, "netCDF's classic format", "nccopy -k cdf5 IN OUT");
    if (!magic.starts_with("CDF") || (magic[3] != 1 && magic[3] != 2 && magic[3] != 5))
      file_.fail("the file is not netCDF", {}, {}, "an Exodus file");
    version_ = magic[3];
    size();  // of records
    read_dimensions();
    attributes();
    read_variables();
  }

 private:
  std::string_view take(std::uint64_t bytes) {
    if (bytes > file_.bytes().size() - at_)
      file_.fail("the file ends inside its header", {}, {}, "exporting or copying it again");
    const std::string_view piece = file_.bytes().substr(at_, bytes);
    at_ += bytes;
    return piece;
  }
  template <class T>
  T number() {
    return load<T>(take(sizeof(T)).data(), std::endian::big);
  }
  std::uint64_t size() { return version_ == 5 ? number<std::uint64_t>() : number<std::uint32_t>(); }
  std::string name() {
    const std::uint64_t length = size();
    const std::string text(take(length));
    take((4 - length % 4) % 4);
    return text;
  }
  // Every entry takes more than four bytes, so a count that is larger than the file is none.
  std::uint64_t list(std::int32_t tag) {
    const auto found = number<std::int32_t>();
    const std::uint64_t entries = size();
    if ((found != tag && found != 0) || (found == 0 && entries > 0) || entries > file_.bytes().size() / 4)
      file_.fail("the header of the netCDF file does not hold together");
    return entries;
  }

  void read_dimensions() {
    for (std::uint64_t i = list(tag_dimension); i > 0; --i) {
      std::string text = name();
      sizes_.push_back(size());
      reader_.dimensions_[std::move(text)] = sizes_.back();
    }
  }

  std::map<std::string, std::string> attributes() {
    std::map<std::string, std::string> texts;
    for (std::uint64_t i = list(tag_attribute); i > 0; --i) {
      const std::string key = name();
      const auto type = number<std::int32_t>();
      const std::uint64_t count = size(), each = size_of_type(type);
      if (each == 0 || count > file_.bytes().size() / each) file_.fail("an attribute is not one of netCDF", key);
      const std::string_view bytes = take(count * each);
      take((4 - bytes.size() % 4) % 4);
      if (type == type_char) texts[key] = std::string(bytes.substr(0, bytes.find('\0')));
    }
    return texts;
  }

  void read_variables() {
    for (std::uint64_t i = list(tag_variable); i > 0; --i) {
      std::string key = name();
      Variable variable;
      const std::uint64_t dimensions = size();
      if (dimensions > 8) file_.fail("a variable has too many dimensions", key, "8");  // those of meshes have two
      for (std::uint64_t d = 0; d < dimensions; ++d) {
        const std::uint64_t index = size();
        if (index >= sizes_.size()) file_.fail("a variable has a dimension that is not there", key);
        variable.shape.push_back(sizes_[index]);
        variable.has_records = variable.has_records || sizes_[index] == 0;
      }
      variable.attributes = attributes();
      variable.type = number<std::int32_t>();
      if (size_of_type(variable.type) == 0) file_.fail("a variable is of no type of netCDF", key);
      size();  // in bytes, which may be too large for the field
      variable.begin = version_ == 1 ? number<std::uint32_t>() : number<std::uint64_t>();
      reader_.variables_[std::move(key)] = std::move(variable);
    }
  }

  const InputFile& file_;
  NetcdfReader& reader_;
  std::size_t at_ = 0;
  char version_ = 0;
  std::vector<std::uint64_t> sizes_;  // of dimensions
};

NetcdfReader::NetcdfReader(const InputFile& file) : file_(file) {
  Header(file, *this).read();
}

std::optional<std::uint64_t> NetcdfReader::dimension(const std::string& name) const {
  const auto found = dimensions_.find(name);
  return found == dimensions_.end() ? std::nullopt : std::optional(found->second);
}

std::optional<std::vector<std::uint64_t>> NetcdfReader::shape(const std::string& name) const {
  const auto found = variables_.find(name);
  if (found == variables_.end() || found->second.has_records) return std::nullopt;
  return found->second.shape;
}

std::string NetcdfReader::text_attribute(const std::string& variable, const std::string& name) const {
  const auto found = variables_.find(variable);
  if (found == variables_.end()) return {};
  const auto text = found->second.attributes.find(name);
  return text == found->second.attributes.end() ? std::string() : text->second;
}

const NetcdfReader::Variable& NetcdfReader::at(const std::string& name) const {
  return variables_.at(name);
}

// All of them lie in the file.
std::uint64_t NetcdfReader::values_of(const Variable& variable) const {
  const std::uint64_t bytes = file_.bytes().size(), each = size_of_type(variable.type);
  std::uint64_t values = 1;
  for (const std::uint64_t n : variable.shape) {
    if (n != 0 && values > bytes / n)
      file_.fail("a variable promises more values than the file can hold", {}, {}, "exporting or copying it again");
    values *= n;
  }
  if (variable.begin > bytes || values > (bytes - variable.begin) / each)
    file_.fail("a variable promises more values than the file can hold", std::to_string(values),
               std::to_string(variable.begin > bytes ? 0 : (bytes - variable.begin) / each),
               "exporting or copying it again");
  return values;
}

template <class Take>
void NetcdfReader::each(const Variable& variable, const Take& take) const {
  const char* from = file_.bytes().data() + variable.begin;
  const std::uint64_t size = size_of_type(variable.type);
  for (std::uint64_t i = 0, n = values_of(variable); i < n; ++i, from += size) {
    constexpr std::endian big = std::endian::big;
    switch (variable.type) {
      case 1:
        take(load<std::int8_t>(from, big));
        break;
      case 2:
      case 7:
        take(load<std::uint8_t>(from, big));
        break;
      case 3:
        take(load<std::int16_t>(from, big));
        break;
      case 4:
        take(load<std::int32_t>(from, big));
        break;
      case 5:
        take(load<float>(from, big));
        break;
      case 6:
        take(load<double>(from, big));
        break;
      case 8:
        take(load<std::uint16_t>(from, big));
        break;
      case 9:
        take(load<std::uint32_t>(from, big));
        break;
      case 10:
        take(load<std::int64_t>(from, big));
        break;
      default:
        take(load<std::uint64_t>(from, big));
    }
  }
}

std::vector<double> NetcdfReader::reals(const std::string& name) const {
  const Variable& variable = at(name);
  std::vector<double> values;
  values.reserve(values_of(variable));
  each(variable, [&](auto value) { values.push_back(static_cast<double>(value)); });
  return values;
}

std::vector<std::int64_t> NetcdfReader::integers(const std::string& name) const {
  const Variable& variable = at(name);
  if (variable.type == type_float || variable.type == type_double) file_.fail("not whole numbers", name);
  std::vector<std::int64_t> values;
  values.reserve(values_of(variable));
  each(variable, [&](auto value) { values.push_back(static_cast<std::int64_t>(value)); });
  return values;
}

std::vector<std::string> NetcdfReader::rows(const std::string& name) const {
  const auto found = variables_.find(name);
  if (found == variables_.end() || found->second.has_records || found->second.type != type_char ||
      found->second.shape.size() != 2)
    return {};
  const Variable& variable = found->second;
  values_of(variable);
  std::vector<std::string> texts;
  // Rows without length would be as many as the header likes.
  for (std::uint64_t row = 0; row < variable.shape[0] && variable.shape[1] > 0; ++row) {
    std::string text(file_.bytes().substr(variable.begin + row * variable.shape[1], variable.shape[1]));
    text.resize(std::min(text.find('\0'), text.size()));
    while (!text.empty() && text.back() == ' ') text.pop_back();
    texts.push_back(std::move(text));
  }
  return texts;
}

}  // namespace scan2fea
