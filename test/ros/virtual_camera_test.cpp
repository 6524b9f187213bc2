#include "early_fusion/ros/virtual_robot/virtual_camera.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "early_fusion/ros/shared/camera_image.h"
#include "early_fusion/ros/virtual_robot/virtual_messages.h"
#include "early_fusion/ros/virtual_robot/virtual_unit.h"
#include "early_fusion/sim/scene.h"

namespace early_fusion::nodes {
namespace {

constexpr int kFrameSize = 128;

/// A scene with smooth colours.
core::Image gradient(int width, int height) {
  core::Image image(width, height);
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      std::uint8_t* pixel = &image.rgb[std::size_t(3) * (y * width + x)];
      pixel[0] = static_cast<std::uint8_t>(40 + 2 * x);
      pixel[1] = static_cast<std::uint8_t>(60 + 2 * y);
      pixel[2] = static_cast<std::uint8_t>(200 - x - y);
    }
  }
  return image;
}

double meanDifference(const std::vector<std::uint8_t>& a, const std::vector<std::uint8_t>& b) {
  EXPECT_EQ(a.size(), b.size());
  double sum = 0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += std::abs(int(a[i]) - int(b[i]));
  return sum / a.size();
}

core::Image seen(const SensorImage& image, int size) {
  const auto message = sensorImageMessage(image, std_msgs::Header());
  return policyImage(*message, largestSquare(*message), size);
}

TEST(SensorImage, EveryEncodingShowsTheScene) {
  const core::Image scene = gradient(48, 48);
  for (const char* encoding : {"rgb8", "bgr8", "bayer_rggb8", "yuv422"}) {
    for (const int padding : {0, 7}) {
      SensorOptions options;
      options.encoding = encoding;
      options.row_padding = padding;
      const core::Image image = seen(sensorImage(scene, options, core::Random(1)), 48);
      EXPECT_LT(meanDifference(image.rgb, scene.rgb), 2.0) << encoding << ", padding " << padding;
    }
  }
  SensorOptions grey;
  grey.encoding = "mono8";
  const core::Image image = seen(sensorImage(scene, grey, core::Random(1)), 48);
  EXPECT_NEAR(image.rgb[0], 0.299 * 40 + 0.587 * 60 + 0.114 * 200, 1);
}

TEST(SensorImage, NoiseHasItsDeviationAndDependsOnTheSeedOnly) {
  core::Image scene(64, 64);
  std::fill(scene.rgb.begin(), scene.rgb.end(), std::uint8_t{100});
  SensorOptions options;
  options.noise = 8;
  const std::vector<std::uint8_t> data = sensorImage(scene, options, core::Random(5)).data;
  double sum = 0, squares = 0;
  for (const std::uint8_t value : data) {
    sum += value - 100.0;
    squares += (value - 100.0) * (value - 100.0);
  }
  EXPECT_NEAR(sum / data.size(), 0, 0.3);
  EXPECT_NEAR(std::sqrt(squares / data.size()), 8, 0.3);
  EXPECT_EQ(sensorImage(scene, options, core::Random(5)).data, data);
  EXPECT_NE(sensorImage(scene, options, core::Random(6)).data, data);
}

TEST(SensorImage, ExposureScalesAndClipsAndBlurSmooths) {
  core::Image scene(32, 32);
  for (std::size_t i = 0; i < scene.rgb.size(); ++i) scene.rgb[i] = i % 96 < 48 ? 50 : 200;  // left dark, right bright
  SensorOptions options;
  options.exposure = 2;
  const SensorImage exposed = sensorImage(scene, options, core::Random(1));
  EXPECT_EQ(exposed.data.front(), 100);
  EXPECT_EQ(exposed.data.back(), 255);
  options.exposure = 1;
  options.blur_px = 3;
  const SensorImage blurred = sensorImage(scene, options, core::Random(1));
  EXPECT_NEAR(blurred.data[3 * (32 * 16 + 15)], 125, 15);
  EXPECT_EQ(blurred.data[3 * 32 * 16], 50);
}

