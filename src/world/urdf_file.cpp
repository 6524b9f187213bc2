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

std::string withoutComments(const std::string& xml) {
  std::string content;
  std::size_t at = 0;
  for (std::size_t begin; (begin = xml.find("<!--", at)) != std::string::npos;) {
    content.append(xml, at, begin - at);
    const std::size_t end = xml.find("-->", begin);
    if (end == std::string::npos) return content;
    at = end + 3;
  }
  return content.append(xml, at, std::string::npos);
}

/// @param reason set to what the parser complained of.
urdf::ModelInterfaceSharedPtr parse(const std::string& xml, const std::string& path, std::string& reason) {
  const std::string content = withoutComments(xml);
  if (content.find("<xacro:") != std::string::npos || content.find("=\"${") != std::string::npos) {
    throw core::Error(path + ": is a xacro file, not a URDF; run xacro first (xacro robot.urdf.xacro > robot.urdf)");
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
  return model;
}

}  // namespace

urdf::ModelInterfaceSharedPtr parseUrdf(const std::string& xml, const std::string& source) {
  std::string reason;
  return parse(xml, source, reason);
}

urdf::ModelInterfaceSharedPtr loadUrdf(const std::string& path) {
  return parseUrdf(core::readFile(path, core::kMaxTextBytes), path);
}

urdf::ModelInterfaceSharedPtr loadWholeUrdf(const std::string& path) {
  std::string reason;
  urdf::ModelInterfaceSharedPtr model = parse(core::readFile(path, core::kMaxTextBytes), path, reason);
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
