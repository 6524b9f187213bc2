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

}  // namespace
}  // namespace early_fusion::nodes
