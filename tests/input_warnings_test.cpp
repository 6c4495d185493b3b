// What the command says of a scan before it works on it.
#include "preproc/mesh/write_surface.hpp"
#include "tests/analytic_meshes.hpp"
#include "tests/run_command.hpp"
#include "tests/temporary_folder.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <string>

namespace scan2fea {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

class InputWarnings : public ::testing::Test {
 protected:
  std::string said_of(const SurfaceMesh& scan, const std::string& flags = {}) const {
    const std::string input = (folder_ / "scan.ply").string(), output = (folder_ / "out.ply").string();
    write_surface(scan, input);
    const CommandResult result =
        run_command("simplify '" + input + "' -o '" + output + "' --force --faces 500 " + flags);
    EXPECT_EQ(result.exit_code, 0) << result.standard_error;
    return result.standard_error;
  }

  TemporaryFolder folder_;
};

TEST_F(InputWarnings, NameTheStepOfCoarseCoordinates) {
  const SurfaceMesh ball = analytic::sphere(25, 5);
  SurfaceMesh stepped = ball;
  for (Vec3& p : stepped.vertices) p = (10 * p).array().round() / 10;
  EXPECT_THAT(said_of(stepped), HasSubstr("written with 3 digits and have steps of 0.1 (mean edge: 0.9"));
  EXPECT_THAT(said_of(ball), Not(HasSubstr("warning")));
}

TEST_F(InputWarnings, DoubtAnImplausibleSize) {
  const SurfaceMesh horse = analytic::sphere(6e-2, 3), bracket = analytic::sphere(1e3, 3);  // 0.2 and 3464 across
  EXPECT_THAT(said_of(horse, "--unit mm"), HasSubstr("0.208 mm across, which is less than a millimetre"));
  EXPECT_THAT(said_of(horse, "--unit m"), Not(HasSubstr("right?")));
  EXPECT_THAT(said_of(bracket, "--unit m"), HasSubstr("more than a kilometre: is the unit right?"));
  EXPECT_THAT(said_of(bracket, "--unit mm"), Not(HasSubstr("right?")));
  EXPECT_THAT(said_of(bracket), Not(HasSubstr("right?"))) << "any size is plausible in some unit";
}

TEST_F(InputWarnings, OptionsThatDoNotCountAreTold) {
  const SurfaceMesh scan = analytic::sphere(10, 4);
  const std::string input = (folder_ / "scan.ply").string(), output = (folder_ / "out.ply").string();
  write_surface(scan, input);
  const std::string surface = "surface '" + input + "' -o '" + output + "' --force --faces 500 ";
  const std::string told = run_command(surface + "--scanner 0 0 90 --domain 'z<3'").standard_error;
  EXPECT_THAT(told, HasSubstr("not used, since the input is a surface: --scanner\n"));
  EXPECT_THAT(told, HasSubstr("not used, since there is no --enrich: --domain\n"));
  EXPECT_THAT(run_command(surface + "--enrich --domain 'z<3'").standard_error, Not(HasSubstr("not used")));
}

}  // namespace
}  // namespace scan2fea
