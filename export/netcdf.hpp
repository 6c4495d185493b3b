// NetCDF's classic format, as much of it as meshes need: dimensions, attributes and variables of text, 32-bit integers
// and doubles. Written with 64-bit offsets (CDF-2), read in all three versions (CDF-1, 2 and 5).
//
// By ourselves, since Debian's libnetcdf brings HDF5, curl and some fifty other libraries with it, and is not made for
// files that are broken on purpose. What is netCDF-4, and so HDF5, is not read; `nccopy -k cdf5` converts it.
//
// The format: https://docs.unidata.ucar.edu/netcdf-c/current/file_format_specifications.html
#pragma once

#include "preproc/mesh/input_file.hpp"

#include <cstdint>
#include <map>
#include <optional>
#include <ostream>
#include <string>
#include <utility>
#include <variant>
#include <vector>

namespace scan2fea {

class NetcdfWriter {
 public:
  using Data = std::variant<std::string, std::vector<std::int32_t>, std::vector<double>>;
  using Attribute = std::pair<std::string, std::variant<std::string, std::int32_t, float>>;

  // `size` 0 makes the one dimension that grows with records, of which there are none.
  std::size_t dimension(std::string name, std::size_t size);
  void attribute(Attribute attribute) { attributes_.push_back(std::move(attribute)); }
  // As many values as the product of the dimensions; nothing for a variable of records.
  void variable(std::string name, std::vector<std::size_t> dimensions, Data data,
                std::vector<Attribute> attributes = {});

  // Throws IoError where a variable is larger than the format holds, 4 GiB.
  void write(std::ostream& stream) const;

 private:
  struct Variable {
    std::string name;
    std::vector<std::size_t> dimensions;
    Data data;
    std::vector<Attribute> attributes;
  };
  bool has_records(const Variable& variable) const;
  std::string header(const std::vector<std::uint64_t>& begins) const;

  std::vector<std::pair<std::string, std::size_t>> dimensions_;
  std::vector<Attribute> attributes_;
  std::vector<Variable> variables_;
};

// The file outlives it. Nothing is read before it is asked for.
class NetcdfReader {
 public:
  // Throws InvalidInput: not netCDF, netCDF-4, a header that does not hold together.
  explicit NetcdfReader(const InputFile& file);

  std::optional<std::uint64_t> dimension(const std::string& name) const;
  // The sizes of a variable's dimensions; nothing where there is no such variable, or it has records.
  std::optional<std::vector<std::uint64_t>> shape(const std::string& name) const;
  // Empty where there is none of that name that is text, or a number.
  std::string text_attribute(const std::string& variable, const std::string& name) const;

  // Precondition: `shape` is there. Throw InvalidInput where the values do not lie in the file, or are of another type;
  // integers also where they do not fit 64 bits.
  std::vector<double> reals(const std::string& name) const;
  std::vector<std::int64_t> integers(const std::string& name) const;
  // Rows of text, each to its first zero, without blanks at its end. Empty where there is no such variable.
  std::vector<std::string> rows(const std::string& name) const;

 private:
  struct Variable {
    std::vector<std::uint64_t> shape;
    bool has_records = false;
    std::map<std::string, std::string> attributes;  // of text
    std::int32_t type = 0;
    std::uint64_t begin = 0;
  };
  class Header;

  const Variable& at(const std::string& name) const;
  std::uint64_t values_of(const Variable& variable) const;
  template <class Take>
  void each(const Variable& variable, const Take& take) const;

  const InputFile& file_;
  std::map<std::string, std::uint64_t> dimensions_;
  std::map<std::string, Variable> variables_;
};

}  // namespace scan2fea
