#include "preproc/mesh/write_surface.hpp"

#include "preproc/mesh/byte_order.hpp"
#include "preproc/mesh/error.hpp"
#include "preproc/mesh/file_extension.hpp"
#include "preproc/mesh/output_file.hpp"
#include "preproc/mesh/unit_comment.hpp"

#include <charconv>
#include <cmath>
#include <limits>
#include <string>
#include <string_view>

namespace scan2fea {
namespace {

// Collects small pieces so that the stream sees large ones only.
class Buffer {
 public:
  explicit Buffer(std::ostream& stream) : stream_(stream) { bytes_.reserve(capacity); }

  Buffer& text(std::string_view piece) {
    if (bytes_.size() + piece.size() > capacity) flush();
    bytes_ += piece;
    return *this;
  }

  // The shortest decimal that reads back as `value`.
  template <class T>
  Buffer& number(T value) {
    char digits[32];
    const auto [last, error] = std::to_chars(digits, digits + sizeof(digits), value);
    return text({digits, static_cast<std::size_t>(last - digits)});
  }

  template <class T>
  Buffer& binary(T value) {
    char bytes[sizeof(T)];
    store(value, bytes, std::endian::little);
    return text({bytes, sizeof(T)});
  }

  void flush() {
    stream_.write(bytes_.data(), static_cast<std::streamsize>(bytes_.size()));
    bytes_.clear();
  }

