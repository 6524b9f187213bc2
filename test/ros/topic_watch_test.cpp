#include "early_fusion/ros/shared/topic_watch.h"

#include <gtest/gtest.h>

namespace early_fusion::nodes {
namespace {

const NeededTopic kImages = {"image", "/camera/image_raw", "sensor_msgs/Image", "set the argument image"};

void expectWords(const std::string& text, const std::vector<std::string>& words) {
  for (const std::string& word : words) EXPECT_NE(text.find(word), std::string::npos) << word << " in: " << text;
}

TEST(TopicWatch, NamesTheTopicsOfTheSameTypeAndTheirPublishers) {
  const std::string text = silenceOf(
      kImages, {{"/usb_cam/image_raw", "sensor_msgs/Image", {"/usb_cam"}}, {"/odom", "nav_msgs/Odometry", {"/base"}}});
  expectWords(text, {"nobody publishes it", "/usb_cam/image_raw (by /usb_cam)", "set the argument image"});
  EXPECT_EQ(text.find("/odom"), std::string::npos) << text;
}

TEST(TopicWatch, SaysIfNoTopicHasTheType) {
  expectWords(silenceOf(kImages, {}), {"nobody publishes it, nor any other topic of type sensor_msgs/Image"});
}

TEST(TopicWatch, TellsASilentPublisherFromAMissingOne) {
  expectWords(silenceOf(kImages, {{"/camera/image_raw", "sensor_msgs/Image", {"/driver"}}}),
              {"/driver", "sends nothing", "ROS_IP"});
  NeededTopic requests = kImages;
  requests.if_silent = "it waits for a request";
  expectWords(silenceOf(requests, {{"/camera/image_raw", "sensor_msgs/Image", {"/request"}}}),
              {"/request", "sends nothing, or it waits for a request"});
}

TEST(TopicWatch, NamesATopicOfAnotherType) {
  expectWords(silenceOf(kImages, {{"/camera/image_raw", "sensor_msgs/PointCloud2", {"/driver"}}}),
              {"has type sensor_msgs/PointCloud2, not sensor_msgs/Image"});
}

TEST(TopicWatch, NamesTheNodesThatPublishOneTopic) {
  const std::string text = rivalsOn(kImages, {{"/camera/image_raw", "sensor_msgs/Image", {"/driver", "/play_1"}},
                                              {"/other/image_raw", "sensor_msgs/Image", {"/a", "/b"}}});
  expectWords(text, {"2 nodes publish image on /camera/image_raw: /driver, /play_1; stop all but one"});
  EXPECT_EQ(rivalsOn(kImages, {{"/camera/image_raw", "sensor_msgs/Image", {"/driver"}}}), "");
}

TEST(TopicWatch, ActionServersAreThoseWhoSubscribeToGoalsOfTheType) {
  const std::string type = "early_fusion/PickActionGoal";
  EXPECT_EQ(actionServers(type, {{"/gripper/pick/goal", type, {"/gripper"}},
                                 {"/arm/take/goal", type, {"/arm"}},
                                 {"/arm/move/goal", "other/MoveActionGoal", {"/arm"}},
                                 {"/recorded", type, {"/record"}}}),
            (std::vector<std::string>{"/arm/take (of /arm)", "/gripper/pick (of /gripper)"}));
}

}  // namespace
}  // namespace early_fusion::nodes
