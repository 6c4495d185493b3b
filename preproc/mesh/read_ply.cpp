#include "preproc/mesh/byte_order.hpp"
#include "preproc/mesh/cloud_formats.hpp"
#include "preproc/mesh/ply_header.hpp"
#include "preproc/mesh/polygon.hpp"
#include "preproc/mesh/surface_formats.hpp"
#include "preproc/mesh/text_scanner.hpp"
#include "preproc/mesh/triangle_rows.hpp"
#include "preproc/mesh/truncated.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <string_view>
#include <utility>

namespace scan2fea {
namespace {

// The body's values one after another. Two of a kind, so that `BodyReader` reads both alike; copies remember a place.
class TextBody {
 public:
  TextBody(const InputFile& file, const PlyHeader& header) : scanner_(file, header.body) {}

  const char* position() {
    if (!scanner_.skip_space())
      fail(scanner_.position(), "the file ends inside its elements", {}, {}, truncated_advice);
    return scanner_.position();
  }
  double coordinate(PlyType) {
    position();
    return scanner_.number();
  }
  std::int64_t integer(PlyType) {
    position();
    return scanner_.integer();
  }
  // What is not finite is 0.
  double any_number(PlyType) {
    position();
    TextScanner ahead = scanner_;
    const std::string_view word = ahead.word();
    if (is_keyword(word, "nan") || is_keyword(word, "-nan")) {
      scanner_ = ahead;
      return 0;
    }
    return scanner_.number();
  }
  void skip(PlyType, std::uint64_t values) {
    for (; values > 0; --values) {
      position();
      scanner_.word();
    }
  }
  // A digit and a blank; the last blank may lack.
  std::uint64_t values_left(PlyType) const { return (scanner_.bytes_left() + 1) / 2; }
  [[noreturn]] void fail(const char* at, std::string what, std::string value = {}, std::string limit = {},
                         std::string advice = {}) const {
    scanner_.fail(at, std::move(what), std::move(value), std::move(limit), std::move(advice));
  }

 private:
  TextScanner scanner_;
};

class BinaryBody {
 public:
  BinaryBody(const InputFile& file, const PlyHeader& header)
      : file_(&file),
        order_(header.format == PlyFormat::binary_little_endian ? std::endian::little : std::endian::big),
        at_(header.body),
        end_(file.bytes().data() + file.bytes().size()) {}

  const char* position() const { return at_; }
  double coordinate(PlyType type) {
    const char* start = at_;
    const double value = take_number(type);
    if (!std::isfinite(value)) fail(start, "not a finite coordinate", std::to_string(value));
    return value;
  }
  double any_number(PlyType type) {
    const double value = take_number(type);
    return std::isfinite(value) ? value : 0;
  }
  std::int64_t integer(PlyType type) {
    switch (type) {
      case PlyType::int8:
        return take<std::int8_t>();
      case PlyType::uint8:
        return take<std::uint8_t>();
      case PlyType::int16:
        return take<std::int16_t>();
      case PlyType::uint16:
        return take<std::uint16_t>();
      case PlyType::int32:
        return take<std::int32_t>();
      case PlyType::uint32:
        return take<std::uint32_t>();
      case PlyType::float32:
      case PlyType::float64:
        break;
    }
    fail(at_, "not a whole number");
  }
  void skip(PlyType type, std::uint64_t values) {
    if (values > values_left(type)) fail(at_, "the file ends inside its elements", {}, {}, truncated_advice);
    at_ += values * size_of(type);
  }
  std::uint64_t values_left(PlyType type) const { return static_cast<std::uint64_t>(end_ - at_) / size_of(type); }
  [[noreturn]] void fail(const char* at, std::string what, std::string value = {}, std::string limit = {},
                         std::string advice = {}) const {
    file_->fail_at_byte(at, std::move(what), std::move(value), std::move(limit), std::move(advice));
  }

 private:
  double take_number(PlyType type) {
    return type == PlyType::float32   ? static_cast<double>(take<float>())
           : type == PlyType::float64 ? take<double>()
                                      : static_cast<double>(integer(type));
  }

  template <class T>
  T take() {
    if (end_ - at_ < static_cast<std::ptrdiff_t>(sizeof(T)))
      fail(at_, "the file ends inside its elements", {}, {}, truncated_advice);
    const char* start = std::exchange(at_, at_ + sizeof(T));
    return load<T>(start, order_);
  }