 private:
  static constexpr std::size_t capacity = 1 << 16;  // bytes; what the stream is handed at a time
  std::ostream& stream_;
  std::string bytes_;
};

void require_float(double coordinate) {
  constexpr float largest = std::numeric_limits<float>::max();
  if (std::abs(coordinate) > static_cast<double>(largest))
    throw IoError({"a coordinate does not fit the 32 bits of STL",
                   {},
                   std::to_string(coordinate),
                   std::to_string(largest),
                   "PLY, OBJ or OFF, or another unit"});
}

std::string about(const SurfaceFileOptions& options) {
  return "written by scan2fea" + (options.unit.empty() ? "" : ", " + unit_comment(options.unit));
}

void write_ascii_stl(const SurfaceMesh& mesh, const SurfaceFileOptions& options, Buffer& out) {
  const auto point = [&](const Vec3& p) {
    for (const double coordinate : p) {
      require_float(coordinate);
      out.text(" ").number(static_cast<float>(coordinate));
    }
    out.text("\n");
  };
  out.text("solid ").text(about(options)).text("\n");
  for (const Triangle& t : mesh.triangles) {
    out.text("facet normal");
    point(area_vector(mesh, t).stableNormalized());
    out.text("outer loop\n");
    for (const std::uint32_t v : t) {
      out.text("vertex");
      point(mesh.vertices[v]);
    }
    out.text("endloop\nendfacet\n");
  }
  out.text("endsolid\n");
}

void write_stl(const SurfaceMesh& mesh, const SurfaceFileOptions& options, Buffer& out) {
  if (options.ascii) return write_ascii_stl(mesh, options, out);
  std::string header = about(options);  // must not begin with "solid", by which ASCII is told
  header.resize(80, ' ');
  out.text(header).binary(static_cast<std::uint32_t>(mesh.triangles.size()));
  const auto point = [&](const Vec3& p) {
    for (const double coordinate : p) {
      require_float(coordinate);
      out.binary(static_cast<float>(coordinate));
    }
  };
  for (const Triangle& t : mesh.triangles) {
    point(area_vector(mesh, t).stableNormalized());  // 0 where there is no area, as STL has it
    for (const std::uint32_t v : t) point(mesh.vertices[v]);
    out.binary(std::uint16_t{0});
  }
}

// The names of the sets that each triangle is in, " A B"; none at all where there are no sets.
std::vector<std::string> groups_of_triangles(const std::vector<NamedSet>& sets, std::size_t triangles) {
  std::vector<std::string> groups(sets.empty() ? 0 : triangles);
  for (const NamedSet& set : sets)
    for (const std::uint32_t t : set.members) groups[t] += " " + set.name;
  return groups;
}

void write_obj(const SurfaceMesh& mesh, const SurfaceFileOptions& options, Buffer& out) {
  if (!options.unit.empty()) out.text("# ").text(unit_comment(options.unit)).text("\n");
  for (const Vec3& p : mesh.vertices) {
    out.text("v");
    for (const double coordinate : p) out.text(" ").number(coordinate);
    out.text("\n");
  }
  const std::vector<std::string> groups = groups_of_triangles(options.face_sets, mesh.triangles.size());
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    if (!groups.empty() && (t == 0 || groups[t] != groups[t - 1]))
      out.text("g").text(groups[t].empty() ? " default" : groups[t]).text("\n");
    out.text("f");
    for (const std::uint32_t v : mesh.triangles[t]) out.text(" ").number(std::uint64_t{v} + 1);
    out.text("\n");
  }
}

void write_ascii_elements(const SurfaceMesh& mesh, std::optional<std::size_t> measured, Buffer& out) {
  for (std::size_t v = 0; v < mesh.vertices.size(); ++v) {
    const Vec3& p = mesh.vertices[v];
    out.number(p[0]).text(" ").number(p[1]).text(" ").number(p[2]);
    if (measured) out.text(v < *measured ? " 1" : " 0");
    out.text("\n");
  }
  for (const Triangle& t : mesh.triangles) {
    out.text("3");
    for (const std::uint32_t v : t) out.text(" ").number(v);
    out.text("\n");
  }
}

// `int` and not `uint` for indices: it is what all readers know.
void write_ply(const SurfaceMesh& mesh, const SurfaceFileOptions& options, Buffer& out) {
  const auto& measured = options.measured;
  out.text("ply\nformat ").text(options.ascii ? "ascii" : "binary_little_endian").text(" 1.0\ncomment ");
  out.text(about(options)).text("\nelement vertex ");
  out.number(mesh.vertices.size());
  out.text("\nproperty double x\nproperty double y\nproperty double z\n");
  if (measured) out.text("property uchar measured\n");
  out.text("element face ");
  out.number(mesh.triangles.size());
  out.text("\nproperty list uchar int vertex_indices\nend_header\n");
  if (options.ascii) return write_ascii_elements(mesh, measured, out);
  for (std::size_t v = 0; v < mesh.vertices.size(); ++v) {
    for (const double coordinate : mesh.vertices[v]) out.binary(coordinate);
    if (measured) out.binary(static_cast<std::uint8_t>(v < *measured));
  }
  for (const Triangle& t : mesh.triangles) {
    out.binary(std::uint8_t{3});
    for (const std::uint32_t v : t) out.binary(v);
  }
}

void write_off(const SurfaceMesh& mesh, const SurfaceFileOptions& options, Buffer& out) {
  out.text("OFF\n");
  if (!options.unit.empty()) out.text("# ").text(unit_comment(options.unit)).text("\n");
  out.number(mesh.vertices.size()).text(" ").number(mesh.triangles.size()).text(" 0\n");
  for (const Vec3& p : mesh.vertices) out.number(p[0]).text(" ").number(p[1]).text(" ").number(p[2]).text("\n");
  for (const Triangle& t : mesh.triangles) {
    out.text("3");
    for (const std::uint32_t v : t) out.text(" ").number(v);
    out.text("\n");
  }
}

using Writer = void (*)(const SurfaceMesh&, const SurfaceFileOptions&, Buffer&);

// Null where the extension names no surface format.
Writer writer_for(const std::filesystem::path& file) {
  const std::string extension = lower_case_extension(file);
  if (extension == ".stl") return write_stl;
  if (extension == ".obj") return write_obj;
  if (extension == ".ply") return write_ply;
  if (extension == ".off") return write_off;
  return nullptr;
}

}  // namespace

bool is_surface_file(const std::filesystem::path& file) {
  return writer_for(file) != nullptr;
}

std::string_view known_surface_formats() {
  return ".stl, .obj, .ply or .off";
}

void write_surface(const SurfaceMesh& mesh, const std::filesystem::path& file, const SurfaceFileOptions& options) {
  const Writer write = writer_for(file);
  if (write == nullptr)
    throw WrongUsage({"the extension of the output names no surface format", file.string(), lower_case_extension(file),
                      std::string(known_surface_formats()), "one of these"});
  OutputFiles files(options.together);
  Buffer buffer(files.open(file).stream());
  write(mesh, options, buffer);
  buffer.flush();
  files.commit();
}

}  // namespace scan2fea
