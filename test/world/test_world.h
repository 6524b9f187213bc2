#pragma once

#include <stdlib.h>

#include <filesystem>
#include <functional>
#include <memory>
#include <sstream>
#include <string>
#include <vector>

#include "early_fusion/core/error.h"
#include "early_fusion/core/file.h"
#include "early_fusion/world/world.h"

namespace early_fusion::world {

/// A temporary folder that is removed with its contents.
class TestFolder {
 public:
  TestFolder() {
    std::string pattern = (std::filesystem::temp_directory_path() / "early_fusion_XXXXXX").string();
    path_ = mkdtemp(pattern.data());
  }
  ~TestFolder() { std::filesystem::remove_all(path_); }
  TestFolder(const TestFolder&) = delete;
  TestFolder& operator=(const TestFolder&) = delete;

  /// Writes `name` in the folder and returns its path.
  std::string write(const std::string& name, const std::string& text) const {
    core::writeFileAtomically(path_ + "/" + name, text);
    return path_ + "/" + name;
  }
  const std::string& path() const { return path_; }

 private:
  std::string path_;
};

/// The text of the Error that `action` throws; empty when it throws none.
inline std::string errorOf(const std::function<void()>& action) {
  try {
    action();
  } catch (const core::Error& error) {
    return error.what();
  }
  return "";
}

/// `text` with the first `from` replaced.
inline std::string replaced(std::string text, const std::string& from, const std::string& to) {
  const std::size_t at = text.find(from);
  if (at == std::string::npos) throw core::Error("the test's text has no '" + from + "'");
  return text.replace(at, from.size(), to);
}

/// A prism on a regular polygon, standing on z = bottom; four sides and a turn make a box.
inline std::string prismObj(int sides, double radius_x, double radius_y, double height, double bottom = 0) {
  std::ostringstream obj;
  for (int level = 0; level < 2; ++level) {
    for (int i = 0; i < sides; ++i) {
      const double angle = 2 * M_PI * (i + 0.5) / sides;
      obj << "v " << radius_x * std::cos(angle) << " " << radius_y * std::sin(angle) << " " << bottom + level * height
          << "\n";
    }
  }
  for (int i = 1; i + 1 < sides; ++i) {
    obj << "f " << 1 << " " << i + 2 << " " << i + 1 << "\nf " << sides + 1 << " " << sides + i + 1 << " "
        << sides + i + 2 << "\n";
  }
  for (int i = 0; i < sides; ++i) {
    const int next = (i + 1) % sides;
    obj << "f " << i + 1 << " " << next + 1 << " " << sides + next + 1 << "\nf " << i + 1 << " " << sides + next + 1
        << " " << sides + i + 1 << "\n";
  }
  return obj.str();
}

inline std::string boxObj(double x, double y, double z, double bottom = 0) {
  return prismObj(4, x * M_SQRT1_2, y * M_SQRT1_2, z, bottom);
}

/// A camera at (0, 0, 1.35) whose two axes meet in it: 41 pan steps, 16 tilt steps.
inline const char* const kRigUrdf = R"(<robot name="rig">
  <link name="world"/><link name="mount"/><link name="pan_link"/><link name="tilt_link"/><link name="eye"/>
  <joint name="mount_joint" type="fixed"><origin xyz="0 0 1.35"/><parent link="world"/><child link="mount"/></joint>
  <joint name="pan_joint" type="revolute"><parent link="mount"/><child link="pan_link"/><axis xyz="0 0 1"/>
    <limit lower="-0.698132" upper="0.698132" effort="1" velocity="1"/></joint>
  <joint name="tilt_joint" type="revolute"><origin xyz="0 0 0"/><parent link="pan_link"/><child link="tilt_link"/>
    <axis xyz="0 1 0"/><limit lower="0.209440" upper="0.733038" effort="1" velocity="1"/></joint>
  <joint name="eye_joint" type="fixed"><origin xyz="0 0 0" rpy="-1.570796326794897 0 -1.570796326794897"/>
    <parent link="tilt_link"/><child link="eye"/></joint>
</robot>)";

/// A counter whose top is x in [0.45, 1.2], y in [-1.6, 1.6] at z = 0.9.
inline const char* const kKitchenUrdf = R"(<robot name="kitchen">
  <material name="wood"><color rgba="0.6 0.4 0.2 1"/></material>
  <link name="world"/>
  <joint name="counter_joint" type="fixed"><origin xyz="0.825 0 0"/><parent link="world"/><child link="counter"/></joint>
  <link name="counter">
    <visual><origin xyz="0 0 0.88"/><geometry><box size="0.75 3.2 0.04"/></geometry><material name="wood"/></visual>
    <collision><origin xyz="0 0 0.88"/><geometry><box size="0.75 3.2 0.04"/></geometry></collision>
  </link>
</robot>)";

inline const char* const kObjectsYaml = R"(objects:
  - {name: box, mesh: box.obj, scale: 1}
  - {name: can, mesh: can.obj, scale: 1}
  - {name: cube, mesh: cube.obj, scale: 0.001}
  - {name: plate, mesh: plate.obj, scale: [2, 2, 1]}
)";

inline const char* const kWorldYaml = R"(kitchen_urdf: kitchen.urdf
camera_urdf: rig.urdf
optical_frame: eye
placement_width: 1.2
placement_depth: 0.5
)";

/// Writes the files of a small world, ready to be overwritten, and returns the path of its world.yaml.
inline std::string writeTestWorld(const TestFolder& folder) {
  folder.write("box.obj", boxObj(0.06, 0.16, 0.21));
  folder.write("can.obj", prismObj(16, 0.034, 0.034, 0.1, -0.05));
  folder.write("cube.obj", boxObj(57, 57, 57, 12));
  folder.write("plate.obj", prismObj(24, 0.06, 0.06, 0.02));
  folder.write("objects.yaml", kObjectsYaml);
  folder.write("rig.urdf", kRigUrdf);
  folder.write("kitchen.urdf", kKitchenUrdf);
  return folder.write("world.yaml", kWorldYaml);
}

inline std::shared_ptr<const World> testWorld() {
  const TestFolder folder;
  return loadWorld(writeTestWorld(folder));
}

}  // namespace early_fusion::world
