// The formats of files of meshes, in one table: what each is called, what it holds, and who writes and reads it. The
// help of the command, what `convert` says it lost, and the test of all conversions come from this table.
#pragma once

#include "export/mesh_file.hpp"

#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace scan2fea {

// What a format keeps of a mesh besides nodes and elements.
struct Holdings {
  bool node_sets = false;
  bool face_sets = false;
  bool element_sets = false;
  bool unit = false;
  bool second_order = false;
  bool fields = false;         // see FileOptions
  bool faces_between = false;  // sets of faces between two bodies; with face_sets
  // Up to which nodes and elements may be numbered (see Numbering); 0 where the format has no numbers of its own.
  std::uint64_t largest_number = 0;
  bool own_numbers = false;  // whether these may be any
};

// Whether a file may hold a mesh in parts (FileOptions::part_sizes), or is there for nothing else.
enum class Parts { never, too, always };

struct FileFormat {
  std::string_view extension;       // ".inp"
  std::string_view programs;        // "Abaqus, CalculiX"
  std::optional<Holdings> volume;   // of tetrahedra; nothing where the format has none, or we know them not
  std::optional<Holdings> surface;  // of triangles alone, likewise
  Notes (*write_volume)(const TetMesh&, const std::filesystem::path&, const FileOptions&) = nullptr;
  Notes (*write_surface)(const NamedSurface&, const std::filesystem::path&, const FileOptions&) = nullptr;
  MeshFile (*read)(const std::filesystem::path&) = nullptr;
  // A coordinate as a reader of the file finds it, where fields are too narrow for all digits; null where they are not.
  double (*rounded)(double) = nullptr;
  Parts parts = Parts::never;
  // The files that a volume mesh of so many parts has besides this one, 0 for one that is not divided; null where there
  // are none.
  std::vector<std::filesystem::path> (*other_files)(const std::filesystem::path&, std::size_t parts) = nullptr;
};

std::span<const FileFormat> file_formats();

// By the extension, upper or lower case, `.gz` behind it passed over; null where it is not known.
const FileFormat* find_format(const std::filesystem::path& file);

// Whether a volume mesh, or a surface, can be written there.
bool writes_volume(const std::filesystem::path& file);
bool writes_surface(const std::filesystem::path& file);

// For messages: ".inp (Abaqus, CalculiX), .msh (Gmsh), ...".
std::string known_volume_formats();
std::string known_surface_formats_to_write();

std::string known_formats_of_parts();

// All files that a volume mesh makes there, the one that is named last.
std::vector<std::filesystem::path> files_of_volume(const std::filesystem::path& file, std::size_t parts);

// Throws WrongUsage where the format holds no parts and some are asked for, or holds nothing else and none are.
// `parts`: 0 for none.
void require_parts_fit(const std::filesystem::path& file, std::size_t parts);

// Of the first element of a file that is written with these numbers, or read, where its elements are a row: 0 in
// formats without numbers of their own, in which viewers count from 0.
std::uint64_t first_element_of(const std::filesystem::path& file, const Numbering& numbers = {});

// Writes the mesh, and notes what of it the format cannot hold. Throws WrongUsage for an extension that is not one of
// the format's kind, IoError where the file cannot be written; an earlier file is then untouched.
Notes write_volume(const TetMesh& mesh, const std::filesystem::path& file, const FileOptions& options = {});
Notes write_surface(const NamedSurface& surface, const std::filesystem::path& file, const FileOptions& options = {});

// Sets the options to the numbers that another file gave, where the format holds them and none were asked for; else
// notes what they become.
Notes keep_numbers(const MeshFile& read, const std::filesystem::path& file, FileOptions& options);

// Rounds points as the file's format does, if it does, so that figures of a mesh are those of its file. STL's surfaces,
// of 32-bit numbers, stay as they are.
void round_to_file(std::vector<Vec3>& points, const std::filesystem::path& file);

// Reads whatever the file holds. A surface's format is told by its content, where that is certain, and otherwise by the
// extension. Throws WrongUsage for an unknown extension, InvalidInput for what the readers of the formats say. The
// boundary of a volume mesh is found anew, ordered by tetrahedron and face, and nodes keep the file's order; so
// "boundary nodes come first" holds only for files that were written so. Elements are taken as they are, inverted ones
// included.
MeshFile read_mesh(const std::filesystem::path& file);

// The same, and InvalidInput where the file holds no tetrahedra.
TetMesh read_volume(const std::filesystem::path& file);

// The boundary with its sets, for formats that hold no tetrahedra; what only tetrahedra have is noted.
NamedSurface named_boundary(const TetMesh& mesh, Notes& notes);

}  // namespace scan2fea
