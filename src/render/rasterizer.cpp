#include "early_fusion/render/rasterizer.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstring>
#include <string>

#include "early_fusion/core/error.h"
#include "early_fusion/core/image_size.h"
#include "early_fusion/core/random.h"
#include "fragment_shader.h"
#include "mesh_drawer.h"
#include "projection.h"
#include "render_assets.h"
#include "sample_buffer.h"
#include "sensor.h"
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

RenderPose distractorPose(const world::Distractor& one, double z) {
  Eigen::Isometry3d pose =
      Eigen::Translation3d(one.x, one.y, z) * Eigen::AngleAxisd(one.theta, Eigen::Vector3d::UnitZ());
  for (int axis = 0; axis < 3; ++axis) pose.linear().col(axis) *= one.size[axis];
  return renderPose(pose);
}

std::uint64_t bitsOfFloat(float value) {
  std::uint32_t bits;
  std::memcpy(&bits, &value, sizeof bits);
  return bits;
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
        shader_(*assets_, shadow_map_, image_size),
        counter_z_(world.placement.z) {}

  void setAppearance(std::shared_ptr<const world::Appearance> appearance) {
    std::shared_ptr<const world::Appearance> look = appearance ? std::move(appearance) : plain_;
    if (look == look_) return;
    checkFits(*look);
    setMaterials(*look);
    shader_.setLook(lightOf(*look), materials_.data());
    sensor_.setLook(look->sensor);
    if (look->towards_light != look_->towards_light) shadow_map_.setLight(look->towards_light);
    look_ = std::move(look);
    is_scene_set_ = false;
  }

  void setObjects(const std::vector<world::ObjectPose>& objects) {
    if (objects == objects_) return;
    objects_ = objects;
    is_scene_set_ = false;
  }

  void render(const Eigen::Isometry3d& world_from_camera, core::Image& image) {
    if (!is_scene_set_ || world_from_camera.matrix() != last_pose_.matrix()) {
      if (!is_scene_set_) setScene();
      draw(world_from_camera, last_image_);
      last_pose_ = world_from_camera;
    }
    image = last_image_;
  }

 private:
  /// @throws Error if the look is of another world.
  void checkFits(const world::Appearance& look) const {
    const std::size_t items = assets_->objects.size();
    const std::size_t parts = assets_->first_procedural_material - assets_->first_object_material.back();
    if ((!look.kitchen.empty() && look.kitchen.size() != parts) ||
        (!look.object_colors.empty() && look.object_colors.size() != items) ||
        look.distractors.size() > world::kMaxDistractors) {
      throw core::Error("the look is of another world: it has " + std::to_string(look.kitchen.size()) +
                        " parts of the kitchen, " + std::to_string(look.object_colors.size()) + " items and " +
                        std::to_string(look.distractors.size()) + " distractors; this world has " +
                        std::to_string(parts) + " and " + std::to_string(items) + ", and at most " +
                        std::to_string(world::kMaxDistractors) + " distractors are drawn");
    }
  }

  /// Gives the materials the look's colours and textures.
  void setMaterials(const world::Appearance& look) {
    materials_ = assets_->materials;
    for (std::size_t item = 0; item < look.object_colors.size(); ++item) {
      for (int i = assets_->first_object_material[item]; i < assets_->first_object_material[item + 1]; ++i) {
        setColor(materials_[i], look.object_colors[item]);
      }
    }
    for (std::size_t part = 0; part < look.kitchen.size(); ++part) {
      setSurface(materials_[assets_->first_object_material.back() + part], look.kitchen[part]);
    }
    for (std::size_t i = 0; i < look.distractors.size(); ++i) {
      setSurface(materials_[assets_->first_distractor_material + i], look.distractors[i].look);
    }
  }

  static void setColor(Material& material, const world::ColorFactors& color) {
    std::copy(color.begin(), color.end(), material.color);
  }

  void setSurface(Material& material, const world::SurfaceLook& look) const {
    setColor(material, look.color);
    material.repetitions = look.texture_scale;
    if (look.texture < 0) return;
    assert(look.texture < world::kProceduralTextures);
    const Material& procedural = assets_->materials[assets_->first_procedural_material + look.texture];
    material.first_texel = procedural.first_texel;
    material.size = procedural.size;
  }

  /// Puts the objects and the distractors into the scene, and draws their shadows.
  void setScene() {
    drawn_.clear();
    for (const world::ObjectPose& object : objects_) {
      assert(object.item >= 0 && object.item < static_cast<int>(assets_->objects.size()));
      drawn_.push_back({&assets_->objects[object.item], renderPose(object.world_from_object)});
    }
    for (std::size_t i = 0; i < look_->distractors.size(); ++i) {
      const world::Distractor& one = look_->distractors[i];
      drawn_.push_back({one.is_round ? &assets_->cylinders[i] : &assets_->boxes[i], distractorPose(one, counter_z_)});
    }
    shadow_map_.draw(drawn_);
    is_scene_set_ = true;
  }

  void draw(const Eigen::Isometry3d& world_from_camera, core::Image& image) {
    image.width = image.height = image_size_;
    image.rgb.resize(3u * image_size_ * image_size_);
    const Eigen::Isometry3d world_from_rolled =
        look_->camera_roll_rad == 0
            ? world_from_camera
            : world_from_camera * Eigen::AngleAxisd(look_->camera_roll_rad, Eigen::Vector3d::UnitZ());
    const Viewpoint viewpoint{renderPose(world_from_rolled), focal_length_ * static_cast<float>(look_->focal_factor),
                              centre_};
    const Projection projection = perspective(viewpoint);
    samples_.clear(0.f);
    drawer_.clear();
    for (const ShadowMap::Caster& object : drawn_) {
      drawer_.draw(*object.mesh, object.world_from_mesh, projection, samples_);
    }
    for (const RenderMesh& cluster : assets_->kitchen) drawer_.draw(cluster, identity_, projection, samples_);
    shader_.shade(viewpoint, drawer_, samples_, image);
    sensor_.expose(noiseSeed(viewpoint.world_from_camera), image);
  }

  /// The same for the same objects, seen from the same pose.
  std::uint64_t noiseSeed(const RenderPose& camera) const {
    if (look_->sensor.noise == 0) return 0;
    std::uint64_t seed = look_->noise_seed;
    const auto add = [&seed](const RenderPose& pose) {
      for (const auto& row : pose.rotation) {
        for (const float value : row) seed = core::Random(seed, {bitsOfFloat(value)}).next();
      }
      for (const float value : pose.translation) seed = core::Random(seed, {bitsOfFloat(value)}).next();
    };
    add(camera);
    for (const ShadowMap::Caster& object : drawn_) add(object.world_from_mesh);
    return seed;
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
  Sensor sensor_;
  std::vector<Material> materials_;  // with the look's colours and textures
  const std::shared_ptr<const world::Appearance> plain_ = std::make_shared<world::Appearance>();
  std::shared_ptr<const world::Appearance> look_ = plain_;
  double counter_z_;
  std::vector<world::ObjectPose> objects_;
  bool is_scene_set_ = false;  // whether drawn_ and the shadows are those of the objects and the look
  std::vector<ShadowMap::Caster> drawn_;
  core::Image last_image_;
  Eigen::Isometry3d last_pose_ = Eigen::Isometry3d::Identity();
  const RenderPose identity_ = renderPose(Eigen::Isometry3d::Identity());
};

Rasterizer::Rasterizer(const world::World& world, int image_size)
    : implementation_(std::make_unique<Implementation>(world, image_size)) {}

Rasterizer::~Rasterizer() = default;
Rasterizer::Rasterizer(Rasterizer&&) noexcept = default;
Rasterizer& Rasterizer::operator=(Rasterizer&&) noexcept = default;

void Rasterizer::setAppearance(std::shared_ptr<const world::Appearance> appearance) {
  implementation_->setAppearance(std::move(appearance));
}

void Rasterizer::setObjects(const std::vector<world::ObjectPose>& objects) { implementation_->setObjects(objects); }

void Rasterizer::render(const Eigen::Isometry3d& world_from_camera, core::Image& image) {
  implementation_->render(world_from_camera, image);
}

}  // namespace early_fusion::render
