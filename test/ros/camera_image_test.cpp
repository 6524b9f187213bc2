#include "early_fusion/ros/shared/camera_image.h"

#include <gtest/gtest.h>
#include <sensor_msgs/image_encodings.h>

#include <array>
#include <boost/make_shared.hpp>

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

/// The centred square of an image.
Crop squareOf(int width, int height, int edge) { return {(width - edge) / 2, (height - edge) / 2, edge, edge, ""}; }

TEST(PolicyImage, AnImageOfTheRightSizeComesThroughBitForBit) {
  const auto image = makeImage(32, 32, "rgb8", 3);
  EXPECT_EQ(policyImage(*image, squareOf(32, 32, 32), 32).rgb, image->data);
}

TEST(PolicyImage, ColoursAreReordered) {
  const auto image = makeImage(16, 16, "bgr8", 3);
  const core::Image result = policyImage(*image, squareOf(16, 16, 16), 16);
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
  EXPECT_EQ(policyImage(*padded, squareOf(16, 16, 16), 16).rgb, tight->data);
}

TEST(PolicyImage, TheCentredSquareIsAveragedDown) {
  // 8 x 4: the square is columns 2 to 5; its left half is black, its right half white.
  const auto image = makeImage(8, 4, "mono8", 1);
  for (int y = 0; y < 4; ++y) {
    for (int x = 0; x < 8; ++x) image->data[8 * y + x] = x == 2 || x == 3 ? 0 : x < 2 ? 90 : 255;
  }
  const core::Image result = policyImage(*image, squareOf(8, 4, 4), 2);
  EXPECT_EQ(result.rgb, (std::vector<std::uint8_t>{0, 0, 0, 255, 255, 255, 0, 0, 0, 255, 255, 255}));
}

TEST(PolicyImage, ASmallImageIsEnlarged) {
  const auto image = makeImage(10, 10, "rgb8", 3);
  const core::Image result = policyImage(*image, squareOf(10, 10, 10), 30);
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
      policyImage(*image, squareOf(20, 10, 10), 16);
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
  EXPECT_THROW(policyImage(*truncated, squareOf(20, 10, 10), 16), core::Error);
  const auto narrow = makeImage(20, 10, "rgb8", 3);
  narrow->step = 20;  // rows shorter than their pixels
  EXPECT_THROW(policyImage(*narrow, squareOf(20, 10, 10), 16), core::Error);
  EXPECT_THROW(policyImage(*makeImage(0, 0, "rgb8", 3), Crop(), 16), core::Error);
}

TEST(PolicyImage, AnUnknownEncodingIsRefusedWithTheKnownOnesAndADepthImageAsSuch) {
  const auto errorOf = [](const std::string& encoding) -> std::string {
    try {
      policyImage(*makeImage(20, 10, encoding, 3), squareOf(20, 10, 10), 16);
    } catch (const core::Error& error) {
      return error.what();
    }
    return "no error";
  };
  for (const char* known : {"rgb8", "bayer_rggb8", "yuv422_yuy2", "mono16"}) {
    EXPECT_NE(errorOf("nv21").find(known), std::string::npos) << errorOf("nv21");
  }
  EXPECT_LT(errorOf(std::string(100000, 'x')).size(), 1000u) << "a foreign text is shown whole";
  EXPECT_NE(errorOf("16UC1").find("depth image"), std::string::npos) << errorOf("16UC1");
}

TEST(PolicyImage, RowsAfterTheLastAreIgnored) {
  const auto image = makeImage(16, 16, "rgb8", 3);
  const std::vector<std::uint8_t> pixels = image->data;
  image->data.resize(pixels.size() + 5 * image->step, 99);
  EXPECT_EQ(policyImage(*image, squareOf(16, 16, 16), 16).rgb, pixels);
}

TEST(PolicyImage, EightBitMatricesAreTakenAsOpenCvStoresThem) {
  const auto bgr = makeImage(16, 16, "bgr8", 3);
  const auto matrix = makeImage(16, 16, "8UC3", 3);
  EXPECT_EQ(policyImage(*matrix, squareOf(16, 16, 16), 16).rgb, policyImage(*bgr, squareOf(16, 16, 16), 16).rgb);
}

