#include "early_fusion/ros/shared/camera_crop.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "early_fusion/core/error.h"
#include "early_fusion/ros/shared/conversions.h"

namespace early_fusion::nodes {
namespace {

sensor_msgs::Image imageOf(int width, int height) {
  sensor_msgs::Image image;
  image.width = width;
  image.height = height;
  return image;
}

/// Intrinsics with the optical axis in the middle.
sensor_msgs::CameraInfo infoOf(int width, int height, double focal_length) {
  sensor_msgs::CameraInfo info;
  info.width = width;
  info.height = height;
  info.K = {focal_length, 0, width / 2.0 - 0.5, 0, focal_length, height / 2.0 - 0.5, 0, 0, 1};
  info.P = {focal_length, 0, info.K[2], 0, 0, focal_length, info.K[5], 0, 0, 0, 1, 0};
  return info;
}

Crop raw60(const sensor_msgs::Image& image, const sensor_msgs::CameraInfo& info) {
  return cropToView(image, &info, false, 60);
}

void expectSquare(const Crop& crop, int edge) {
  EXPECT_EQ(crop.width, edge) << crop.warning;
  EXPECT_EQ(crop.height, edge) << crop.warning;
}

/// @param words that the warning must hold; none: no warning
void expectWarning(const Crop& crop, const std::vector<std::string>& words) {
  EXPECT_EQ(crop.warning.empty(), words.empty()) << crop.warning;
  for (const std::string& word : words) EXPECT_NE(crop.warning.find(word), std::string::npos) << crop.warning;
}

TEST(CameraCrop, CoversTheFieldOfViewAboutTheOpticalAxis) {
  sensor_msgs::CameraInfo info = infoOf(640, 480, 300);
  // 2 f tan(30 degrees) = 346.4 pixels show 60 degrees.
  const Crop centred = raw60(imageOf(640, 480), info);
  expectSquare(centred, 346);
  EXPECT_EQ(centred.x, 147);
  EXPECT_EQ(centred.y, 67);
  expectWarning(centred, {});
  info.K[2] += 20;
  info.K[5] -= 200;  // the axis near the upper edge: the part ends there
  const Crop shifted = raw60(imageOf(640, 480), info);
  EXPECT_EQ(shifted.x, 167);
  EXPECT_EQ(shifted.y, 0);
  expectSquare(shifted, 346);
}

TEST(CameraCrop, TheSimulatorsImageIsTakenWhole) {
  const sensor_msgs::CameraInfo info = cameraInfoMessage(128, 60, std_msgs::Header());
  const Crop crop = raw60(imageOf(128, 128), info);
  expectSquare(crop, 128);
  EXPECT_EQ(crop.x + crop.y, 0);
  expectWarning(crop, {});
}

TEST(CameraCrop, AnImageThatIsTooLargeIsRefused) {
  const sensor_msgs::CameraInfo uncalibrated;
  const auto errorOf = [&](const sensor_msgs::Image& image, const sensor_msgs::CameraInfo* info) -> std::string {
    try {
      cropToView(image, info, false, 60);
    } catch (const core::Error& error) {
      return error.what();
    }
    return "";
  };
  sensor_msgs::Image image;
  image.width = 0x80000000u;  // negative as an int
  image.height = 7;
  EXPECT_EQ(errorOf(image, nullptr), "image 2147483648 x 7 is larger than 32767 px");
  EXPECT_EQ(errorOf(image, &uncalibrated), "image 2147483648 x 7 is larger than 32767 px");
  EXPECT_EQ(errorOf(imageOf(32767, 1), &uncalibrated), "");
}

TEST(CameraCrop, AViewThatIsTooNarrowIsTakenWholeWithAWarningOfWhatItShows) {
  const Crop slightly = raw60(imageOf(640, 480), infoOf(640, 480, 480));
  expectSquare(slightly, 480);
  expectWarning(slightly, {"53 degrees", "60", "480 x 480"});
  const Crop narrow = raw60(imageOf(640, 480), infoOf(640, 480, 772));
  expectSquare(narrow, 480);
  expectWarning(narrow, {"35 degrees", "60"});
}

TEST(CameraCrop, ASmallPartOfTheImageIsToldOf) {
  const Crop crop = raw60(imageOf(640, 480), infoOf(640, 480, 100));
  expectSquare(crop, 115);
  expectWarning(crop, {"115 x 115", "640 x 480"});
}

TEST(CameraCrop, RectifiedImagesFollowPAndRawOnesK) {
  sensor_msgs::CameraInfo info = infoOf(640, 480, 310);
  info.P[0] = info.P[5] = 222;
  expectSquare(cropToView(imageOf(640, 480), &info, true, 60), 256);
  expectSquare(cropToView(imageOf(640, 480), &info, false, 60), 358);
  info.P[5] = 261;  // pixels that are not square
  const Crop crop = cropToView(imageOf(640, 480), &info, true, 60);
  EXPECT_EQ(crop.width, 256);
  EXPECT_EQ(crop.height, 301);
}

TEST(CameraCrop, AnImplausibleMatrixGivesWayToTheOther) {
  for (const bool rectified : {false, true}) {
    sensor_msgs::CameraInfo info = infoOf(640, 480, 300);
    (rectified ? info.P[0] : info.K[0]) = 1;
    const Crop crop = cropToView(imageOf(640, 480), &info, rectified, 60);
    expectSquare(crop, 346);
    expectWarning(crop, {rectified ? "K is used" : "P is used"});
  }
}

TEST(CameraCrop, WithoutAPlausibleFocalLengthTheCameraCountsAsUncalibrated) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  // 640 / 2 / tan(10 degrees) = 1815 and 640 / 2 / tan(75 degrees) = 86 are the limits.
  for (const double focal_length : {0.0, 1.0, -300.0, nan, 85.0, 1820.0}) {
    const Crop crop = raw60(imageOf(640, 480), infoOf(640, 480, focal_length));
    expectSquare(crop, 480);
    expectWarning(crop, {"uncalibrated", "480 x 480", "K[0]"});
  }
  for (const double focal_length : {87.0, 1810.0}) {
    EXPECT_EQ(raw60(imageOf(640, 480), infoOf(640, 480, focal_length)).warning.find("uncalibrated"), std::string::npos);
  }
  const Crop none = cropToView(imageOf(640, 480), nullptr, false, 60);
  expectSquare(none, 480);
  EXPECT_EQ(none.x, 80);
}

TEST(CameraCrop, ARegionOfInterestIsAWindowOfTheCalibration) {
  sensor_msgs::CameraInfo info = infoOf(1280, 960, 400);
  info.roi.x_offset = 320;
  info.roi.y_offset = 240;
  info.roi.width = 640;
  info.roi.height = 480;
  const Crop middle = raw60(imageOf(640, 480), info);
  expectSquare(middle, 462);
  EXPECT_EQ(middle.x, 89);
  info.roi.x_offset = 340;  // the optical axis is 20 pixels to the left of the image's middle
  EXPECT_EQ(raw60(imageOf(640, 480), info).x, 69);
  info.roi.x_offset = 1280 - 640;
  info.roi.x_offset += 20;
  expectWarning(raw60(imageOf(640, 480), info), {"optical axis is outside"});
}

TEST(CameraCrop, BinningDividesTheFocalLength) {
  sensor_msgs::CameraInfo info = infoOf(1280, 960, 400);
  info.binning_x = info.binning_y = 2;
  expectSquare(raw60(imageOf(640, 480), info), 231);
  info.roi.width = 1280;
  info.roi.height = 960;
  const Crop crop = raw60(imageOf(640, 480), info);
  expectSquare(crop, 231);
  EXPECT_EQ(crop.x, 204);
  expectSquare(raw60(imageOf(1280, 960), info), 462);  // the driver says that it bins, but it does not
}

TEST(CameraCrop, AnInfoOfAnotherSizeIsScaled) {
  expectSquare(raw60(imageOf(320, 240), infoOf(640, 480, 300)), 173);
  expectWarning(raw60(imageOf(320, 240), infoOf(640, 480, 300)), {});
  sensor_msgs::CameraInfo without_size = infoOf(640, 480, 300);
  without_size.width = without_size.height = 0;
  expectSquare(raw60(imageOf(640, 480), without_size), 346);
  // A mode of another shape shows the middle rows.
  const Crop wide = raw60(imageOf(640, 360), infoOf(640, 480, 300));
  expectSquare(wide, 346);
  EXPECT_EQ(wide.y, 7);
  expectWarning(wide, {"640 x 360", "640 x 480"});
}

TEST(CameraCrop, TheNamesOfRectifiedTopicsAreKnown) {
  for (const char* topic :
       {"/camera/image_rect_color", "image_rect", "/rectified/image", "/left/image_rect/compressed"}) {
    EXPECT_TRUE(isRectifiedTopic(topic)) << topic;
  }
  for (const char* topic : {"/camera/image_raw", "/corrected/image", "/direct/image_color"}) {
    EXPECT_FALSE(isRectifiedTopic(topic)) << topic;
  }
}

}  // namespace
}  // namespace early_fusion::nodes
