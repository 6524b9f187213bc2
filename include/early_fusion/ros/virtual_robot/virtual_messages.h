#pragma once

#include <sensor_msgs/CameraInfo.h>
#include <sensor_msgs/Image.h>
#include <sensor_msgs/JointState.h>

#include <string>
#include <vector>

#include "early_fusion/ros/virtual_robot/virtual_camera.h"

namespace early_fusion::nodes {

sensor_msgs::ImagePtr sensorImageMessage(SensorImage image, const std_msgs::Header& header);

/// plain; roi: the middle of a sensor of twice the size; binning: of 2 x 2 pixels; rectified: K is of a distorted raw
/// image, P of this one; uncalibrated: zeros.
const std::vector<std::string>& virtualCalibrations();

/// @param calibration one of virtualCalibrations().
sensor_msgs::CameraInfo virtualCameraInfo(const std::string& calibration, const VirtualLens& lens,
                                          const std_msgs::Header& header);

/// complete: both joints in a message; single: one joint a message; crowded: among twenty others.
const std::vector<std::string>& virtualJointStateKinds();

/// @param kind one of virtualJointStateKinds(). @param wrapped angles in [0, 2 pi).
/// @param names, angles_rad of the joints, in the same order.
std::vector<sensor_msgs::JointState> virtualJointStates(const std::string& kind, bool wrapped,
                                                        const std::vector<std::string>& names,
                                                        const std::vector<double>& angles_rad,
                                                        const ::ros::Time& stamp);

}  // namespace early_fusion::nodes
