#include "early_fusion/world/camera_rig.h"

#include <gtest/gtest.h>

#include <set>

#include "world/test_world.h"

namespace early_fusion::world {
namespace {

CameraRig load(const std::string& urdf) {
  const TestFolder folder;
  return CameraRig::load(folder.write("rig.urdf", urdf), "pan_joint", "tilt_joint", "eye");
}

std::string errorOfRig(const std::string& from, const std::string& to) {
  return errorOf([&] { load(replaced(kRigUrdf, from, to)); });
}

const std::string kPanLimits = R"(lower="-0.698132" upper="0.698132")";
const std::string kPanJoint = R"(<joint name="pan_joint" type="revolute">)";

Eigen::Vector3d forward(const CameraRig& rig, Orientation o) { return rig.worldFromCamera(o).linear().col(2); }

/// The rig, with tilt 0 within its limits.
CameraRig levelRig() { return load(replaced(kRigUrdf, R"(lower="0.209440")", R"(lower="0")")); }

TEST(CameraRig, LooksAlongXAtZeroWithAnUprightImage) {
  const Eigen::Isometry3d pose = levelRig().worldFromCamera({0, 0});
  EXPECT_TRUE(pose.translation().isApprox(Eigen::Vector3d(0, 0, 1.35), 1e-9));
  Eigen::Matrix3d expected;  // columns: right, down, forward
  expected << 0, 0, 1, -1, 0, 0, 0, -1, 0;
  EXPECT_TRUE(pose.linear().isApprox(expected, 1e-9)) << pose.linear();
}

TEST(CameraRig, PansLeftAndTiltsDownByTwoDegreesAStep) {
  const CameraRig rig = levelRig();
  const double angle = 5 * 2 * M_PI / 180;
  EXPECT_TRUE(forward(rig, {5, 0}).isApprox(Eigen::Vector3d(std::cos(angle), std::sin(angle), 0), 1e-9));
  EXPECT_TRUE(forward(rig, {0, 5}).isApprox(Eigen::Vector3d(std::cos(angle), 0, -std::sin(angle)), 1e-9));
  const double right = -3 * 2 * M_PI / 180;
  const Eigen::Vector3d both(std::cos(right) * std::cos(angle), std::sin(right) * std::cos(angle), -std::sin(angle));
  EXPECT_TRUE(forward(rig, {-3, 5}).isApprox(both, 1e-9)) << "tilt happens in the panned frame";
}

TEST(CameraRig, HasEveryWholeStepWithinTheLimits) {
  const OrientationLattice lattice = load(kRigUrdf).lattice();
  EXPECT_EQ(lattice.lowest, (Orientation{-20, 6}));
  EXPECT_EQ(lattice.highest, (Orientation{20, 21}));
  EXPECT_EQ(lattice.size(), 41 * 16);
  std::set<int> seen;
  for (int i = 0; i < lattice.size(); ++i) {
    EXPECT_TRUE(lattice.contains(lattice.at(i)));
    EXPECT_EQ(lattice.index(lattice.at(i)), i);
    seen.insert(lattice.at(i).pan * 1000 + lattice.at(i).tilt);
  }
  EXPECT_EQ(static_cast<int>(seen.size()), lattice.size());
  EXPECT_FALSE(lattice.contains({21, 10}));
  EXPECT_FALSE(lattice.contains({0, 5}));
}

TEST(CameraRig, RoundsLimitsInwards) {
  const CameraRig rig = load(replaced(kRigUrdf, kPanLimits, R"(lower="-0.05" upper="0.06")"));  // 0.0349, 0.0698 a step
  EXPECT_EQ(rig.lattice().lowest.pan, -1);
  EXPECT_EQ(rig.lattice().highest.pan, 1);
}

TEST(CameraRig, FollowsOffsetsAndTurnedFramesAlongTheChain) {
  // The pan joint's frame is turned upside down about x, so its axis points down the frame's z to point up; between the
  // joints lies one more link; the tilt axis is off the pan axis.
  std::string urdf = replaced(kRigUrdf, R"(<axis xyz="0 0 1"/>)",
                              R"(<origin xyz="0.1 0 0" rpy="3.141592653589793 0 0"/><axis xyz="0 0 -2"/>)");
  urdf = replaced(urdf, R"(<link name="eye"/>)", R"(<link name="eye"/><link name="arm"/>)");
  urdf = replaced(urdf, R"(<joint name="tilt_joint" type="revolute"><origin xyz="0 0 0"/><parent link="pan_link"/>)",
                  R"(<joint name="arm_joint" type="fixed"><origin xyz="0.05 0 0" rpy="3.141592653589793 0 0"/>
                     <parent link="pan_link"/><child link="arm"/></joint>
                     <joint name="tilt_joint" type="revolute"><origin xyz="0 0 0.02"/><parent link="arm"/>)");
  const CameraRig rig = load(urdf);
  const double pan = 10 * kStepRad, tilt = 8 * kStepRad;
  const Eigen::Isometry3d pose = rig.worldFromCamera({10, 8});
  const Eigen::Vector3d ahead(std::cos(pan) * std::cos(tilt), std::sin(pan) * std::cos(tilt), -std::sin(tilt));
  EXPECT_TRUE(pose.linear().col(2).isApprox(ahead, 1e-9));
  const Eigen::Vector3d centre(0.1 + 0.05 * std::cos(pan), 0.05 * std::sin(pan), 1.37);
  EXPECT_TRUE(pose.translation().isApprox(centre, 1e-9)) << pose.translation().transpose();
}

TEST(CameraRig, NamesWhatIsMissing) {
  EXPECT_NE(errorOf([] { CameraRig::load("/no/such.urdf", "a", "b", "c"); }).find("/no/such.urdf"), std::string::npos);
  EXPECT_NE(errorOf([] { load("<robot name='x'>"); }).find("not a valid URDF"), std::string::npos);
  EXPECT_NE(errorOf([] { load("no XML"); }).find("not a valid URDF"), std::string::npos);
  EXPECT_NE(errorOfRig(kPanJoint, R"(<joint name="other" type="revolute">)")
                .find("no joint 'pan_joint'; its joints are: eye_joint, mount_joint, other, tilt_joint"),
            std::string::npos);
  const TestFolder folder;
  const std::string file = folder.write("rig.urdf", kRigUrdf);
  EXPECT_EQ(errorOf([&] { CameraRig::load(file, "pan_joint", "tilt_joint", "lens"); }), file + ": no link 'lens'");
}

TEST(CameraRig, SaysWhatIsWrongWithAJoint) {
  EXPECT_NE(errorOfRig(kPanJoint, R"(<joint name="pan_joint" type="continuous">)").find("'pan_joint' is continuous"),
            std::string::npos);
  EXPECT_NE(errorOfRig(kPanJoint, R"(<joint name="pan_joint" type="prismatic">)").find("must be revolute"),
            std::string::npos);
  EXPECT_NE(errorOfRig("<limit " + kPanLimits + R"( effort="1" velocity="1"/>)", "").find("limits"), std::string::npos);
  EXPECT_NE(errorOfRig(kPanLimits, R"(lower="0.036" upper="0.069")").find("no multiple of 2 degrees"),
            std::string::npos);
  EXPECT_NE(errorOfRig(kPanLimits, R"(lower="0.7" upper="-0.7")").find("swapped limits [0.7, -0.7] rad"),
            std::string::npos);
  EXPECT_NE(errorOfRig(kPanLimits, R"(lower="-100" upper="100")").find("within [-6.28318, 6.28318]"),
            std::string::npos);
}

TEST(CameraRig, RefusesLoopsOfLinks) {
  const std::string end = "</robot>";
  const auto joint = [](const std::string& name, const std::string& parent, const std::string& child) {
    return "<joint name='" + name + "' type='fixed'><parent link='" + parent + "'/><child link='" + child +
           "'/></joint>";
  };
  const std::string cycle = "<link name='b'/><link name='c'/>" + joint("bc", "b", "c") + joint("cb", "c", "b") + end;
  EXPECT_NE(errorOfRig(end, cycle).find("link 'b' is its own ancestor"), std::string::npos) << errorOfRig(end, cycle);
  const std::string self = "<link name='b'/>" + joint("loop", "b", "b") + end;
  EXPECT_NE(errorOfRig(end, self).find("link 'b' is its own ancestor"), std::string::npos) << errorOfRig(end, self);
}

TEST(CameraRig, RefusesTextsThatAreNoUrdfYet) {
  EXPECT_NE(errorOfRig("<link name=\"world\"/>", "<xacro:property name='a' value='1'/>").find("run xacro first"),
            std::string::npos);
  std::string deep;
  for (int i = 0; i < 200000; ++i) deep += "<a>";
  EXPECT_NE(errorOf([&] { load(deep); }).find("nested more than 64 deep"), std::string::npos);
}

TEST(CameraRig, RefusesMovesThatWouldTurnTheOtherWay) {
  EXPECT_NE(
      errorOfRig(R"(<axis xyz="0 0 1"/>)", R"(<axis xyz="0 0 -1"/>)").find("'pan_joint' must turn the camera left"),
      std::string::npos);
  EXPECT_NE(
      errorOfRig(R"(<axis xyz="0 1 0"/>)", R"(<axis xyz="1 0 0"/>)").find("'tilt_joint' must turn the camera down"),
      std::string::npos);
}

TEST(CameraRig, RefusesAJointThatMovesInBetween) {
  EXPECT_NE(errorOfRig(R"(<joint name="mount_joint" type="fixed">)", R"(<joint name="mount_joint" type="floating">)")
                .find("joint 'mount_joint', between the root link and link 'mount', must be fixed"),
            std::string::npos);
  const TestFolder folder;
  const std::string file = folder.write("rig.urdf", kRigUrdf);
  EXPECT_NE(errorOf([&] { CameraRig::load(file, "tilt_joint", "pan_joint", "eye"); }).find("hangs from the tilt joint"),
            std::string::npos);
}

}  // namespace
}  // namespace early_fusion::world
