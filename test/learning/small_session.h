#pragma once

#include <unistd.h>

#include <filesystem>
#include <string>

#include "early_fusion/core/file.h"

namespace early_fusion::learning {

/// Files of a world, a task and a preset so small that a whole session takes seconds; removed with the object.
class SmallSession {
 public:
  static constexpr int kImageSize = 32;
  static constexpr int kSteps = 8;
  static constexpr int kTrajectories = 6;
  static constexpr int kEvaluationEpisodes = 3;

  SmallSession() {
    const std::string share = core::shareFolder();
    write("world.yaml", "objects: " + share + "/config/objects.yaml\nkitchen_urdf: " + share +
                            "/urdf/kitchen.urdf\ncamera_urdf: " + share +
                            "/urdf/pan_tilt_camera.urdf\nimage_size: " + std::to_string(kImageSize) + "\n");
    write("short.yaml", "{instances: 3, requested: 2, steps: " + std::to_string(kSteps) + "}");
    write(
        "tiny.yaml",
        "{trajectories: " + std::to_string(kTrajectories) +
            ", max_instances: 5, held_out_pairs: 0.5, trajectories_per_round: 2, window: 4, epochs: 1, batch_size: 8, "
            "learning_rate: 1e-3, image_size: " +
            std::to_string(kImageSize) + ", precision: f32}");
  }
  ~SmallSession() { std::filesystem::remove_all(folder_); }
  SmallSession(const SmallSession&) = delete;
  SmallSession& operator=(const SmallSession&) = delete;

  std::string path(const std::string& name) const { return (folder_ / name).string(); }
  std::string world() const { return path("world.yaml"); }
  std::string task() const { return path("short.yaml"); }
  std::string preset() const { return path("tiny.yaml"); }

 private:
  void write(const std::string& name, const std::string& text) { core::writeFileAtomically(path(name), text); }

  const std::filesystem::path folder_ =
      std::filesystem::temp_directory_path() / ("early_fusion_small_session" + std::to_string(::getpid()));
};

}  // namespace early_fusion::learning
