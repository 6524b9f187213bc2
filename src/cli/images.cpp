#include "images.h"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "early_fusion/model/annotation.h"
#include "early_fusion/model/saliency.h"
#include "early_fusion/render/rasterizer.h"

namespace early_fusion::cli {

namespace {

constexpr int kColumns = 4;
constexpr double kPi = 3.14159265358979323846;

cv::Mat view(const core::Image& image) {
  return cv::Mat(image.height, image.width, CV_8UC3, const_cast<std::uint8_t*>(image.rgb.data()));
}

/// A sheet of images of one size, kColumns in a row.
core::Image sheet(const std::vector<core::Image>& images) {
  const int width = images.front().width, height = images.front().height;
  const int rows = (static_cast<int>(images.size()) + kColumns - 1) / kColumns;
  core::Image result(kColumns * width, rows * height);
  for (std::size_t i = 0; i < images.size(); ++i) {
    const int column = static_cast<int>(i) % kColumns, row = static_cast<int>(i) / kColumns;
    view(images[i]).copyTo(view(result)(cv::Rect(column * width, row * height, width, height)));
  }
  return result;
}

/// The camera of a step, with the roll and the focal length of its look.
struct StepCamera {
  Eigen::Isometry3d camera_from_world;
  double fov_rad;  // horizontal
};

StepCamera cameraOf(const world::World& world, const PlayedStep& step) {
  static const world::Appearance kPlain;
  const world::Appearance& look = step.setup.appearance ? *step.setup.appearance : kPlain;
  const Eigen::AngleAxisd roll(look.camera_roll_rad, Eigen::Vector3d::UnitZ());
  const double tangent = std::tan(0.5 * world.options.horizontal_fov_deg * kPi / 180);
  return {(world.rig.worldFromCamera(step.state.orientation) * roll).inverse(),
          2 * std::atan(tangent / look.focal_factor)};
}

/// Where an object is in the frame; nothing if part of it is behind the camera or none of it is in view.
std::optional<model::Box> boxAround(const world::World& world, const sim::Instance& instance, const StepCamera& camera,
                                    int size) {
  const Eigen::Isometry3d camera_from_object = camera.camera_from_world * sim::worldFromObject(world, instance);
  const double focal_px = 0.5 * size / std::tan(0.5 * camera.fov_rad);
  Eigen::AlignedBox2d box;
  for (const Eigen::Vector3d& corner : world.objects[instance.item].hull) {
    const Eigen::Vector3d seen = camera_from_object * corner;
    if (seen.z() <= 0) return std::nullopt;
    box.extend((focal_px * seen.head<2>() / seen.z()).eval());
  }
  box.translate(Eigen::Vector2d::Constant(0.5 * size));
  if (!box.intersects(Eigen::AlignedBox2d(Eigen::Vector2d::Zero(), Eigen::Vector2d::Constant(size)))) {
    return std::nullopt;
  }
  const auto pixel = [](double value) { return static_cast<int>(std::lround(value)); };
  return model::Box{pixel(box.min().x()), pixel(box.min().y()), pixel(box.max().x()), pixel(box.max().y())};
}

std::vector<model::Box> boxesAroundRequested(const world::World& world, const PlayedStep& step,
                                             const StepCamera& camera, int size) {
  std::vector<model::Box> boxes;
  for (std::size_t i = 0; i < step.setup.instances.size(); ++i) {
    const sim::Instance& instance = step.setup.instances[i];
    const core::Request& request = step.state.request;
    const bool requested = std::find(request.begin(), request.end(), instance.item) != request.end();
    if (!requested || (step.state.present >> i & 1u) == 0) continue;
    if (const auto box = boxAround(world, instance, camera, size)) boxes.push_back(*box);
  }
  return boxes;
}

core::Image draw(render::Rasterizer& rasterizer, const world::World& world, const PlayedStep& step,
                 const ImageStyle& style) {
  core::Image image;
  rasterizer.setAppearance(step.setup.appearance);
  rasterizer.setObjects(sim::presentObjects(world, step.setup.instances, step.state.present));
  rasterizer.render(world.rig.worldFromCamera(step.state.orientation), image);
  model::Annotation annotation;
  if (style.annotate) {
    if (step.attention) model::tint(image, *step.attention);
    const StepCamera camera = cameraOf(world, step);
    annotation.cone_radius_px = model::coneRadiusPx(sim::kConeHalfAngleRad, camera.fov_rad, style.size);
    annotation.request = world.objects.vocabulary().names(step.state.request);
    annotation.boxes = boxesAroundRequested(world, step, camera, style.size);
    annotation.action = core::actionName(step.action);
    if (step.action != step.expert_action) {
      annotation.note = std::string("expert: ") + core::actionName(step.expert_action);
    }
  }
  return model::annotate(image, annotation, style.scale);
}

/// The lattice orientation whose optical axis passes nearest to a point in the world [m].
world::Orientation aimAt(const world::World& world, const Eigen::Vector3d& point) {
  const world::OrientationLattice& lattice = world.rig.lattice();
  world::Orientation best = lattice.lowest;
  double best_cosine = -2;
  for (int i = 0; i < lattice.size(); ++i) {
    const Eigen::Vector3d seen = world.rig.worldFromCamera(lattice.at(i)).inverse() * point;
    const double cosine = seen.normalized().z();
    if (cosine > best_cosine) {
      best_cosine = cosine;
      best = lattice.at(i);
    }
  }
  return best;
}

}  // namespace

std::vector<core::Image> drawSteps(const world::World& world, const std::vector<PlayedStep>& steps,
                                   const ImageStyle& style) {
  render::Rasterizer rasterizer(world, style.size);
  std::vector<core::Image> images;
  for (const PlayedStep& step : steps) images.push_back(draw(rasterizer, world, step, style));
  return images;
}

core::Image drawEpisode(const world::World& world, const std::vector<PlayedStep>& steps, const ImageStyle& style) {
  constexpr int kSpread = 5;  // steps between two images if no object is taken
  std::vector<PlayedStep> shown;
  for (std::size_t i = 0; i < steps.size(); ++i) {
    const bool last = i + 1 == steps.size();
    const bool takes = !last && steps[i + 1].state.present != steps[i].state.present;
    if (takes || last || i % kSpread == 0) shown.push_back(steps[i]);
  }
  return sheet(drawSteps(world, shown, style));
}

core::Image drawObjects(const world::World& world, std::shared_ptr<const world::Appearance> look,
                        const ImageStyle& style) {
  render::Rasterizer rasterizer(world, style.size);
  std::vector<core::Image> images;
  for (int item = 0; item < world.objects.size(); ++item) {
    PlayedStep step;
    const double x = 0.5 * (world.placement.min_x + world.placement.max_x);
    const double y = 0.5 * (world.placement.min_y + world.placement.max_y);
    step.setup.instances = {{item, x, y, 0.6}};
    step.setup.appearance = look;
    step.state.present = 1;
    step.state.orientation = aimAt(world, {x, y, world.placement.z + 0.06});
    core::Image image = draw(rasterizer, world, step, {style.size, style.scale, false});
    model::Annotation caption;
    caption.note = world.objects.vocabulary().name(item);
    images.push_back(model::annotate(image, caption, 1));
  }
  return sheet(images);
}

}  // namespace early_fusion::cli
