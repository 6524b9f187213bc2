#include "urdf_file.h"

#include <console_bridge/console.h>
#include <urdf_parser/urdf_parser.h>

#include <exception>

#include "early_fusion/core/error.h"
#include "early_fusion/core/file.h"

namespace early_fusion::world {

namespace {

/// Captures urdfdom's output, because urdfdom reports the reason of a failure nowhere else.
class Complaints : public console_bridge::OutputHandler {
 public:
  Complaints() { console_bridge::useOutputHandler(this); }
  ~Complaints() override { console_bridge::restorePreviousOutputHandler(); }

  void log(const std::string& text, console_bridge::LogLevel level, const char*, int) override {
    if (level >= console_bridge::CONSOLE_BRIDGE_LOG_ERROR) text_ += (text_.empty() ? "" : "; ") + text;
  }

  const std::string& text() const { return text_; }

 private:
  std::string text_;
};

/// @param reason set to what the parser complained of.
urdf::ModelInterfaceSharedPtr parse(const std::string& xml, const std::string& path, std::string& reason) {
  if (xml.find("<xacro:") != std::string::npos) {
    throw core::Error(path + ": is a xacro file, not a URDF; run xacro first (xacro robot.urdf.xacro > robot.urdf)");
  }
  Complaints complaints;
  urdf::ModelInterfaceSharedPtr model;
  try {
    model = urdf::parseURDF(xml);
    reason = complaints.text();
  } catch (const std::exception& error) {
    reason = error.what();
  }
  if (model && model->getRoot()) return model;
  throw core::Error(path + ": not a valid URDF: " + (reason.empty() ? "no root link" : reason));
}

}  // namespace

urdf::ModelInterfaceSharedPtr parseUrdf(const std::string& xml, const std::string& source) {
  std::string reason;
  return parse(xml, source, reason);
}

urdf::ModelInterfaceSharedPtr loadUrdf(const std::string& path) { return parseUrdf(core::readFile(path), path); }

urdf::ModelInterfaceSharedPtr loadWholeUrdf(const std::string& path) {
  std::string reason;
  urdf::ModelInterfaceSharedPtr model = parse(core::readFile(path), path, reason);
  if (reason.empty()) return model;
  throw core::Error(path + ": a part cannot be read: " + reason +
                    "; shapes are box, cylinder, sphere and mesh, with positive sizes");
}

Eigen::Vector3d toEigen(const urdf::Vector3& vector) { return Eigen::Vector3d(vector.x, vector.y, vector.z); }

Eigen::Isometry3d toEigen(const urdf::Pose& pose) {
  const urdf::Rotation& q = pose.rotation;
  return Eigen::Translation3d(toEigen(pose.position)) * Eigen::Quaterniond(q.w, q.x, q.y, q.z).normalized();
}

}  // namespace early_fusion::world
