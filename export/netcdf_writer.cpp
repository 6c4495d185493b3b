#include "export/netcdf.hpp"
#include "preproc/mesh/byte_order.hpp"
#include "preproc/mesh/error.hpp"

#include <numeric>

namespace scan2fea {
namespace {

constexpr std::int32_t tag_dimension = 10, tag_variable = 11, tag_attribute = 12;
constexpr std::int32_t type_char = 2, type_int = 4, type_float = 5, type_double = 6;

template <class T>
void put(std::string& out, T value) {
  char bytes[sizeof(T)];
  store(value, bytes, std::endian::big);
  out.append(bytes, sizeof(T));
}

void pad(std::string& out) {
  out.append((4 - out.size() % 4) % 4, '\0');
}

void put_name(std::string& out, const std::string& name) {
  put(out, static_cast<std::int32_t>(name.size()));
  out += name;
  pad(out);
}

// A list that is absent has neither tag nor entries.
void put_list(std::string& out, std::int32_t tag, std::size_t entries) {
  put(out, entries == 0 ? 0 : tag);
  put(out, static_cast<std::int32_t>(entries));
}

void put_attributes(std::string& out, const std::vector<NetcdfWriter::Attribute>& attributes) {
  put_list(out, tag_attribute, attributes.size());
  for (const auto& [name, value] : attributes) {
    put_name(out, name);
    if (const auto* text = std::get_if<std::string>(&value)) {
      put(out, type_char);
      put_name(out, *text);  // its length, and padded as names are
    } else if (const auto* number = std::get_if<std::int32_t>(&value)) {
      put(out, type_int);
      put(out, std::int32_t{1});
      put(out, *number);
    } else {
      put(out, type_float);
      put(out, std::int32_t{1});
      put(out, std::get<float>(value));
    }
  }
}

std::int32_t type_of(const NetcdfWriter::Data& data) {
  if (std::holds_alternative<std::string>(data)) return type_char;
  return std::holds_alternative<std::vector<double>>(data) ? type_double : type_int;
}

std::uint64_t bytes_of(const NetcdfWriter::Data& data) {
  const std::size_t size = std::holds_alternative<std::string>(data) ? 1 : type_of(data) == type_double ? 8 : 4;
  const std::uint64_t count = std::visit([](const auto& values) { return values.size(); }, data);
  return (count * size + 3) / 4 * 4;
}

// By pieces, so that what is written is not twice in memory.
template <class T>
void write_values(std::ostream& stream, const std::vector<T>& values) {
  constexpr std::size_t piece = 1 << 16;
  std::string bytes;
  for (std::size_t i = 0; i < values.size(); ++i) {
    put(bytes, values[i]);
    if (bytes.size() < piece && i + 1 < values.size()) continue;
    stream.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
    bytes.clear();
  }
}

}  // namespace

std::size_t NetcdfWriter::dimension(std::string name, std::size_t size) {
  dimensions_.emplace_back(std::move(name), size);
  return dimensions_.size() - 1;
}

void NetcdfWriter::variable(std::string name, std::vector<std::size_t> dimensions, Data data,
                            std::vector<Attribute> attributes) {
  variables_.push_back({std::move(name), std::move(dimensions), std::move(data), std::move(attributes)});
}

bool NetcdfWriter::has_records(const Variable& variable) const {
  return !variable.dimensions.empty() && dimensions_[variable.dimensions[0]].second == 0;
}

std::string NetcdfWriter::header(const std::vector<std::uint64_t>& begins) const {
  std::string out = "CDF\x02";
  put(out, std::int32_t{0});  // records
  put_list(out, tag_dimension, dimensions_.size());
  for (const auto& [name, size] : dimensions_) {
    put_name(out, name);
    put(out, static_cast<std::int32_t>(size));
  }
  put_attributes(out, attributes_);
  put_list(out, tag_variable, variables_.size());
  for (std::size_t v = 0; v < variables_.size(); ++v) {
    const Variable& variable = variables_[v];
    put_name(out, variable.name);
    put(out, static_cast<std::int32_t>(variable.dimensions.size()));
    for (const std::size_t d : variable.dimensions) put(out, static_cast<std::int32_t>(d));
    put_attributes(out, variable.attributes);
    put(out, type_of(variable.data));
    put(out, static_cast<std::uint32_t>(has_records(variable) ? (type_of(variable.data) == type_double ? 8 : 4)
                                                              : bytes_of(variable.data)));
    put(out, begins[v]);
  }
  return out;
}

void NetcdfWriter::write(std::ostream& stream) const {
  constexpr std::uint64_t largest = (std::uint64_t{1} << 32) - 4;
  std::vector<std::uint64_t> begins(variables_.size(), 0);
  std::uint64_t at = header(begins).size();
  for (std::size_t v = 0; v < variables_.size(); ++v) {
    const std::uint64_t bytes = bytes_of(variables_[v].data);
    if (bytes > largest)
      throw IoError({.what = "the mesh is too large for netCDF's classic format",
                     .where = variables_[v].name,
                     .value = std::to_string(bytes) + " bytes",
                     .limit = std::to_string(largest),
                     .advice = "another format, such as .vtu"});
    begins[v] = at;
    at += bytes;
  }
  for (std::size_t v = 0; v < variables_.size(); ++v)
    if (has_records(variables_[v])) begins[v] = at;  // records come last
  const std::string head = header(begins);
  stream.write(head.data(), static_cast<std::streamsize>(head.size()));
  for (const Variable& variable : variables_) {
    if (const auto* text = std::get_if<std::string>(&variable.data)) {
      std::string padded = *text;
      pad(padded);
      stream.write(padded.data(), static_cast<std::streamsize>(padded.size()));
    } else if (const auto* integers = std::get_if<std::vector<std::int32_t>>(&variable.data)) {
      write_values(stream, *integers);
    } else {
      write_values(stream, std::get<std::vector<double>>(variable.data));
    }
  }
}

}  // namespace scan2fea
