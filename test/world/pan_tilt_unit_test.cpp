#include "early_fusion/world/pan_tilt_unit.h"

#include <gtest/gtest.h>

#include "world/test_world.h"

namespace early_fusion::world {
namespace {

const std::string kPanLimit = R"(<limit lower="-0.698132" upper="0.698132" effort="1" velocity="1"/>)";
const std::string kPanAxis = R"(<axis xyz="0 0 1"/>)";
const std::string kTiltAxis = R"(<axis xyz="0 1 0"/>)";
const std::string kPanJoint = R"(<joint name="pan_joint" type="revolute">)";
const std::string kMount = R"(<joint name="mount_joint" type="fixed">)";

PanTiltUnit parse(const std::string& xml) {
  return PanTiltUnit::parse(xml, "the unit", "pan_joint", "tilt_joint", "eye");
}

PanTiltUnit parse(const std::string& from, const std::string& to) { return parse(replaced(kRigUrdf, from, to)); }

std::string errorOfUnit(const std::string& from, const std::string& to) {
  return errorOf([&] { parse(from, to); });
}

TEST(PanTiltUnit, ReadsNamesLimitsAndSigns) {
  const PanTiltUnit unit = parse(kRigUrdf);
  EXPECT_EQ(unit.pan.name, "pan_joint");
  EXPECT_EQ(unit.pan.sign, 1);
  EXPECT_FALSE(unit.pan.continuous);
  EXPECT_DOUBLE_EQ(unit.pan.lower_rad, -0.698132);
  EXPECT_DOUBLE_EQ(unit.pan.upper_rad, 0.698132);
  EXPECT_EQ(unit.tilt.name, "tilt_joint");
  EXPECT_EQ(unit.tilt.sign, 1);
  EXPECT_DOUBLE_EQ(unit.tilt.lower_rad, 0.20944);
}

TEST(PanTiltUnit, ATiltThatIsPositiveUpwardsAndAPanAboutMinusZHaveTheSignMinusOne) {
  EXPECT_EQ(parse(kTiltAxis, R"(<axis xyz="0 -1 0"/>)").tilt.sign, -1);
  EXPECT_EQ(parse(kPanAxis, R"(<axis xyz="0 0 -1"/>)").pan.sign, -1);
}

TEST(PanTiltUnit, AUnitThatHangsUpsideDownTurnsByWhatItsImageShows) {
  // The whole unit is turned about x. Its image is upside down, so left and right in it are as before.
  const PanTiltUnit hanging = parse(R"(<origin xyz="0 0 1.35"/>)", R"(<origin xyz="0 0 1.35" rpy="3.14159265 0 0"/>)");
  EXPECT_EQ(hanging.pan.sign, 1);
  EXPECT_EQ(hanging.tilt.sign, 1);
  // Only the camera is turned about its optical axis, so that its image is upright again.
  const PanTiltUnit upright =
      parse(R"(rpy="-1.570796326794897 0 -1.570796326794897")", R"(rpy="1.570796326794897 0 1.570796326794897")");
  EXPECT_EQ(upright.pan.sign, -1);
  EXPECT_EQ(upright.tilt.sign, -1);
}

TEST(PanTiltUnit, ThePanJointMayBeContinuous) {
  const std::string continuous = replaced(kRigUrdf, kPanJoint, R"(<joint name="pan_joint" type="continuous">)");
  EXPECT_TRUE(parse(continuous).pan.continuous);
  EXPECT_TRUE(parse(replaced(continuous, kPanLimit, "")).pan.continuous);
}

TEST(PanTiltUnit, LimitsNeedNoWholeSteps) {
  const PanTiltUnit unit = parse(kPanLimit, R"(<limit lower="0.036" upper="0.069" effort="1" velocity="1"/>)");
  EXPECT_DOUBLE_EQ(unit.pan.lower_rad, 0.036);
  EXPECT_DOUBLE_EQ(unit.pan.upper_rad, 0.069);
}

TEST(PanTiltUnit, TheSafetyControllersLimitsCountWhereTheyAreNarrower) {
  const PanTiltUnit unit = parse(kPanLimit, kPanLimit + R"(<safety_controller soft_lower_limit="-0.5"
      soft_upper_limit="2" k_velocity="1"/>)");
  EXPECT_DOUBLE_EQ(unit.pan.lower_rad, -0.5);
  EXPECT_DOUBLE_EQ(unit.pan.upper_rad, 0.698132);
}

TEST(PanTiltUnit, JointsAboveThePanJointMayMove) {
  EXPECT_EQ(parse(kMount, R"(<joint name="mount_joint" type="floating">)").pan.sign, 1);
}

TEST(PanTiltUnit, AJointThatMovesBetweenPanAndCameraIsNamed) {
  const std::string urdf = replaced(
      replaced(kRigUrdf, R"(<joint name="eye_joint" type="fixed">)", R"(<joint name="roll_joint" type="continuous">)"),
      R"(<link name="world"/>)", R"(<link name="world"/>)");
  EXPECT_NE(errorOf([&] { parse(urdf); })
                .find("the unit: joint 'roll_joint', between joint 'tilt_joint' and link "
                      "'eye', must be fixed"),
            std::string::npos);
}

TEST(PanTiltUnit, SaysWhatIsWrongWithAJoint) {
  EXPECT_NE(errorOfUnit(kPanLimit, R"(<limit lower="0.7" upper="-0.7" effort="1" velocity="1"/>)")
                .find("joint 'pan_joint' has swapped limits [0.7, -0.7] rad"),
            std::string::npos);
  EXPECT_NE(errorOfUnit(kPanLimit, R"(<limit lower="0.1" upper="0.1" effort="1" velocity="1"/>)")
                .find("cannot turn within its limits [0.1, 0.1] rad"),
            std::string::npos);
  EXPECT_NE(errorOfUnit(kPanJoint, R"(<joint name="pan_joint" type="prismatic">)").find("revolute or continuous"),
            std::string::npos);
  EXPECT_NE(errorOfUnit(kPanJoint, R"(<joint name="neck" type="revolute">)").find("no joint 'pan_joint'; its joints"),
            std::string::npos);
  EXPECT_NE(errorOf([] {
              PanTiltUnit::parse(kRigUrdf, "the unit", "tilt_joint", "pan_joint", "eye");
            }).find("the pan joint 'tilt_joint' hangs from the tilt joint 'pan_joint'; exchange them"),
            std::string::npos);
  EXPECT_NE(errorOfUnit(kPanAxis, R"(<axis xyz="0 1 0"/>)").find("does not turn the camera left or right"),
            std::string::npos);
  EXPECT_NE(errorOfUnit(kTiltAxis, R"(<axis xyz="0 0 1"/>)").find("does not turn the camera up or down"),
            std::string::npos);
}

TEST(PanTiltUnit, AnAxisAlongTheLineOfSightIsRefused) {
  // The tilt's limits have their middle 27 degrees below the horizon, so the pan axis x is 27 degrees from the view.
  const std::string pan = errorOfUnit(kPanAxis, R"(<axis xyz="1 0 0"/>)");
  EXPECT_NE(pan.find("the axis of joint 'pan_joint' lies along the line of sight (27 degrees from it), so the joint "
                     "turns the image and not the camera left or right"),
            std::string::npos)
      << pan;
  const std::string tilt = errorOfUnit(kTiltAxis, R"(<axis xyz="1 0.3 0"/>)");
  EXPECT_NE(tilt.find("the axis of joint 'tilt_joint' lies along the line of sight (17 degrees"), std::string::npos)
      << tilt;
  EXPECT_EQ(parse(kPanAxis, R"(<axis xyz="0.5 0 1"/>)").pan.sign, 1) << "a unit that leans";
}

TEST(PanTiltUnit, LimitsInDegreesAreRefused) {
  const std::string error = errorOfUnit(kPanLimit, R"(<limit lower="-150" upper="150" effort="1" velocity="1"/>)");
  EXPECT_NE(error.find("joint 'pan_joint' has the limits [-150, 150] rad, more than two turns; if they are degrees, "
                       "convert them to rad"),
            std::string::npos)
      << error;
  EXPECT_NE(errorOfUnit(kPanLimit, R"(<limit lower="-30" upper="0" effort="1" velocity="1"/>)").find("degrees"),
            std::string::npos);
  EXPECT_DOUBLE_EQ(parse(kPanLimit, R"(<limit lower="-12.5" upper="12.5" effort="1" velocity="1"/>)").pan.upper_rad,
                   12.5)
      << "a unit that turns twice either way";
}

TEST(PanTiltUnit, AXacroFileSaysThatXacroHasToRunFirst) {
  const std::string error = errorOf([] {
    parse(R"(<robot name="r" xmlns:xacro="http://ros.org/wiki/xacro"><xacro:include filename="a"/></robot>)");
  });
  EXPECT_NE(error.find("the unit: is a xacro file, not a URDF; run xacro first"), std::string::npos) << error;
  EXPECT_EQ(parse("<robot name=\"rig\">", R"(<robot name="rig" xmlns:xacro="http://ros.org/wiki/xacro">)").pan.sign, 1)
      << "the output of xacro may still name its namespace";
  EXPECT_EQ(parse("<robot name=\"rig\">", R"(<robot name="rig"><!-- <xacro:include filename="a"/> -->)").pan.sign, 1)
      << "comments do not count";
  const std::string number =
      errorOf([] { parse(kPanLimit, R"(<limit lower="${-pi/2}" upper="0.698132" effort="1" velocity="1"/>)"); });
  EXPECT_NE(number.find("run xacro first"), std::string::npos) << number;
}

}  // namespace
}  // namespace early_fusion::world
