// An image message with its camera_info: the crop to the policy's view, and the frame that the policy sees.
#include "early_fusion/ros/shared/camera_image.h"
#include "fuzz_target.h"

using namespace early_fusion;

namespace {

constexpr int kFrameSize = 16;

sensor_msgs::CameraInfo readInfo(fuzz::Reader& input) {
  sensor_msgs::CameraInfo info;
  info.width = input.number<std::uint32_t>();
  info.height = input.number<std::uint32_t>();
  for (double& value : info.K) value = input.number<float>();
  for (double& value : info.P) value = input.number<float>();
  info.binning_x = input.number<std::uint32_t>();
  info.binning_y = input.number<std::uint32_t>();
  info.roi.x_offset = input.number<std::uint32_t>();
  info.roi.y_offset = input.number<std::uint32_t>();
  info.roi.width = input.number<std::uint32_t>();
  info.roi.height = input.number<std::uint32_t>();
  return info;
}

}  // namespace

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  fuzz::Reader input(data, size);
  sensor_msgs::Image image;
  image.encoding = input.text();
  image.width = input.number<std::uint32_t>();
  image.height = input.number<std::uint32_t>();
  image.step = input.number<std::uint32_t>();
  image.is_bigendian = input.number<std::uint8_t>();
  const bool rectified = input.number<std::uint8_t>() % 2 != 0;
  const double field_of_view_deg = 1 + input.number<std::uint8_t>() % 179;
  const sensor_msgs::CameraInfo info = readInfo(input);
  const std::string pixels = input.rest();
  image.data.assign(pixels.begin(), pixels.end());
  fuzz::allowError([&] {
    const nodes::Crop crop = nodes::cropToView(image, &info, rectified, field_of_view_deg);
    fuzz::require(crop.warning.size() <= fuzz::kMaxErrorBytes, "a long warning");
    const core::Image frame = nodes::policyImage(image, crop, kFrameSize);
    fuzz::require(frame.rgb.size() == 3 * kFrameSize * kFrameSize, "the size of the frame");
  });
  return 0;
}
