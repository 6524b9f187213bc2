#include "early_fusion/world/yaml_entries.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <sstream>

#include "early_fusion/core/error.h"
#include "early_fusion/core/excerpt.h"
#include "early_fusion/core/names.h"

namespace early_fusion::world {

namespace {

constexpr double kMostMetres = 100;

/// Three numbers, each within [-most, most], or else `fault` as an error that shows the value.
Eigen::Vector3d readThree(const YAML::Node& value, double most, const std::string& file, const std::string& key,
                          const std::string& fault) {
  Eigen::Vector3d numbers = Eigen::Vector3d::Constant(NAN);
  try {
    if (value.IsSequence() && value.size() == 3) {
      for (int axis = 0; axis < 3; ++axis) numbers[axis] = value[axis].as<double>();
    }
  } catch (const YAML::Exception&) {
    numbers.setConstant(NAN);
  }
  if (numbers.allFinite() && numbers.cwiseAbs().maxCoeff() <= most) return numbers;
  std::ostringstream text;
  text << value;
  throw core::Error(place(file, value) + key + " is '" + core::excerpt(text.str()) + "'; it must be " + fault);
}

}  // namespace

std::string place(const std::string& file, const YAML::Node& node) {
  return file + ":" + std::to_string(node.Mark().line + 1) + ": ";
}

void checkKeys(const YAML::Node& map, const std::vector<std::string>& known, const std::string& file) {
  std::set<std::string> seen;
  for (const auto& entry : map) {
    const std::string key = entry.first.as<std::string>("");
    if (std::find(known.begin(), known.end(), key) == known.end()) {
      throw core::Error(place(file, entry.first) + "unknown key '" + core::excerpt(key) + "'; known are " +
                        core::joined(known));
    }
    if (!seen.insert(key).second) throw core::Error(place(file, entry.first) + key + " is given twice");
  }
}

std::string readText(const YAML::Node& entry, const std::string& key, const std::string& file,
                     const std::string& what) {
  const YAML::Node value = entry[key];
  const std::string text = value && value.IsScalar() ? value.as<std::string>() : "";
  if (text.empty()) {
    throw core::Error(place(file, value ? value : entry) + what + " needs a " + key + ", which is a text");
  }
  return text;
}

Eigen::Vector3d readPosition(const YAML::Node& value, const std::string& file) {
  if (!value) return Eigen::Vector3d::Zero();
  return readThree(value, kMostMetres, file, "position", "[x, y, z], each within [-100, 100] m");
}

Eigen::Quaterniond readRotation(const YAML::Node& value, const std::string& file) {
  if (!value) return Eigen::Quaterniond::Identity();
  const Eigen::Vector3d angles =
      readThree(value, 360, file, "rotation", "[roll, pitch, yaw], each within [-360, 360] degrees") * EIGEN_PI / 180;
  return Eigen::Quaterniond(Eigen::AngleAxisd(angles.z(), Eigen::Vector3d::UnitZ()) *
                            Eigen::AngleAxisd(angles.y(), Eigen::Vector3d::UnitY()) *
                            Eigen::AngleAxisd(angles.x(), Eigen::Vector3d::UnitX()));
}

}  // namespace early_fusion::world
