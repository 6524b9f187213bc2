#include "early_fusion/ros/shared/camera_image.h"

#include <gtest/gtest.h>
#include <sensor_msgs/image_encodings.h>

#include <boost/make_shared.hpp>
#include <cmath>

#include "early_fusion/core/error.h"

namespace early_fusion::nodes {
namespace {

sensor_msgs::ImagePtr makeImage(int width, int height, const std::string& encoding, int channels) {
  auto image = boost::make_shared<sensor_msgs::Image>();
  image->width = width;
  image->height = height;
  image->encoding = encoding;
  image->step = width * channels;
  image->data.resize(image->step * height);
  for (std::size_t i = 0; i < image->data.size(); ++i) image->data[i] = static_cast<std::uint8_t>(i * 7);
  return image;
}

TEST(PolicyImage, AnImageOfTheRightSizeComesThroughBitForBit) {
  const auto image = makeImage(32, 32, "rgb8", 3);
  EXPECT_EQ(policyImage(image, 32, 32).rgb, image->data);
}

TEST(PolicyImage, ColoursAreReordered) {
  const auto image = makeImage(16, 16, "bgr8", 3);
  const core::Image result = policyImage(image, 16, 16);
  EXPECT_EQ(result.rgb[0], image->data[2]);
  EXPECT_EQ(result.rgb[1], image->data[1]);
  EXPECT_EQ(result.rgb[2], image->data[0]);
}

TEST(PolicyImage, RowsMayBePadded) {
  const auto tight = makeImage(16, 16, "rgb8", 3);
  auto padded = boost::make_shared<sensor_msgs::Image>(*tight);
  padded->step = 64;
  padded->data.assign(64 * 16, 0);
  for (int row = 0; row < 16; ++row) std::copy_n(&tight->data[48 * row], 48, &padded->data[64 * row]);
  EXPECT_EQ(policyImage(padded, 16, 16).rgb, tight->data);
}

TEST(PolicyImage, TheCentredSquareIsAveragedDown) {
  // 8 x 4: the square is columns 2 to 5; its left half is black, its right half white.
  const auto image = makeImage(8, 4, "mono8", 1);
  for (int y = 0; y < 4; ++y) {
    for (int x = 0; x < 8; ++x) image->data[8 * y + x] = x == 2 || x == 3 ? 0 : x < 2 ? 90 : 255;
  }
  const core::Image result = policyImage(image, 4, 2);
  EXPECT_EQ(result.rgb, (std::vector<std::uint8_t>{0, 0, 0, 255, 255, 255, 0, 0, 0, 255, 255, 255}));
}

TEST(PolicyImage, ASmallImageIsEnlarged) {
  const auto image = makeImage(10, 10, "rgb8", 3);
  const core::Image result = policyImage(image, 10, 30);
  EXPECT_EQ(result.width, 30);
  ASSERT_EQ(result.rgb.size(), 30u * 30 * 3);
  // A pixel becomes 3 x 3 of which the middle one has its colour, or one beside it by rounding.
  for (int y = 0; y < 10; ++y) {
    for (int x = 0; x < 10; ++x) {
      const std::size_t from = 3 * (10 * y + x), to = 3 * (30 * (3 * y + 1) + 3 * x + 1);
      for (int c = 0; c < 3; ++c) EXPECT_NEAR(result.rgb[to + c], image->data[from + c], 1) << x << ", " << y;
    }
  }
}

TEST(PolicyImage, WhatCannotBeConvertedIsRefusedWithItsEncodingAndSize) {
  for (const auto& image : {makeImage(20, 10, "nonsense", 3), makeImage(20, 10, "32FC2", 8)}) {
    try {
      policyImage(image, 10, 16);
      FAIL() << image->encoding;
    } catch (const core::Error& error) {
      EXPECT_NE(std::string(error.what()).find("20 x 10"), std::string::npos) << error.what();
      EXPECT_NE(std::string(error.what()).find(image->encoding), std::string::npos) << error.what();
    }
  }
}

TEST(PolicyImage, TruncatedOrEmptyImagesAreRefused) {
  const auto truncated = makeImage(20, 10, "rgb8", 3);
  truncated->data.resize(100);
  EXPECT_THROW(policyImage(truncated, 10, 16), core::Error);
  const auto narrow = makeImage(20, 10, "rgb8", 3);
  narrow->step = 20;  // rows shorter than their pixels
  EXPECT_THROW(policyImage(narrow, 10, 16), core::Error);
  EXPECT_THROW(policyImage(makeImage(0, 0, "rgb8", 3), 1, 16), core::Error);
}

TEST(CropEdge, FollowsTheFieldOfView) {
  const auto image = makeImage(640, 480, "rgb8", 3);
  sensor_msgs::CameraInfo info;
  info.width = 640;
  info.height = 480;
  info.K[0] = 300;
  // 2 f tan(30 degrees) = 346.4 pixels show 60 degrees.
  EXPECT_EQ(cropEdge(*image, &info, 60), 346);
  info.K[0] = 3000;  // a camera that shows less than 60 degrees: all of it
  EXPECT_EQ(cropEdge(*image, &info, 60), 480);
}

TEST(CropEdge, ScalesIntrinsicsOfABinnedImage) {
  const auto image = makeImage(320, 240, "rgb8", 3);
  sensor_msgs::CameraInfo info;
  info.width = 640;
  info.height = 480;
  info.K[0] = 300;
  EXPECT_EQ(cropEdge(*image, &info, 60), 173);
}

TEST(CropEdge, WithoutIntrinsicsIsTheShorterEdge) {
  const auto image = makeImage(640, 480, "rgb8", 3);
  const sensor_msgs::CameraInfo uncalibrated;
  EXPECT_EQ(cropEdge(*image, nullptr, 60), 480);
  EXPECT_EQ(cropEdge(*image, &uncalibrated, 60), 480);
}

}  // namespace
}  // namespace early_fusion::nodes
