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
    const Eigen::Vector3d in_file = (in_object + object.mesh_origin).cwiseQuotient(object.mesh_scale);
    const Eigen::Quaterniond rotation(marker.pose.orientation.w, marker.pose.orientation.x, marker.pose.orientation.y,
                                      marker.pose.orientation.z);
    const Eigen::Vector3d scale(marker.scale.x, marker.scale.y, marker.scale.z);
    const Eigen::Vector3d shown =
        rotation * in_file.cwiseProduct(scale) +
        Eigen::Vector3d(marker.pose.position.x, marker.pose.position.y, marker.pose.position.z);
    EXPECT_LT((shown - sim::worldFromObject(*world_, instance) * in_object).norm(), 1e-6);
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
