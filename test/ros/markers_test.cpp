#include "early_fusion/ros/simulator/markers.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "early_fusion/core/file.h"
#include "early_fusion/expert/greedy_expert.h"
#include "learning/small_session.h"

namespace early_fusion::nodes {
namespace {

class MarkersTest : public testing::Test {
 protected:
  int count(const visualization_msgs::MarkerArray& array, const std::string& ns) const {
    return std::count_if(array.markers.begin(), array.markers.end(),
                         [&](const visualization_msgs::Marker& marker) { return marker.ns == ns; });
  }

  const learning::SmallSession files_;
  const std::shared_ptr<const world::World> world_ = world::loadWorld(files_.world());
  const sim::Task task_ = sim::loadTask("medium");
  sim::Episode episode_{*world_, {task_, 1, 0}};
};

TEST_F(MarkersTest, ShowAMeshForEachObjectWhereItStands) {
  const visualization_msgs::MarkerArray array = objectMarkers(*world_, episode_, {});
  EXPECT_EQ(array.markers[0].action, visualization_msgs::Marker::DELETEALL);
  EXPECT_EQ(count(array, "objects"), task_.instances);
  EXPECT_GE(count(array, "requested"), 1);
  for (const visualization_msgs::Marker& marker : array.markers) {
    if (marker.ns != "objects") continue;
    const sim::Instance& instance = episode_.setup().instances[marker.id];
    const world::Object& object = world_->objects[instance.item];
    EXPECT_EQ(marker.mesh_resource, meshUrl(object.mesh_file));
    // A corner of the file, through the marker's scale and pose, is the corner of the mesh in the world.
    const Eigen::Vector3d in_object = object.mesh.parts[0].vertices[0].position.cast<double>();
    const Eigen::Vector3d in_file =
        (object.mesh_rotation.inverse() * (in_object + object.mesh_origin)).cwiseQuotient(object.mesh_scale);
    const Eigen::Quaterniond rotation(marker.pose.orientation.w, marker.pose.orientation.x, marker.pose.orientation.y,
                                      marker.pose.orientation.z);
    const Eigen::Vector3d scale(marker.scale.x, marker.scale.y, marker.scale.z);
    const Eigen::Vector3d shown =
        rotation * in_file.cwiseProduct(scale) +
        Eigen::Vector3d(marker.pose.position.x, marker.pose.position.y, marker.pose.position.z);
    EXPECT_LT((shown - sim::worldFromObject(*world_, instance) * in_object).norm(), 1e-6);
  }
}

TEST_F(MarkersTest, AnObjectThatRvizDrawsOtherwiseIsShownAsTriangles) {
  world::World world = *world_;
  const int item = episode_.setup().instances[0].item;
  for (const bool adapted : {false, true}) {
    std::vector<world::Object> objects;
    for (int i = 0; i < world_->objects.size(); ++i) objects.push_back(world_->objects[i]);
    objects[item].mesh_file = adapted ? "thing.obj" : "thing.glb";
    objects[item].mesh.adapted = adapted;
    world.objects = world::ObjectSet(objects);
    const visualization_msgs::MarkerArray array = objectMarkers(world, episode_, {});
    const auto marker =
        std::find_if(array.markers.begin(), array.markers.end(),
                     [](const visualization_msgs::Marker& one) { return one.ns == "objects" && one.id == 0; });
    ASSERT_NE(marker, array.markers.end());
    EXPECT_EQ(marker->type, visualization_msgs::Marker::TRIANGLE_LIST);
    ASSERT_EQ(marker->points.size(), 3 * objects[item].mesh.triangleCount());
    ASSERT_EQ(marker->colors.size(), marker->points.size());
    const world::MeshPart& part = objects[item].mesh.parts[0];
    const world::Vertex& corner = part.vertices[part.indices[4]];
    EXPECT_FLOAT_EQ(marker->points[4].z, corner.position.z());
    EXPECT_EQ(marker->colors[4].a, 1.f);
    const Eigen::Vector3d place = sim::worldFromObject(world, episode_.setup().instances[0]).translation();
    EXPECT_NEAR(marker->pose.position.x, place.x(), 1e-9);
    EXPECT_NEAR(marker->pose.position.y, place.y(), 1e-9);
  }
}

TEST_F(MarkersTest, LeaveOutWhatWasTakenAway) {
  while (!episode_.finished()) episode_.step(expert::decide(episode_).action);
  const int left = __builtin_popcount(episode_.state().present);
  ASSERT_LT(left, task_.instances);
  EXPECT_EQ(count(objectMarkers(*world_, episode_, {}), "objects"), left);
}

TEST_F(MarkersTest, UrlsOfShippedMeshesNameThePackage) {
  EXPECT_EQ(meshUrl(core::shareFolder() + "/meshes/objects/../objects/mug.obj"),
            "package://early_fusion/meshes/objects/mug.obj");
  EXPECT_EQ(meshUrl("/somewhere/else/mug.obj"), "file:///somewhere/else/mug.obj");
}

}  // namespace
}  // namespace early_fusion::nodes
