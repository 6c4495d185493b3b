#include "preproc/command/face_files.hpp"

#include "export/formats.hpp"
#include "preproc/command/quality_fields.hpp"
#include "preproc/mesh/error_text.hpp"
#include "preproc/mesh/numbers.hpp"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

namespace scan2fea::command {
namespace {

// Neighbouring numbers differ most where hues go round by the golden ratio.
std::array<int, 3> colour(std::uint32_t face) {
  constexpr double golden = 0.6180339887498949;
  const double hue = 6 * std::fmod(golden * face, 1.0);
  std::array<int, 3> rgb{};
  for (int k = 0; k < 3; ++k) {
    const double distance = std::abs(std::fmod(hue + 2.0 * k, 6.0) - 3);
    rgb[static_cast<std::size_t>(k)] = static_cast<int>(70 + 170 * std::clamp(distance - 1, 0.0, 1.0));
  }
  return rgb;
}

// Numbers that read back as they are, a line for every `per_line` of them.
class Text {
 public:
  Text& operator<<(std::string_view piece) {
    text_ += piece;
    return *this;
  }
  Text& operator<<(double value) {
    char digits[32];
    text_.append(digits, static_cast<std::size_t>(std::snprintf(digits, sizeof digits, "%.17g ", value)));
    return *this;
  }
  Text& operator<<(std::size_t value) { return *this << std::string_view(std::to_string(value) + " "); }
  std::string take() { return std::move(text_); }

 private:
  std::string text_;
};

std::string ply(const SurfaceMesh& mesh, const SurfaceFaces& faces) {
  Text out;
  out << "ply\nformat ascii 1.0\nelement vertex " << std::string_view(std::to_string(mesh.vertices.size()))
      << "\nproperty double x\nproperty double y\nproperty double z\nelement face "
      << std::string_view(std::to_string(mesh.triangles.size()))
      << "\nproperty list uchar int vertex_indices\nproperty int face\nproperty uchar red\nproperty uchar green\n"
         "property uchar blue\nend_header\n";
  for (const Vec3& p : mesh.vertices) out << p.x() << p.y() << p.z() << "\n";
  for (std::size_t f = 0; f < mesh.triangles.size(); ++f) {
    out << "3 ";
    for (const std::uint32_t v : mesh.triangles[f]) out << std::size_t{v};
    out << std::size_t{faces.of_triangle[f]} + 1;
    for (const int c : colour(faces.of_triangle[f])) out << static_cast<std::size_t>(c);
    out << "\n";
  }
  return out.take();
}

std::string figures_of(const SurfaceFace& face) {
  if (!face.shape) return {};
  const Shape& shape = *face.shape;
  const std::string axis = error_text(Vec3(1e-5 * (1e5 * shape.axis).array().round().matrix() + Vec3::Zero()));
  std::string text;
  if (shape.kind == ShapeKind::plane)
    text = "normal " + axis + ", offset " + error_text(shape.axis.dot(shape.origin), 5);
  if (shape.kind == ShapeKind::sphere) text = "centre " + error_text(shape.origin);
  if (shape.kind != ShapeKind::plane && shape.kind != ShapeKind::sphere) text = "axis " + axis;
  if (shape.kind != ShapeKind::plane) text += ", radius " + error_text(shape.radius, 5);
  if (shape.kind == ShapeKind::torus) text += ", tube " + error_text(shape.tube_radius, 5);
  if (shape.kind == ShapeKind::cone) text += ", half angle " + error_text(shape.half_angle * degrees, 4);
  return text + ", misfit " + error_text(face.mean_misfit, 2) + " to " + error_text(face.largest_misfit, 2);
}

}  // namespace

Json face_list(const SurfaceFaces& faces) {
  Json all = Json::array();
  for (const SurfaceFace& face : faces.list) {
    Json entry{{"name", face.name},
               {"kind", kind_of(face)},
               {"area", face.area},
               {"triangles", face.triangles.size()},
               {"place", point_json(face.place)}};
    if (face.shape) {
      const Shape& shape = *face.shape;
      entry["origin"] = point_json(shape.origin);
      if (shape.kind == ShapeKind::plane) {
        entry["normal"] = point_json(shape.axis);
        entry["offset"] = shape.axis.dot(shape.origin);
      } else {
        if (shape.kind != ShapeKind::sphere) entry["axis"] = point_json(shape.axis);
        entry["radius"] = shape.radius;
        entry["hollow"] = shape.hollow;
      }
      if (shape.kind == ShapeKind::torus) entry["tube_radius"] = shape.tube_radius;
      if (shape.kind == ShapeKind::cone) entry["half_angle_deg"] = shape.half_angle * degrees;
      entry["mean_misfit"] = face.mean_misfit;
      entry["largest_misfit"] = face.largest_misfit;
    }
    all.push_back(std::move(entry));
  }
  return all;
}

std::string face_table(const SurfaceFaces& faces) {
  std::string table;
  for (const SurfaceFace& face : faces.list) {
    char start[96];
    std::snprintf(start, sizeof start, "%-9s %-9s area %-10.6g ", face.name.c_str(), std::string(kind_of(face)).c_str(),
                  face.area);
    table += start + figures_of(face) + "\n";
  }
  return table;
}

bool is_face_file(const std::filesystem::path& file) {
  const auto extension = file.extension();
  return extension == ".ply" || extension == ".vtp" || extension == ".vtu";
}

Notes write_face_file(const NamedSurface& surface, const SurfaceFaces& faces, const std::filesystem::path& file,
                      OutputFiles& outputs) {
  if (file.extension() == ".ply") {
    outputs.add(file, ply(surface.mesh, faces));
    return {};
  }
  FileOptions options{.together = &outputs};
  add_quality_fields(surface, nullptr, options);
  return write_surface(surface, file, options);
}

}  // namespace scan2fea::command
