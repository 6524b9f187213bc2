#pragma once

#include <early_fusion/Action.h>
#include <early_fusion/LoadWeights.h>
#include <early_fusion/Request.h>
#include <early_fusion/SaveWeights.h>
#include <early_fusion/Weights.h>
#include <image_transport/image_transport.h>
#include <ros/node_handle.h>

#include <set>
#include <string>
#include <vector>

#include "early_fusion/core/options.h"
#include "early_fusion/ros/policy/acting_policy.h"
#include "early_fusion/ros/policy/request_pairing.h"
#include "early_fusion/ros/shared/camera_crop.h"
#include "early_fusion/ros/shared/files_folder.h"
#include "early_fusion/ros/shared/health.h"
#include "early_fusion/ros/shared/topic_watch.h"
#include "early_fusion/ros/shared/wall_throttle.h"

namespace early_fusion::nodes {

/// Publishes an action for every image that has a request with the same stamp. It does not depend on the simulator, so
/// any camera can replace it.
class PolicyNode {
 public:
  struct Options {
    std::string weights;  ///< a weights file; empty: wait for the topic or the service
    Acting acting;        ///< how weights from a file act
    std::string image_transport = "raw";
    std::string rectified = "auto";
    bool name_items = false;
    bool name_items_always = false;
    int annotated_scale = 4;
    double annotated_rate_hz = 10;
    int saliency_grid = 0;  ///< 0: no saliency on the annotated image
    std::string files;      ///< folder of the files that services name; empty: defaultFilesFolder()
    double diagnostic_period_sec = 1;

    core::OptionSet options();
  };

  /// @throws core::Error if the weights file cannot be used.
  explicit PolicyNode(const Options& options, const NodeContext& context = NodeContext());

 private:
  void onImage(const sensor_msgs::ImageConstPtr& image);
  void onRequest(const RequestConstPtr& request);
  void answer(const sensor_msgs::Image& image, const Request& request);
  void publishAnswer();
  /// @throws core::Error if the image or the request cannot be used.
  Decision decide(const sensor_msgs::Image& image, const Request& request);
  Crop cropOf(const sensor_msgs::Image& image);
  void nameItem(core::Action action, const Request& request);
  void expectTopics();
  void onWeights(const Weights& message);
  bool onLoadWeights(LoadWeights::Request& request, LoadWeights::Response& response);
  bool onSaveWeights(SaveWeights::Request& request, SaveWeights::Response& response);

  void load(const std::string& id, nn::WeightsFile file, const std::string& source, const Acting& acting);
  void loadFile(const std::string& path);
  void publishStatus();
  void publishFrame(const std_msgs::Header& header);
  void publishAnnotated(const std_msgs::Header& header, const Request& request);
  void report(diagnostic_updater::DiagnosticStatusWrapper& status) const;

  Options options_;
  ::ros::NodeHandle node_;
  Health health_;
  TopicWatch watch_;
  ActingPolicy policy_;
  RequestPairing pairing_;
  std::string weights_id_;
  Action answer_;  // to the previous image
  std::vector<std::string> answered_items_;
  bool answer_valid_ = false;  // whether answer_ was decided by the current weights
  sensor_msgs::CameraInfoConstPtr camera_info_;
  std::set<std::string> crop_warnings_;  // that were said
  WallThrottle annotation_;
  double latency_sec_ = 0;  // of the last decision

  image_transport::ImageTransport image_transport_;
  image_transport::Publisher annotated_publisher_;
  ::ros::Publisher action_publisher_;
  ::ros::Publisher frame_publisher_;
  ::ros::Publisher status_publisher_;
  ::ros::Subscriber camera_info_subscriber_;
  ::ros::Subscriber weights_subscriber_;
  ::ros::ServiceServer load_server_;
  ::ros::ServiceServer save_server_;
  image_transport::Subscriber image_subscriber_;
  ::ros::Subscriber request_subscriber_;
};

}  // namespace early_fusion::nodes