  const InputFile* file_;
  std::endian order_;
  const char* at_;
  const char* end_;
};

bool holds_faces(const PlyElement& element) {
  return element.name == "face" || element.name == "tristrips";
}

bool is_vertex_list(const PlyProperty& property) {
  return property.count_type && (property.name == "vertex_indices" || property.name == "vertex_index");
}

// By which programs number the parts of a scan; and the number of parts above which they are taken for something else.
bool is_label(const PlyProperty& property) {
  constexpr std::array<std::string_view, 9> names{"label",    "object_id", "segment",        "segment_id", "group",
                                                  "group_id", "region",    "material_index", "category_id"};
  return !property.count_type && is_integer(property.type) && std::ranges::find(names, property.name) != names.end();
}
constexpr std::size_t most_labels = 1000;

// The triangles of each value of each label.
class Labels {
 public:
  void add(const std::string& property, std::int64_t value) { of_row_.emplace_back(property, value); }
  // The triangles that the row has made.
  void end_row(std::size_t begin, std::size_t end) {
    for (const auto& [property, value] : of_row_) {
      std::map<std::int64_t, std::vector<std::uint32_t>>& parts = parts_[property];
      if (parts.size() > most_labels) continue;
      std::vector<std::uint32_t>& members = parts[value];
      for (std::size_t t = begin; t < end; ++t) members.push_back(static_cast<std::uint32_t>(t));
    }
    of_row_.clear();
  }
  // One label for all parts nothing.
  std::vector<NamedSet> take() {
    std::vector<NamedSet> sets;
    for (auto& [property, parts] : parts_) {
      if (parts.size() < 2 || parts.size() > most_labels) continue;
      for (auto& [value, members] : parts)
        if (!members.empty()) sets.push_back(named_set(property + "_" + std::to_string(value), std::move(members)));
    }
    return sets;
  }

 private:
  std::vector<std::pair<std::string, std::int64_t>> of_row_;
  std::map<std::string, std::map<std::int64_t, std::vector<std::uint32_t>>> parts_;
};

template <class Body>
class BodyReader {
 public:
  BodyReader(const InputFile& file, const PlyHeader& header, const TakeBlock& take = {})
      : file_(file), header_(header), body_(file, header), rows_(take) {}

  PointCloud points() {
    const PlyElement& vertex = vertex_element();
    const auto has = [&](const char* axis) {
      return std::ranges::any_of(vertex.properties, [&](const PlyProperty& p) { return p.name == axis; });
    };
    keeps_normals_ = has("nx") && has("ny") && has("nz");
    for (const PlyElement& element : header_.elements) {
      check_promise(element);
      if (&element != &vertex) {
        skip_rows(element);
        continue;
      }
      read_vertices(element);
      break;
    }
    return {.points = std::move(mesh_.vertices), .normals = std::move(normals_), .scanners = {}};
  }

  SurfaceMesh run(std::vector<NamedSet>* sets) {
    const PlyElement& vertex = vertex_element();
    std::vector<std::pair<const PlyElement*, Body>> faces_before_vertices;
    bool has_vertices = false;
    for (const PlyElement& element : header_.elements) {
      check_promise(element);
      if (&element == &vertex) {
        read_vertices(element);
        has_vertices = true;
      } else if (holds_faces(element) && has_vertices) {
        read_faces(element);
      } else {
        if (holds_faces(element)) faces_before_vertices.emplace_back(&element, body_);
        skip_rows(element);
      }
    }
    for (const auto& [element, start] : faces_before_vertices) {
      body_ = start;
      read_faces(*element);
    }
    if (sets != nullptr) *sets = labels_.take();
    return rows_.finish();
  }

 private:
  const PlyElement& vertex_element() const {
    const auto vertex = std::ranges::find(header_.elements, "vertex", &PlyElement::name);
    if (vertex == header_.elements.end()) file_.fail("the PLY header declares no vertices");
    for (const char* axis : {"x", "y", "z"})
      if (std::ranges::none_of(vertex->properties,
                               [&](const PlyProperty& p) { return p.name == axis && !p.count_type; }))
        file_.fail_at_line(vertex->declared_at, "the vertices lack a coordinate", axis);
    return *vertex;
  }

  // So that nothing is allocated, or looped over, that the file cannot hold.
  void check_promise(const PlyElement& element) const {
    constexpr std::uint64_t largest_count = std::numeric_limits<std::uint32_t>::max();
    std::uint64_t most = largest_count;
    if (header_.format == PlyFormat::ascii) {
      const std::uint64_t row = std::max<std::uint64_t>(1, element.properties.size());
      most = std::min(most, body_.values_left(PlyType::int8) / row);
    } else {
      std::uint64_t row = 0;
      for (const PlyProperty& property : element.properties)
        row += size_of(property.count_type.value_or(property.type));
      if (row > 0) most = std::min(most, body_.values_left(PlyType::int8) / row);
    }
    if (element.count > most)
      file_.fail_at_line(element.declared_at,
                         "the header promises more \"" + element.name + "\" than the file can hold",
                         std::to_string(element.count), std::to_string(most), truncated_advice);
  }

  void skip_property(const PlyProperty& property) {
    body_.skip(property.type, property.count_type ? list_length(property) : 1);
  }

  void skip_rows(const PlyElement& element) {
    if (element.properties.empty()) return;
    for (std::uint64_t row = 0; row < element.count; ++row)
      for (const PlyProperty& property : element.properties) skip_property(property);
  }

  std::uint64_t list_length(const PlyProperty& property) {
    const char* start = body_.position();
    const std::int64_t length = body_.integer(*property.count_type);
    const std::uint64_t most = body_.values_left(property.type);
    if (length < 0 || static_cast<std::uint64_t>(length) > most)
      body_.fail(start, "a list promises more values than the file can hold", std::to_string(length),
                 std::to_string(most), truncated_advice);
    return static_cast<std::uint64_t>(length);
  }

