// The functions of ours that need EDF's MED library, in a module that is loaded when they are called: libmedC brings
// HDF5 and MPI with it, some sixty shared libraries, and to load those takes longer than many a command runs.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace scan2fea {

inline constexpr const char* med_module_name = "scan2fea-med.so";
inline constexpr const char* write_by_med_name = "scan2fea_write_by_med";
inline constexpr const char* read_by_med_name = "scan2fea_read_by_med";

// Members with the same groups are one family; its number is the index from 1 into `groups`, 0 is in no group.
struct MedFamilies {
  std::vector<std::uint32_t> family;             // per member
  std::vector<std::vector<std::string>> groups;  // per family, from 1
};

// Elements of one of MED's types, as node numbers from 1 in MED's order.
struct MedCells {
  int type;  // MED's, see below
  std::vector<int> nodes;
  MedFamilies families;
};

struct MedMesh {
  std::vector<double> coordinates;
  MedFamilies nodes;
  std::vector<MedCells> cells;
  std::string unit, description;
  std::uint64_t first_node = 1, first_element = 1;  // their numbers
};

// The file's bytes are made in memory: where a disk fills while HDF5 writes to it, HDF5 ends the process with a crash.
// Both say in `failure` what went wrong, empty where nothing did: nothing is thrown through the module's door.
using WriteByMed = void(const MedMesh& mesh, std::string& bytes, std::string& failure);
using ReadByMed = void(const std::filesystem::path& file, MedMesh& mesh, std::string& failure);

inline constexpr int med_triangle_3 = 203, med_triangle_6 = 206, med_tetrahedron_4 = 304, med_tetrahedron_10 = 310;

}  // namespace scan2fea