TEST(PolicyImage, SixteenBitsAreReadInTheirByteOrder) {
  const auto little = makeImage(16, 16, "mono16", 2);
  for (int i = 0; i < 256; ++i) {
    little->data[2 * i] = 0x34;
    little->data[2 * i + 1] = static_cast<std::uint8_t>(i);
  }
  const auto big = boost::make_shared<sensor_msgs::Image>(*little);
  big->is_bigendian = 1;
  for (int i = 0; i < 256; ++i) std::swap(big->data[2 * i], big->data[2 * i + 1]);
  const core::Image seen = policyImage(*little, squareOf(16, 16, 16), 16);
  EXPECT_NEAR(seen.rgb[3 * 200], 200, 1);
  EXPECT_EQ(policyImage(*big, squareOf(16, 16, 16), 16).rgb, seen.rgb);
}

/// A plane of one colour in an encoding of 16 x 16 pixels.
struct Coloured {
  std::string encoding;
  std::vector<std::uint8_t> rows[2];  ///< the first bytes of even and odd rows, repeated
};

TEST(PolicyImage, BayerPatternsAndYuvShowTheirColour) {
  // Orange: red 200, green 100, blue 20.
  const std::vector<Coloured> cases = {{"bayer_rggb8", {{200, 100}, {100, 20}}},
                                       {"bayer_bggr8", {{20, 100}, {100, 200}}},
                                       {"bayer_gbrg8", {{100, 20}, {200, 100}}},
                                       {"bayer_grbg8", {{100, 200}, {20, 100}}},
                                       {"bayer_rggb16", {{0, 200, 0, 100}, {0, 100, 0, 20}}},
                                       {"yuv422", {{78, 120, 178, 120}, {78, 120, 178, 120}}},
                                       {"yuv422_yuy2", {{120, 78, 120, 178}, {120, 78, 120, 178}}}};
  for (const Coloured& c : cases) {
    const bool two_bytes = c.encoding.back() == '6' || c.encoding.find("yuv") == 0;
    const auto image = makeImage(16, 16, c.encoding, two_bytes ? 2 : 1);
    for (std::size_t i = 0; i < image->data.size(); ++i) {
      const std::vector<std::uint8_t>& row = c.rows[i / image->step % 2];
      image->data[i] = row[i % image->step % row.size()];
    }
    for (const int edge : {16, 9}) {  // 9: the part begins in the middle of a pattern
      const core::Image seen = policyImage(*image, squareOf(16, 16, edge), 8);
      for (std::size_t i = 0; i < seen.rgb.size(); ++i) {
        EXPECT_NEAR(seen.rgb[i], (std::array{200, 100, 20})[i % 3], 2) << c.encoding << ", byte " << i;
      }
    }
  }
}

TEST(PolicyImage, APartOfABayerImageIsConvertedAsTheWhole) {
  const auto image = makeImage(30, 22, "bayer_grbg8", 1);
  const core::Image whole = policyImage(*image, {0, 0, 30, 22, ""}, 32);  // enlarged: not compared, must not fail
  EXPECT_EQ(whole.width, 32);
  const core::Image part = policyImage(*image, {7, 5, 11, 11, ""}, 11),
                    larger = policyImage(*image, {5, 3, 15, 15, ""}, 15);
  for (int y = 0; y < 11; ++y) {
    for (int x = 0; x < 33; ++x) EXPECT_EQ(part.rgb[33 * y + x], larger.rgb[45 * (y + 2) + 6 + x]) << x << ", " << y;
  }
}

TEST(PolicyImage, YuvOfAnOddWidthIsRefused) {
  EXPECT_THROW(policyImage(*makeImage(15, 10, "yuv422", 2), squareOf(15, 10, 10), 16), core::Error);
}

}  // namespace
}  // namespace early_fusion::nodes
