// The real GetDP solves a patch test on what write_msh writes: a potential that is given at both ends, by sets, is
// linear between them, whatever the mesh.
#include "export/msh.hpp"
#include "tests/part_with_sets.hpp"
#include "tests/temporary_folder.hpp"

#include <gtest/gtest.h>

#include <cstdlib>
#include <sstream>

namespace scan2fea {
namespace {

// Physical groups as they are numbered: bodies from 3, then FIXED and LOADED.
constexpr const char* problem = R"(
Group { Fixed = Region[5]; Loaded = Region[6]; Part = Region[{3, 4}]; Whole = Region[{Part, Fixed, Loaded}]; }
Constraint { { Name v; Case { { Region Fixed; Value 0; } { Region Loaded; Value 4; } } } }
FunctionSpace { { Name H; Type Form0;
  BasisFunction { { Name sn; NameOfCoef vn; Function BF_Node; Support Whole; Entity NodesOf[Whole]; } }
  Constraint { { NameOfCoef vn; EntityType NodesOf; NameOfConstraint v; } } } }
Jacobian { { Name J; Case { { Region Whole; Jacobian Vol; } } } }
Integration { { Name I; Case { { Type Gauss; Case {
  { GeoElement Tetrahedron; NumberOfPoints 15; } { GeoElement Tetrahedron2; NumberOfPoints 15; } } } } } }
Formulation { { Name F; Type FemEquation; Quantity { { Name v; Type Local; NameOfSpace H; } }
  Equation { Galerkin { [ Dof{d v}, {d v} ]; In Part; Jacobian J; Integration I; } } } }
Resolution { { Name R; System { { Name S; NameOfFormulation F; } } Operation { Generate[S]; Solve[S]; SaveSolution[S]; } } }
PostProcessing { { Name P; NameOfFormulation F; Quantity {
  { Name error; Value { Integral { [ SquNorm[{v} - X[]] ]; In Part; Jacobian J; Integration I; } } }
  { Name volume; Value { Integral { [ 1 ]; In Part; Jacobian J; Integration I; } } } } } }
PostOperation { { Name O; NameOfPostProcessing P; Operation {
  Print[ error[Part], OnGlobal, Format Table, File "error.txt" ];
  Print[ volume[Part], OnGlobal, Format Table, File "volume.txt" ]; } } }
)";

// Of a table "time value".
double value_in(const std::filesystem::path& file) {
  double time = 0, value = -1;
  std::istringstream(contents(file)) >> time >> value;
  return value;
}

class GetDp : public testing::TestWithParam<int> {};
INSTANTIATE_TEST_SUITE_P(Order, GetDp, testing::Values(1, 2));

TEST_P(GetDp, SolvesThePatchTest) {
  if (std::system("command -v getdp >/dev/null") != 0) GTEST_SKIP() << "getdp is not installed";
  const TemporaryFolder folder;
  const TetMesh mesh = analytic::part_with_sets(GetParam());
  FileOptions options;
  options.msh_version = MshVersion::v2_2;  // Debian's GetDP reads no newer one
  write_msh(mesh, folder / "part.msh", options);
  write_text(folder / "part.pro", problem);
  const std::string command =
      "cd '" + folder.path().string() + "' && getdp part.pro -msh part.msh -solve R -pos O -v 2 > getdp.log 2>&1";
  ASSERT_EQ(std::system(command.c_str()), 0) << contents(folder / "getdp.log");
  EXPECT_NEAR(value_in(folder / "volume.txt"), total_volume(mesh), 1e-9) << contents(folder / "getdp.log");
  EXPECT_LE(value_in(folder / "error.txt"), 1e-18);
}

}  // namespace
}  // namespace scan2fea
