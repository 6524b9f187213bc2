#include "early_fusion/ros/virtual_robot/virtual_messages.h"

#include <boost/make_shared.hpp>
#include <cmath>

namespace early_fusion::nodes {

namespace {

constexpr int kOtherJoints = 20;
constexpr double kRawOverRectified = 1.2;  // focal lengths

void setMatrices(sensor_msgs::CameraInfo& info, double focal_length) {
  const double cx = info.width / 2.0 - 0.5, cy = info.height / 2.0 - 0.5;
  info.K = {focal_length, 0, cx, 0, focal_length, cy, 0, 0, 1};
  info.R = {1, 0, 0, 0, 1, 0, 0, 0, 1};
  info.P = {focal_length, 0, cx, 0, 0, focal_length, cy, 0, 0, 0, 1, 0};
}

double wrappedAngle(double angle_rad) {
  const double wrapped = std::fmod(angle_rad, 2 * M_PI);
  return wrapped < 0 ? wrapped + 2 * M_PI : wrapped;
}

void add(sensor_msgs::JointState& message, const std::string& name, double angle_rad) {
  message.name.push_back(name);
  message.position.push_back(angle_rad);
}

}  // namespace

sensor_msgs::ImagePtr sensorImageMessage(SensorImage image, const std_msgs::Header& header) {
  auto message = boost::make_shared<sensor_msgs::Image>();
  message->header = header;
  message->width = image.width;
  message->height = image.height;
  message->encoding = image.encoding;
  message->step = static_cast<std::uint32_t>(image.step);
  message->data = std::move(image.data);
  return message;
}

const std::vector<std::string>& virtualCalibrations() {
  static const std::vector<std::string> names = {"plain", "roi", "binning", "rectified", "uncalibrated"};
  return names;
}

sensor_msgs::CameraInfo virtualCameraInfo(const std::string& calibration, const VirtualLens& lens,
                                          const std_msgs::Header& header) {
  sensor_msgs::CameraInfo info;
  info.header = header;
  info.width = lens.width;
  info.height = lens.height;
  if (calibration == "uncalibrated") return info;
  info.distortion_model = "plumb_bob";
  info.D.assign(5, 0.0);
  double focal_length = lens.focalLength();
  if (calibration == "roi" || calibration == "binning") {
    info.width *= 2;
    info.height *= 2;
  }
  if (calibration == "roi") {
    info.roi.x_offset = lens.width / 2;
    info.roi.y_offset = lens.height / 2;
    info.roi.width = lens.width;
    info.roi.height = lens.height;
  }
  if (calibration == "binning") {
    info.binning_x = info.binning_y = 2;
    focal_length *= 2;
  }
  setMatrices(info, focal_length);
  if (calibration == "rectified") {
    info.D[0] = -0.3;
    info.K[0] = info.K[4] = kRawOverRectified * focal_length;
  }
  return info;
}

const std::vector<std::string>& virtualJointStateKinds() {
  static const std::vector<std::string> names = {"complete", "single", "crowded"};
  return names;
}

std::vector<sensor_msgs::JointState> virtualJointStates(const std::string& kind, bool wrapped,
                                                        const std::vector<std::string>& names,
                                                        const std::vector<double>& angles_rad,
                                                        const ::ros::Time& stamp) {
  std::vector<sensor_msgs::JointState> messages(kind == "single" ? names.size() : 1);
  for (sensor_msgs::JointState& message : messages) message.header.stamp = stamp;
  for (int i = 0; kind == "crowded" && i < kOtherJoints; ++i) add(messages[0], "arm_" + std::to_string(i), 0.1 * i);
  for (std::size_t i = 0; i < names.size(); ++i) {
    const double angle_rad = wrapped ? wrappedAngle(angles_rad[i]) : angles_rad[i];
    add(messages[kind == "single" ? i : 0], names[i], angle_rad);
  }
  return messages;
}

}  // namespace early_fusion::nodes