  void read_vertices(const PlyElement& element) {
    mesh_.vertices.reserve(element.count);
    for (std::uint64_t row = 0; row < element.count; ++row) {
      Vec3 point = Vec3::Zero(), normal = Vec3::Zero();
      for (const PlyProperty& property : element.properties) {
        const std::string& name = property.name;
        const bool is_axis = !property.count_type && !name.empty() && name.back() >= 'x' && name.back() <= 'z';
        if (is_axis && name.size() == 1)
          point[name[0] - 'x'] = body_.coordinate(property.type);
        else if (keeps_normals_ && is_axis && name.size() == 2 && name[0] == 'n')
          normal[name[1] - 'x'] = body_.any_number(property.type);
        else
          skip_property(property);
      }
      mesh_.vertices.push_back(point);
      if (keeps_normals_) normals_.push_back(direction(normal));
    }
  }

  void read_faces(const PlyElement& element) {
    if (element.properties.empty()) return;  // as many as the header likes
    const bool strips = element.name == "tristrips";
    if (!strips) {
      constexpr std::uint64_t shortest_row = 4;  // a length and three corners
      mesh_.triangles.reserve(rows_.at_once(std::min(element.count, body_.values_left(PlyType::int8) / shortest_row)));
    }
    for (const PlyProperty& property : element.properties)
      if (is_vertex_list(property) && !is_integer(property.type))
        file_.fail_at_line(element.declared_at, "the vertex indices are not whole numbers");
    for (std::uint64_t row = 0; row < element.count; ++row) {
      const std::size_t before = rows_.count();
      for (const PlyProperty& property : element.properties) {
        if (is_label(property)) {
          body_.position();
          labels_.add(property.name, body_.integer(property.type));
        } else if (!is_vertex_list(property)) {
          skip_property(property);
        } else if (strips) {
          read_strips(property);
        } else {
          read_polygon(property);
        }
      }
      labels_.end_row(before, rows_.count());
      rows_.end_row();
    }
  }

  void read_polygon(const PlyProperty& property) {
    const char* start = body_.position();
    const std::uint64_t length = list_length(property);
    if (length < 3) body_.fail(start, "a face has too few corners", std::to_string(length), "3");
    corners_.clear();
    for (std::uint64_t k = 0; k < length; ++k) corners_.push_back(read_vertex_index(property));
    append_polygon(mesh_, corners_);
  }

  // Each corner makes a triangle with the two before it, every other one turned over; a negative index begins a new
  // strip. Triangles that name a vertex twice are the joints by which writers sew strips together, not surface.
  void read_strips(const PlyProperty& property) {
    const std::uint64_t length = list_length(property);
    corners_.clear();
    for (std::uint64_t k = 0; k < length; ++k) {
      const char* start = body_.position();
      const std::int64_t index = body_.integer(property.type);
      if (index < 0) {
        corners_.clear();
        continue;
      }
      corners_.push_back(checked_index(start, index));
      if (corners_.size() < 3) continue;
      const std::size_t last = corners_.size() - 1;
      Triangle triangle{corners_[last - 2], corners_[last - 1], corners_[last]};
      if (last % 2 == 1) std::swap(triangle[0], triangle[1]);
      if (triangle[0] != triangle[1] && triangle[1] != triangle[2] && triangle[2] != triangle[0])
        mesh_.triangles.push_back(triangle);
    }
  }

  std::uint32_t read_vertex_index(const PlyProperty& property) {
    const char* start = body_.position();
    return checked_index(start, body_.integer(property.type));
  }

  std::uint32_t checked_index(const char* start, std::int64_t index) const {
    if (index < 0 || index >= static_cast<std::int64_t>(mesh_.vertices.size()))
      body_.fail(start, "vertex index out of range", std::to_string(index),
                 std::to_string(mesh_.vertices.size()) + " vertices");
    return static_cast<std::uint32_t>(index);
  }

  const InputFile& file_;
  const PlyHeader& header_;
  Body body_;
  TriangleRows rows_;
  SurfaceMesh& mesh_ = rows_.mesh;
  bool keeps_normals_ = false;
  std::vector<Vec3> normals_;
  std::vector<std::uint32_t> corners_;
  Labels labels_;
};

}  // namespace

bool is_ply(const InputFile& file) {
  TextScanner scanner(file);
  return scanner.word() == "ply";
}

PointCloud read_ply_points(const InputFile& file) {
  const PlyHeader header = read_ply_header(file);
  if (header.format == PlyFormat::ascii) return BodyReader<TextBody>(file, header).points();
  return BodyReader<BinaryBody>(file, header).points();
}

SurfaceMesh read_ply(const InputFile& file, std::vector<NamedSet>* sets, const TakeBlock& take) {
  const PlyHeader header = read_ply_header(file);
  if (header.format == PlyFormat::ascii) return BodyReader<TextBody>(file, header, take).run(sets);
  return BodyReader<BinaryBody>(file, header, take).run(sets);
}

}  // namespace scan2fea