/// Through the virtual camera and the policy's crop, the policy sees what the simulator draws for it.
TEST(VirtualCamera, ShowsThePolicyTheSimulatorsFrame) {
  const auto world = world::loadWorld("");
  const sim::EpisodeKey key{sim::loadTask("medium"), 3, 0};
  const sim::EpisodeSetup setup = sim::sampleEpisode(*world, key);
  const auto objects = sim::presentObjects(*world, setup.instances, ~sim::InstanceMask{0});
  const Eigen::Isometry3d pose = world->rig.worldFromCamera(setup.orientation);
  render::Rasterizer simulator(*world, kFrameSize);
  simulator.setObjects(objects);
  core::Image expected;
  simulator.render(pose, expected);
  for (const std::string& calibration : virtualCalibrations()) {
    if (calibration == "uncalibrated") continue;
    VirtualCamera camera(*world, VirtualLens(), SensorOptions(), 1);
    camera.setObjects(objects);
    const auto image = sensorImageMessage(camera.take(pose), std_msgs::Header());
    const sensor_msgs::CameraInfo info = virtualCameraInfo(calibration, camera.lens(), std_msgs::Header());
    const Crop crop = cropToView(*image, &info, calibration == "rectified", 60);
    EXPECT_EQ(crop.warning, "") << calibration;
    EXPECT_EQ(crop.width, 370) << calibration;
    EXPECT_LT(meanDifference(policyImage(*image, crop, kFrameSize).rgb, expected.rgb), 3.0) << calibration;
  }
}

TEST(VirtualCamera, WithTheSameSeedTakesTheSameImages) {
  const auto world = world::loadWorld("");
  SensorOptions sensor;
  sensor.noise = 5;
  VirtualLens lens;
  lens.width = 64;
  lens.height = 48;
  VirtualCamera one(*world, lens, sensor, 7), other(*world, lens, sensor, 7);
  const Eigen::Isometry3d pose = worldFromCamera(world->rig, 0.1, 0.4);
  const SensorImage first = one.take(pose), second = one.take(pose);
  EXPECT_NE(first.data, second.data);
  EXPECT_EQ(other.take(pose).data, first.data);
  EXPECT_EQ(other.take(pose).data, second.data);
  EXPECT_EQ(first.width, 64);
  EXPECT_EQ(first.height, 48);
}

TEST(VirtualUnit, TheCameraTurnsEvenlyBetweenTheRigsOrientations) {
  const world::CameraRig rig = world::loadWorld("")->rig;
  const double pan = 3 * world::kStepRad, tilt = 5 * world::kStepRad;
  EXPECT_TRUE(worldFromCamera(rig, pan, tilt).isApprox(rig.worldFromCamera({3, 5}), 1e-12));
  const Eigen::Isometry3d turned = worldFromCamera(rig, pan + 0.01, tilt + 0.02);
  // The shipped unit's axes meet in the camera: tilt about the optical frame's x, then pan about the world's z.
  const Eigen::Matrix3d expected = Eigen::AngleAxisd(0.01, Eigen::Vector3d::UnitZ()) *
                                   rig.worldFromCamera({3, 5}).linear() *
                                   Eigen::AngleAxisd(-0.02, Eigen::Vector3d::UnitX()).toRotationMatrix();
  EXPECT_TRUE(turned.linear().isApprox(expected, 1e-4)) << turned.linear() << "\n" << expected;
  EXPECT_TRUE(worldFromCamera(rig, 9, 9).isApprox(rig.worldFromCamera(rig.lattice().highest), 1e-12));
}

TEST(VirtualJointStates, ComeTogetherOneByOneAmongOthersOrWrapped) {
  const std::vector<std::string> names = {"pan", "tilt"};
  const auto complete = virtualJointStates("complete", false, names, {-0.5, 0.3}, ::ros::Time(4));
  ASSERT_EQ(complete.size(), 1u);
  EXPECT_EQ(complete[0].name, names);
  EXPECT_EQ(complete[0].position, (std::vector<double>{-0.5, 0.3}));
  EXPECT_EQ(complete[0].header.stamp, ::ros::Time(4));
  const auto single = virtualJointStates("single", false, names, {-0.5, 0.3}, ::ros::Time(4));
  ASSERT_EQ(single.size(), 2u);
  EXPECT_EQ(single[1].name, std::vector<std::string>{"tilt"});
  const auto crowded = virtualJointStates("crowded", true, names, {-0.5, 0.3}, ::ros::Time(4));
  ASSERT_EQ(crowded[0].name.size(), 22u);
  EXPECT_EQ(crowded[0].name[20], "pan");
  EXPECT_NEAR(crowded[0].position[20], 2 * M_PI - 0.5, 1e-12);
}

}  // namespace
}  // namespace early_fusion::nodes
