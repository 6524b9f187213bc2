#include "urdf_file.h"

#include <console_bridge/console.h>
#include <urdf_parser/urdf_parser.h>

#include <exception>
#include <sstream>

#include "early_fusion/core/error.h"
#include "early_fusion/core/excerpt.h"
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

constexpr int kMaxDepth = 64;  // of elements: a URDF needs six

/// The parser calls itself for each level, so a deep text would overflow the stack. Comments and processing
/// instructions count as no level.
void checkDepth(const std::string& xml, const std::string& path) {
  int depth = 0;
  for (std::size_t at = xml.find('<'); at != std::string::npos; at = xml.find('<', at + 1)) {
    if (xml.compare(at, 4, "<!--") == 0) {
      at = xml.find("-->", at);
      if (at == std::string::npos) return;  // the parser reports it
      continue;
    }
    const char next = at + 1 < xml.size() ? xml[at + 1] : '\0';
    if (next == '?' || next == '!') continue;
    const std::size_t end = xml.find('>', at);
    if (end == std::string::npos) return;
    if (next == '/') {
      --depth;
    } else if (xml[end - 1] != '/') {
      ++depth;
    }
    if (depth > kMaxDepth) {
      throw core::Error(path + ": not a valid URDF: its elements are nested more than " + std::to_string(kMaxDepth) +
                        " deep");
    }
  }
}

/// urdfdom accepts links that are their own ancestors. A walk to the root would never end. @throws Error naming a link.
void checkTree(const urdf::ModelInterface& model, const std::string& path) {
  for (const auto& [name, first] : model.links_) {
    urdf::LinkConstSharedPtr link = first;
    for (std::size_t steps = 0; link && link->parent_joint; ++steps) {
      if (steps == model.links_.size()) {
        throw core::Error(path + ": link '" + core::excerpt(name) +
                          "' is its own ancestor; a URDF must be a tree without loops");
      }
      link = model.getLink(link->parent_joint->parent_link_name);
    }
  }
}

void checkLimits(const urdf::ModelInterface& model, const std::string& path) {
  for (const auto& [name, joint] : model.joints_) {
    if (!joint->limits || joint->limits->lower <= joint->limits->upper) continue;
    std::ostringstream text;
    text << path << ": joint '" << core::excerpt(name) << "' has the lower limit " << joint->limits->lower
         << ", which is not below its upper limit " << joint->limits->upper;
    throw core::Error(text.str());
  }
}

/// @param reason set to what the parser complained of.
urdf::ModelInterfaceSharedPtr parse(const std::string& path, std::string& reason) {
  const std::string xml = core::readFile(path, core::kMaxTextBytes);
  if (xml.find("<xacro:") != std::string::npos) {
    throw core::Error(path + ": needs xacro; expand it first: xacro FILE > FILE.urdf");
  }
  checkDepth(xml, path);
  Complaints complaints;
  urdf::ModelInterfaceSharedPtr model;
  try {
    model = urdf::parseURDF(xml);
    reason = complaints.text();
  } catch (const std::exception& error) {
    reason = error.what();
  }
  if (!model || !model->getRoot()) {
    throw core::Error(path + ": not a valid URDF: " + (reason.empty() ? "no root link" : core::excerpt(reason, 300)));
  }
  checkTree(*model, path);
  checkLimits(*model, path);
  return model;
}

}  // namespace

urdf::ModelInterfaceSharedPtr loadUrdf(const std::string& path) {
  std::string reason;
  return parse(path, reason);
}

urdf::ModelInterfaceSharedPtr loadWholeUrdf(const std::string& path) {
  std::string reason;
  urdf::ModelInterfaceSharedPtr model = parse(path, reason);
  if (reason.empty()) return model;
  throw core::Error(path + ": a part cannot be read: " + core::excerpt(reason, 300) +
                    "; shapes are box, cylinder, sphere and mesh, with positive sizes");
}

Eigen::Vector3d toEigen(const urdf::Vector3& vector) { return Eigen::Vector3d(vector.x, vector.y, vector.z); }

Eigen::Isometry3d toEigen(const urdf::Pose& pose) {
  const urdf::Rotation& q = pose.rotation;
  return Eigen::Translation3d(toEigen(pose.position)) * Eigen::Quaterniond(q.w, q.x, q.y, q.z).normalized();
}

}  // namespace early_fusion::world
