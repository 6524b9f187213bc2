#include <gtest/gtest.h>

#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <map>
#include <opencv2/imgcodecs.hpp>
#include <string>

#include "early_fusion/core/file.h"
#include "early_fusion/world/object_set.h"
#include "early_fusion/world/world.h"
#include "make_meshes/kitchen.h"
#include "make_meshes/objects.h"
#include "world/test_world.h"

namespace early_fusion {
namespace {

using make_meshes::Corner;
using make_meshes::Mesh;
using make_meshes::Model;
using make_meshes::Triangle;

const std::vector<Model>& objects() {
  static const std::vector<Model> models = make_meshes::makeObjects();
  return models;
}

const std::vector<Model>& kitchen() {
  static const std::vector<Model> models = make_meshes::makeKitchen();
  return models;
}

// Images are compared as pixels: other versions of zlib pack the same ones into other bytes.
void expectShipped(const std::string& name, const std::vector<Model>& models) {
  const world::TestFolder made;
  const std::string shipped = core::shareFolder() + "/meshes/" + name;
  std::size_t files = 0;
  for (const Model& model : models) {
    make_meshes::writeModel(made.path(), model);
    for (const char* suffix : {".obj", ".mtl"}) {
      const std::string file = "/" + model.name + suffix;
      EXPECT_TRUE(core::readFile(made.path() + file) == core::readFile(shipped + file)) << shipped + file;
    }
    const std::string image = "/" + model.name + ".png";
    const cv::Mat now = cv::imread(made.path() + image), then = cv::imread(shipped + image);
    ASSERT_EQ(now.size(), then.size()) << shipped + image;
    EXPECT_EQ(cv::norm(now, then, cv::NORM_INF), 0) << shipped + image;
    files += 3;
  }
  const std::filesystem::directory_iterator listing(shipped);
  EXPECT_EQ(static_cast<std::size_t>(std::distance(begin(listing), end(listing))), files)
      << "stray files in " << shipped;
}

using PointKey = std::array<long, 3>;

PointKey pointKey(const Eigen::Vector3d& position) {
  const auto micrometres = [](double metres) { return std::lround(metres * 1e6); };
  return {micrometres(position.x()), micrometres(position.y()), micrometres(position.z())};
}

// Edges that are not passed as often one way as the other: none on a closed surface.
int openEdges(const Mesh& mesh) {
  std::map<std::pair<PointKey, PointKey>, int> passes;
  for (const Triangle& triangle : mesh) {
    for (int i = 0; i < 3; ++i) {
      const PointKey from = pointKey(triangle[i].position), to = pointKey(triangle[(i + 1) % 3].position);
      ++passes[{from, to}];
      --passes[{to, from}];
    }
  }
  int open = 0;
  for (const auto& [edge, balance] : passes) open += balance != 0;
  return open;
}

// Fails when the tool was changed and its output was not, or the other way round.
TEST(ShippedMeshesTest, ObjectsAreWhatTheToolMakes) { expectShipped("objects", objects()); }
TEST(ShippedMeshesTest, KitchenIsWhatTheToolMakes) { expectShipped("kitchen", kitchen()); }

TEST(ShippedMeshesTest, ObjectSetListsEveryObjectInOrder) {
  const world::ObjectSet set = world::ObjectSet::load(core::shareFolder() + "/config/objects.yaml", 2000);
  ASSERT_EQ(set.size(), 16);
  ASSERT_EQ(objects().size(), 16u);
  for (int item = 0; item < set.size(); ++item) {
    EXPECT_EQ(set[item].name, objects()[item].name);
    EXPECT_EQ(set[item].mesh.triangleCount(), objects()[item].mesh.size()) << set[item].name;
  }
}

// Fails when a shape has too little detail, or more than a 128-pixel image can show.
TEST(ShippedMeshesTest, ObjectsHaveBetween500And2000Triangles) {
  for (const Model& model : objects()) {
    EXPECT_GE(model.mesh.size(), 500u) << model.name;
    EXPECT_LE(model.mesh.size(), 2000u) << model.name;
  }
}

TEST(ShippedMeshesTest, KitchenHasBetween800And2200Triangles) {
  std::size_t triangles = 0;
  for (const Model& model : kitchen()) triangles += model.mesh.size();
  EXPECT_GE(triangles, 800u);
  EXPECT_LE(triangles, 2200u);
}

// Fails for a hole, for triangles that face inwards and for neighbours that disagree.
TEST(ShippedMeshesTest, ObjectsAreClosedAndFaceOutwards) {
  for (const Model& model : objects()) {
    EXPECT_EQ(openEdges(model.mesh), 0) << model.name;
    EXPECT_GT(make_meshes::signedVolume(model.mesh), 5e-5) << model.name;
  }
}

TEST(ShippedMeshesTest, NormalsAreUnitVectorsOnTheOuterSide) {
  for (const Model& model : objects()) {
    for (const Triangle& triangle : model.mesh) {
      const Eigen::Vector3d face =
          (triangle[1].position - triangle[0].position).cross(triangle[2].position - triangle[0].position);
      for (const Corner& corner : triangle) {
        ASSERT_NEAR(corner.normal.norm(), 1, 1e-9) << model.name;
        ASSERT_GT(corner.normal.dot(face), 0) << model.name;
      }
    }
  }
}

// Fails when a face is drawn with a part of the texture that belongs to no part of the object.
TEST(ShippedMeshesTest, TextureCoordinatesOfObjectsLieInTheTexture) {
  for (const Model& model : objects()) {
    ASSERT_EQ(model.texture.size(), cv::Size(256, 256)) << model.name;
    for (const Triangle& triangle : model.mesh) {
      for (const Corner& corner : triangle) {
        ASSERT_GE(corner.uv.minCoeff(), 0) << model.name;
        ASSERT_LE(corner.uv.maxCoeff(), 1) << model.name;
      }
    }
  }
}

// How a texture lies on a triangle: the way on the surface for one width or height of the texture [m].
struct Print {
  Eigen::Vector3d right, down, outwards;
  double area;  // [m^2], twice
};

Print printOn(const Triangle& triangle) {
  Eigen::Matrix<double, 3, 2> edges;
  Eigen::Matrix2d uv_edges;
  for (int i = 0; i < 2; ++i) {
    edges.col(i) = triangle[i + 1].position - triangle[0].position;
    uv_edges.col(i) = triangle[i + 1].uv - triangle[0].uv;
  }
  const Eigen::Matrix<double, 3, 2> across = edges * uv_edges.inverse();
  const Eigen::Vector3d face = edges.col(0).cross(edges.col(1));
  return {across.col(0), across.col(1), face.normalized(), face.norm()};
}

const Model& object(const std::string& name) {
  return *std::find_if(objects().begin(), objects().end(), [&](const Model& model) { return model.name == name; });
}

// Fails if words on a side are mirrored or upside down, and if most of the print on the sides is stretched or
// compressed. Caps and rims, which have one colour, are the smaller part.
TEST(ShippedMeshesTest, PrintOnSidesIsUprightAndInProportion) {
  for (const char* name : {"cracker_box", "sugar_box", "tomato_soup_can", "mustard_bottle", "gelatin_box",
                           "potted_meat_can", "milk_carton"}) {
    double in_proportion = 0, all = 0;
    for (const Triangle& triangle : object(name).mesh) {
      const Print print = printOn(triangle);
      if (std::fabs(print.outwards.z()) > 0.2) continue;
      ASSERT_LT(print.right.cross(print.down).dot(print.outwards), 0) << name << " is printed mirrored";
      ASSERT_LT(print.down.z(), 0) << name << " is printed upside down";
      const double stretch = print.right.norm() / print.down.norm();
      all += print.area;
      in_proportion += std::fabs(std::log(stretch)) < std::log(1.1) ? print.area : 0;
    }
    EXPECT_GT(in_proportion, 0.75 * all) << name;
  }
}

// Share of a model's sides that face along an axis, give or take 14 degrees, in which the texture is red.
double redShare(const Model& model, int axis) {
  int red = 0, all = 0;
  for (const Triangle& triangle : model.mesh) {
    if (std::fabs(printOn(triangle).outwards[axis]) < 0.97 || triangle[0].position.z() > 0.14) continue;
    constexpr int kParts = 6;
    for (int i = 1; i < kParts; ++i) {
      for (int j = 1; i + j < kParts; ++j, ++all) {
        const Eigen::Vector2d uv =
            (i * triangle[0].uv + j * triangle[1].uv + (kParts - i - j) * triangle[2].uv) / kParts;
        const auto bgr = model.texture.at<cv::Vec3b>(int(256 * uv.y()), int(256 * uv.x()));
        red += bgr[2] > std::max(bgr[0], bgr[1]) + 80;
      }
    }
  }
  return static_cast<double>(red) / all;
}

// Fails if the print of a label, part of which is red, is on the narrow sides, which face along y.
TEST(ShippedMeshesTest, LabelsAreOnTheBroadSides) {
  for (const char* name : {"mustard_bottle", "potted_meat_can"}) {
    EXPECT_GT(redShare(object(name), 0), 0.05) << name;
    EXPECT_EQ(redShare(object(name), 1), 0) << name;
  }
}

// Fails for centimetres, for an object that lies down, and for one that does not stand on the origin.
TEST(ShippedMeshesTest, ObjectsHaveTheirTrueSizeAndStand) {
  const std::map<std::string, Eigen::Vector3d> sizes{// [m], give or take 15 %
                                                     {"cracker_box", {0.072, 0.164, 0.213}},
                                                     {"sugar_box", {0.049, 0.094, 0.176}},
                                                     {"tomato_soup_can", {0.068, 0.068, 0.102}},
                                                     {"mustard_bottle", {0.066, 0.097, 0.191}},
                                                     {"gelatin_box", {0.030, 0.089, 0.075}},
                                                     {"potted_meat_can", {0.060, 0.102, 0.084}},
                                                     {"banana", {0.070, 0.178, 0.037}},
                                                     {"peach", {0.064, 0.064, 0.062}},
                                                     {"sponge", {0.076, 0.112, 0.040}},
                                                     {"rubiks_cube", {0.058, 0.058, 0.058}},
                                                     {"mug", {0.084, 0.117, 0.090}},
                                                     {"bowl", {0.161, 0.161, 0.058}},
                                                     {"plate", {0.260, 0.260, 0.025}},
                                                     {"wine_glass", {0.080, 0.080, 0.200}},
                                                     {"apple", {0.077, 0.077, 0.088}},
                                                     {"milk_carton", {0.072, 0.072, 0.232}}};
  for (const Model& model : objects()) {
    const Eigen::AlignedBox3d box = make_meshes::bounds(model.mesh);
    const Eigen::Vector3d ratio = box.sizes().cwiseQuotient(sizes.at(model.name));
    EXPECT_GT(ratio.minCoeff(), 0.85) << model.name << ": " << box.sizes().transpose();
    EXPECT_LT(ratio.maxCoeff(), 1.15) << model.name << ": " << box.sizes().transpose();
    EXPECT_NEAR(box.min().z(), 0, 1e-9) << model.name;
    EXPECT_NEAR(box.center().head<2>().norm(), 0, 1e-9) << model.name;
  }
}

// Fails when a link of kitchen.urdf and a mesh part, and the objects would float above the counter or sink into it.
TEST(ShippedMeshesTest, CounterMeshEndsWhereObjectsStand) {
  const auto world = world::loadWorld(core::shareFolder() + "/config/world.yaml");
  EXPECT_NEAR(world->placement.z, 0.90, 1e-9);
  bool found = false;
  for (const world::FixedMesh& fixed : world->kitchen) {
    if (fixed.link != world->options.counter_link) continue;
    found = true;
    const Eigen::AlignedBox3d box = fixed.mesh.bounds().cast<double>().transformed(fixed.world_from_mesh);
    EXPECT_TRUE(box.min().isApprox(Eigen::Vector3d(0.45, -1.6, 0.86), 1e-5)) << box.min().transpose();
    EXPECT_TRUE(box.max().isApprox(Eigen::Vector3d(1.20, 1.6, 0.90), 1e-5)) << box.max().transpose();
  }
  EXPECT_TRUE(found);
}

}  // namespace
}  // namespace early_fusion
