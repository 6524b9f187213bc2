#include "early_fusion/render/rasterizer.h"

#include <cassert>
#include <cmath>
#include <string>

#include "early_fusion/core/image_size.h"
#include "fragment_shader.h"
#include "mesh_drawer.h"
#include "projection.h"
#include "render_assets.h"
#include "sample_buffer.h"
#include "shadow_map.h"

namespace early_fusion::render {

namespace {

static_assert(core::kMaxImageSize == kMaxScreenSize / 2 / core::kImageSizeStep * core::kImageSizeStep);

int checkedSize(int image_size) {
  core::OptionSet set("rasterizer");
  core::addImageSize(set, "image_size", image_size, "");
  set.validate("rasterizer");
  return image_size;
}

LinearForm cameraAxis(const RenderPose& world_from_camera, int axis) {
  LinearForm form{{0.f, 0.f, 0.f}, 0.f};
  for (int row = 0; row < 3; ++row) {
    form.factor[row] = world_from_camera.rotation[row][axis];
    form.constant -= form.factor[row] * world_from_camera.translation[row];
  }
  return form;
}

Projection perspective(const Viewpoint& viewpoint) {
  Projection projection;
  projection.x = viewpoint.focal_length * cameraAxis(viewpoint.world_from_camera, 0);
  projection.y = viewpoint.focal_length * cameraAxis(viewpoint.world_from_camera, 1);
  projection.w = cameraAxis(viewpoint.world_from_camera, 2);
  projection.depth = {};
  projection.half_width = projection.half_height = viewpoint.centre;
  return projection;
}

}  // namespace

class Rasterizer::Implementation {
 public:
  Implementation(const world::World& world, int image_size)
      : image_size_(checkedSize(image_size)),
        centre_(static_cast<float>(image_size * kSubsamples)),
        focal_length_(static_cast<float>(2 * kSubsamples * focalLength(image_size, world.options.horizontal_fov_deg))),
        assets_(sharedRenderAssets(world)),
        shadow_map_(world),
        samples_(2 * image_size, 2 * image_size, true),
        shader_(*assets_, shadow_map_, image_size) {}

  void setObjects(const std::vector<world::ObjectPose>& objects) {
    if (objects == objects_) return;
    objects_ = objects;
    last_image_.rgb.clear();
    drawn_.clear();
    for (const world::ObjectPose& object : objects_) {
      assert(object.item >= 0 && object.item < static_cast<int>(assets_->objects.size()));
      drawn_.push_back({&assets_->objects[object.item], renderPose(object.world_from_object)});
    }
    shadow_map_.draw(drawn_);
  }

  void render(const Eigen::Isometry3d& world_from_camera, core::Image& image) {
    if (last_image_.rgb.empty() || world_from_camera.matrix() != last_pose_.matrix()) {
      draw(world_from_camera, last_image_);
      last_pose_ = world_from_camera;
    }
    image = last_image_;
  }

 private:
  void draw(const Eigen::Isometry3d& world_from_camera, core::Image& image) {
    image.width = image.height = image_size_;
    image.rgb.resize(3u * image_size_ * image_size_);
    const Viewpoint viewpoint{renderPose(world_from_camera), focal_length_, centre_};
    const Projection projection = perspective(viewpoint);
    samples_.clear(0.f);
    drawer_.clear();
    for (const ShadowMap::Caster& object : drawn_) {
      drawer_.draw(*object.mesh, object.world_from_mesh, projection, samples_);
    }
    for (const RenderMesh& cluster : assets_->kitchen) drawer_.draw(cluster, identity_, projection, samples_);
    shader_.shade(viewpoint, drawer_, samples_, image);
  }

  static double focalLength(int image_size, double fov_deg) {
    return 0.5 * image_size / std::tan(0.5 * fov_deg * 3.14159265358979323846 / 180.0);
  }

  int image_size_;
  float centre_;        // of the image [subsamples]
  float focal_length_;  // [subsamples]
  std::shared_ptr<const RenderAssets> assets_;
  ShadowMap shadow_map_;
  SampleBuffer samples_;
  MeshDrawer drawer_;
  FragmentShader shader_;
  std::vector<world::ObjectPose> objects_;
  std::vector<ShadowMap::Caster> drawn_;
  core::Image last_image_;  // empty if the objects have changed since
  Eigen::Isometry3d last_pose_ = Eigen::Isometry3d::Identity();
  const RenderPose identity_ = renderPose(Eigen::Isometry3d::Identity());
};

Rasterizer::Rasterizer(const world::World& world, int image_size)
    : implementation_(std::make_unique<Implementation>(world, image_size)) {}

Rasterizer::~Rasterizer() = default;
Rasterizer::Rasterizer(Rasterizer&&) noexcept = default;
Rasterizer& Rasterizer::operator=(Rasterizer&&) noexcept = default;

void Rasterizer::setObjects(const std::vector<world::ObjectPose>& objects) { implementation_->setObjects(objects); }

void Rasterizer::render(const Eigen::Isometry3d& world_from_camera, core::Image& image) {
  implementation_->render(world_from_camera, image);
}

}  // namespace early_fusion::render
