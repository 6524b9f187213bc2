#pragma once

#include <yaml-cpp/yaml.h>

#include <Eigen/Geometry>
#include <string>
#include <vector>

namespace early_fusion::world {

// Reading lists of maps in YAML files. @param file names the file in errors.

/// "FILE:LINE: ", for errors.
std::string place(const std::string& file, const YAML::Node& node);

/// @throws Error naming a key that is unknown or is given twice.
void checkKeys(const YAML::Node& map, const std::vector<std::string>& known, const std::string& file);

/// The text of a key. @param what has the key: "an object". @throws Error if it is missing or no text.
std::string readText(const YAML::Node& entry, const std::string& key, const std::string& file, const std::string& what);

/// The map's "position", [x, y, z] in metres; the origin if absent. @throws Error naming the value.
Eigen::Vector3d readPosition(const YAML::Node& value, const std::string& file);

/// The map's "rotation", [roll, pitch, yaw] in degrees about the fixed axes x, y and z, in this order; no rotation if
/// absent. @throws Error naming the value.
Eigen::Quaterniond readRotation(const YAML::Node& value, const std::string& file);

}  // namespace early_fusion::world
