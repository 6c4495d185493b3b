// write_fuzz_seeds FOLDER: a few first inputs for each fuzz target, in FOLDER/TARGET. Binary files come from our own
// writers; texts show what those do not write.
#include "export/formats.hpp"
#include "export/inp.hpp"
#include "export/vtk.hpp"
#include "preproc/mesh/write_surface.hpp"
#include "tests/analytic_meshes.hpp"
#include "tests/binary_msh.hpp"
#include "tests/cloud_files.hpp"
#include "tests/structured_tets.hpp"
#include "tests/temporary_folder.hpp"

#include <filesystem>
#include <fstream>
#include <iostream>
#include <string>
#include <string_view>

namespace scan2fea {
namespace {

namespace fs = std::filesystem;

void write(const fs::path& file, std::string_view text) {
  std::ofstream(file, std::ios::binary) << text;
}

void write_surfaces(const fs::path& folder) {
  for (const char* format : {"stl", "obj", "ply", "off"})
    write_surface(analytic::box({1, 1, 1}, 1),
                  folder / ("read_" + std::string(format)) / ("box." + std::string(format)));
  write(folder / "read_stl/ascii.stl",
        "solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\nendfacet\n"
        "endsolid a\nsolid b\nfacet normal 0 0 1\nouter loop\nvertex 1 0 0\nvertex 1.5e0 1 -0\nvertex 0 1 0\nendloop\n"
        "endfacet\nendsolid b\n");
  write(folder / "read_obj/forms.obj",
        "# forms\nmtllib a.mtl\nv 0 0 0\nv 1 0 0 1\nv 0 1 0 .5 .5 .5\nv 0 0 1\nv 1 1 1\nvn 0 0 1\nvt 0 0\ng a\ns off\n"
        "f 1/2/3 2//1 \\\n 3\nf -1 -2 -3 -4\nf 1 2 3 4 5\n");
  write(folder / "read_off/forms.off",
        "COFF 5 2 0\n0 0 0 1\n1 0 0 1\n# c\n0 1 0\n0 0 1\n1 1 1\n3 0 1 2 255\n5 0 1 2 3 4\n");
  write(folder / "read_ply/ascii.ply",
        "ply\nformat ascii 1.0\ncomment a\nobj_info b\nelement vertex 5\nproperty float x\nproperty float y\n"
        "property float z\nproperty list uchar int ring\nelement face 2\nproperty list uchar int vertex_indices\n"
        "element tristrips 1\nproperty list int int vertex_indices\nend_header\n0 0 0 1 7\n1 0 0 0\n0 1 0 2 1 1\n"
        "0 0 1 0\n1 1 1 0\n4 0 2 1 3\n3 0 1 3\n5 0 1 2 3 -1\n");
  std::string points, big_endian =
                          "ply\nformat binary_big_endian 1.0\nelement vertex 3\nproperty double x\n"
                          "property double y\nproperty float z\nproperty uchar red\nelement face 1\n"
                          "property list uchar uint vertex_index\nend_header\n";
  for (int v = 0; v < 3; ++v)
    points += bytes(double(v == 1), std::endian::big) + bytes(double(v == 2), std::endian::big) + std::string(5, '\0');
  write(folder / "read_ply/big_endian.ply", big_endian + points + "\3" + bytes(0, std::endian::big) +
                                                bytes(1, std::endian::big) + bytes(2, std::endian::big));
}

void write_clouds(const fs::path& folder) {
  write(folder / "read_xyz/blanks.xyz", "# c\n0 0 0 1 0 0\n1.5 0 0 0 1 0\n0 -2 0 0 0 1\n0 0 3e-3 0 .6 .8\n");
  write(folder / "read_xyz/commas.xyz",
        "id,\"x\",y,z [mm],nx,ny,nz\n1,0,0,0,1,0,0\n2,1,0,0,0,1,0\n3,0,1,0,,,\n4,0,0,1,0,0,1\n");
  write(folder / "read_xyz/counts.xyz", "2\r\n0;0;0\r\n1;0;0\r\n2\r\n0;1;0\r\n0;0;1\r\n");
  write(folder / "read_ptx/grids.ptx",
        "2\n2\n1 2 3\n1 0 0\n0 1 0\n0 0 1\n0 1 0 0\n-1 0 0 0\n0 0 1 0\n1 2 3 1\n0 0 0 0.5\n1 0 0 0.5\n0 1 0 0.5\n"
        "0 0 1 0.5\n1\n1\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n1 0 0 0\n0 1 0 0\n0 0 1 0\n0 0 0 1\n5 0 0 1\n");
  const std::string header =
      "# .PCD v0.7\nVERSION 0.7\nFIELDS x y z i\nSIZE 4 4 8 2\nTYPE F F F U\nCOUNT 1 1 1 2\nWIDTH 4\nHEIGHT 1\n"
      "VIEWPOINT 0 0 9 1 0 0 0\nPOINTS 4\nDATA ";
  const std::string data(4 * 20, '\x3f'), packed = lzf_literals(data);
  write(folder / "read_pcd/ascii.pcd", header + "ascii\n0 0 0 1 2\n1 0 0 1 2\n0 1 0 1 2\nnan nan nan 1 2\n");
  write(folder / "read_pcd/binary.pcd", header + "binary\n" + data);
  write(folder / "read_pcd/compressed.pcd", header + "binary_compressed\n" +
                                                scan2fea::bytes(static_cast<std::uint32_t>(packed.size())) +
                                                scan2fea::bytes(static_cast<std::uint32_t>(data.size())) + packed);
  const std::vector<Vec3> points{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  for (const int format : {0, 3, 6})
    write(folder / ("read_las/format_" + std::to_string(format) + ".las"),
          las_file(points, format < 6 ? 2 : 4, format));
}

// Two elements, as small as it can be, with sets of all kinds.
void write_meshes_with_sets(const fs::path& folder) {
  TetMesh mesh;
  mesh.nodes = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 1, 1}};
  mesh.tetrahedra = {{0, 1, 2, 3}, {1, 4, 2, 3}};
  mesh.boundary = find_boundary(mesh.tetrahedra);
  mesh.node_sets = {{"n", {0, 4}}};
  mesh.face_sets = {{"f", {0, 5}}, {"g", {0, 1}}};
  mesh.element_sets = {{"a", {0}}, {"b", {1}}};
  mesh.unit = "mm";
  NamedSurface surface{
      .mesh = analytic::box({1, 1, 1}, 1), .node_sets = {{"n", {0, 4}}}, .face_sets = {{"f", {0, 5}}}, .unit = "mm"};
  for (const FileFormat& format : file_formats()) {
    const std::string name(format.extension.substr(1));
    const fs::path target = folder / ("read_" + name);
    if (!fs::exists(target) || name == "pvtu") continue;  // MED's reader is not ours; PVTU is of several files
    if (format.write_volume != nullptr) write_volume(mesh, target / ("volume." + name));
    if (format.write_surface != nullptr) write_surface(surface, target / ("surface." + name));
  }
  fs::create_directories(folder / "elmer");
  write_volume(mesh, folder / "elmer/mesh.header");
  std::string parts;
  for (const char* name : {"mesh.nodes", "mesh.elements", "mesh.boundary", "mesh.names"})
    parts += contents(folder / "elmer" / name) + "\f";
  write(folder / "read_elmer/parts", parts);
  fs::create_directories(folder / "pvtu");
  FileOptions in_parts;
  in_parts.part_sizes = {2, static_cast<std::uint32_t>(mesh.tetrahedra.size() - 2)};
  write_volume(mesh, folder / "pvtu/part.pvtu", in_parts);
  write(folder / "read_pvtu/parts", contents(folder / "pvtu/part.pvtu") + "\n\f\n" +
                                        contents(folder / "pvtu/part_0.vtu") + "\n\f\n" +
                                        contents(folder / "pvtu/part_1.vtu"));
  const std::string points = "POINTS 4 float\n0 0 0 1 0 0 0 1 0 0 0 1\n";
  write(folder / "read_vtk/grid.vtk", "# vtk DataFile Version 3.0\na\nASCII\nDATASET UNSTRUCTURED_GRID\n" + points +
                                          "CELLS 1 5\n4 0 1 2 3\nCELL_TYPES 1\n10\n");
  write(folder / "read_vtk/faces.vtk", "# vtk DataFile Version 5.1\na\nASCII\nDATASET POLYDATA\n" + points +
                                           "METADATA\nINFORMATION 0\n\nPOLYGONS 2 4\nOFFSETS vtktypeint64\n0 4\n"
                                           "CONNECTIVITY vtktypeint64\n0 1 2 3\n");
}

void write_volumes(const fs::path& folder) {
  for (const int order : {1, 2}) {
    const TetMesh mesh = analytic::tetrahedra_of_box({1, 1, 1}, {1, 1, 1}, order);
    const std::string name = "order_" + std::to_string(order);
    write_inp(mesh, folder / "read_inp" / (name + ".inp"));
    write_vtu(mesh, folder / "read_vtu" / (name + ".vtu"));
  }
  write_meshes_with_sets(folder);
  write(folder / "read_inp/forms.inp",
        "** a\n*HEADING\nb\n*Node, nset=c\n 7, 0., 0, 0\n5,1.D0,0,0\n3,0,1,\n9,0,0,1e0\n*ELEMENT, TYPE=S3, ELSET=d\n"
        "1, 7, 5, 3\n*ELEMENT,TYPE=DC3D4\n2, 7, 5,\n 3, 9\n*STEP\n*STATIC\n*END STEP\n");
  for (const std::endian order : {std::endian::little, std::endian::big}) {
    const std::string name = order == std::endian::little ? "_little.msh" : "_big.msh";
    write(folder / ("read_msh/v2" + name), binary_mesh(MshVersion::v2_2, order));
    write(folder / ("read_msh/v4" + name), binary_mesh(MshVersion::v4_1, order));
  }
  write(folder / "read_msh/v2.msh",
        "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n1\n3 1 \"a\"\n$EndPhysicalNames\n$Nodes\n4\n7 0 0 0\n"
        "5 1 0 0\n3 0 1 0\n9 0 0 1\n$EndNodes\n$Elements\n2\n1 2 2 1 1 7 5 3\n2 4 2 1 1 7 5 3 9\n$EndElements\n");
  write(folder / "read_msh/v4.msh",
        "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n$Entities\n0 0 0 1\n1 0 0 0 1 1 1 0 0\n$EndEntities\n$Nodes\n2 4 3 9\n"
        "2 1 0 2\n7\n5\n0 0 0\n1 0 0\n3 1 0 2\n3\n9\n0 1 0\n0 0 1\n$EndNodes\n$Elements\n2 2 1 2\n2 1 2 1\n1 7 5 3\n"
        "3 1 4 1\n2 7 5 3 9\n$EndElements\n");
  const std::string piece = "<UnstructuredGrid>\n<Piece NumberOfPoints=\"4\" NumberOfCells=\"1\">\n<Points>\n";
  write(folder / "read_vtu/ascii.vtu",
        "<?xml version=\"1.0\"?>\n<VTKFile type=\"UnstructuredGrid\" version=\"0.1\" byte_order=\"LittleEndian\">\n" +
            piece +
            "<DataArray type=\"Float32\" NumberOfComponents=\"3\" format=\"ascii\">\n0 0 0 1 0 0 0 1 0 0 0 1\n"
            "</DataArray>\n</Points>\n<Cells>\n<DataArray type=\"Int32\" Name=\"connectivity\" format=\"ascii\">0 1 2 3"
            "</DataArray>\n<DataArray type=\"Int32\" Name=\"offsets\" format=\"ascii\">4</DataArray>\n"
            "<DataArray type=\"UInt8\" Name=\"types\" format=\"ascii\">10</DataArray>\n</Cells>\n</Piece>\n"
            "</UnstructuredGrid>\n</VTKFile>\n");
  write(
      folder / "read_vtu/base64.vtu",
      "<VTKFile type=\"UnstructuredGrid\" version=\"1.0\" byte_order=\"LittleEndian\" header_type=\"UInt32\">\n" +
          piece +
          "<DataArray type=\"Float32\" NumberOfComponents=\"3\" format=\"binary\">"
          "MAAAAAAAAAAAAAAAAAAAAAAAgD8AAAAAAAAAAAAAAAAAAIA/AAAAAAAAAAAAAAAAAACAPw==</DataArray>\n</Points>\n<Cells>\n"
          "<DataArray type=\"Int32\" Name=\"connectivity\" format=\"binary\">EAAAAAAAAAABAAAAAgAAAAMAAAA=</DataArray>\n"
          "<DataArray type=\"Int32\" Name=\"offsets\" format=\"binary\">BAAAAAQAAAA=</DataArray>\n"
          "<DataArray type=\"UInt8\" Name=\"types\" format=\"binary\">AQAAAAo=</DataArray>\n</Cells>\n</Piece>\n"
          "</UnstructuredGrid>\n</VTKFile>\n");
}

// What the bytes mean: repair_fuzz.cpp and soup_of_bytes.cpp.
void write_soups(const fs::path& folder) {
  for (char options = 0; options <= 8; ++options) {  // 8: the default
    const std::string name(1, static_cast<char>('a' + options));
    const std::string box = std::string("\0\0\0", 3), next = std::string("\0\1\0", 3),
                      in = std::string("\0\x1f\x1f", 3);
    write(folder / "repair" / (name + "_box"), options + box);
    write(folder / "repair" / (name + "_touching"), options + box + next);
    write(folder / "repair" / (name + "_crossing"), options + std::string("\0\0\x1f", 3) + in);
    write(folder / "repair" / (name + "_cones"), options + std::string("\2\3\0\x3e\2\2\1\x3f", 8));
    write(folder / "repair" / (name + "_open"), options + box + "\6\3\5");
    write(folder / "repair" / (name + "_torn"), options + box + "\x0a\1\x30\x0b\2\x60\x0c\5\x09\7");
  }
}

void write_seeds(const fs::path& folder) {
  for (const char* target :
       {"read_stl",   "read_obj",  "read_ply",           "read_off",           "read_xyz",  "read_ptx", "read_pcd",
        "read_las",   "read_inp",  "read_msh",           "read_vtu",           "read_vtp",  "read_vtk", "read_3mf",
        "read_bdf",   "read_unv",  "read_xdmf",          "read_cdb",           "read_mail", "read_su2", "read_exo",
        "read_elmer", "read_pvtu", "read_feature_lines", "read_configuration", "repair"})
    fs::create_directories(folder / target);
  write_surfaces(folder);
  write_clouds(folder);
  write_volumes(folder);
  write(folder / "read_feature_lines/forms.obj", "# c\nv 0 0 0\nv 1 0 0\nv 1 1 0 1\nf 1 2 3\nl 1 2 3\nl -1 \\\n -3\n");
  write(folder / "read_configuration/forms.toml",
        "faces = 1_000\nquiet = true\nrequire = [\"a<=1\", 'b']\n[run]\nmethod = \"lattice\"\n[check]\n"
        "reference = \"\"\"\na\"\"\"\n");
  write(folder / "read_configuration/more.toml", "run.edge-length = 1e-3\n\"faces\" = 0x1F\nmethod = 1979-05-27\n");
  write_soups(folder);
}

}  // namespace
}  // namespace scan2fea

int main(int argc, char** argv) {
  if (argc != 2) {
    std::cerr << "usage: write_fuzz_seeds FOLDER\n";
    return 2;
  }
  scan2fea::write_seeds(argv[1]);
}
