#include "early_fusion/ros/policy/policy_node.h"

#include <early_fusion/PolicyStatus.h>

#include <boost/make_shared.hpp>
#include <cstdio>

#include "early_fusion/core/error.h"
#include "early_fusion/core/excerpt.h"
#include "early_fusion/model/action_choice.h"
#include "early_fusion/model/annotation.h"
#include "early_fusion/ros/shared/camera_image.h"
#include "early_fusion/ros/shared/conversions.h"
#include "early_fusion/ros/shared/topics.h"
#include "early_fusion/sim/cone_table.h"

namespace early_fusion::nodes {

namespace {

// A camera sends many images for each request. So many wait for a request with their stamp, if they fit.
constexpr int kWaitingImages = 30;
constexpr std::size_t kWaitingBytes = std::size_t{64} << 20;
constexpr int kImageQueue = 6;  // images that come during a decision; a large one has tens of MB
constexpr int kRequestQueue = 30;
constexpr std::size_t kMaxCropWarnings = 20;

}  // namespace

core::OptionSet PolicyNode::Options::options() {
  core::OptionSet set("policy");
  set.add("weights", weights, "weights file; empty: wait for the topic 'weights' or the service 'load_weights'");
  set.addChoice("mode", acting.mode, model::actionChoiceNames(), "how weights from a file choose actions");
  set.add("seed", acting.seed, "seed of drawn actions");
  set.addChoice("precision", acting.precision, model::precisionNames(),
                "arithmetic of weights from a file; auto: bf16 if the processor computes faster in it, else f32");
  set.add("image_transport", image_transport, "how images are received: raw, compressed, or another installed plugin");
  set.addChoice("rectified", rectified, {"auto", "true", "false"},
                "whether the images are rectified, so that P of camera_info describes them instead of K; auto: if the "
                "image topic's name says so (image_rect)");
  set.add("name_items", name_items,
          "say which requested item a COLLECT or REMOVE is for; costs one prediction for each requested item then");
  set.add("name_items_always", name_items_always,
          "with name_items, at steps of other actions name the item that a COLLECT would be for, because a person may "
          "press it");
  set.add("annotated_scale", annotated_scale, 1, 16, "", "enlargement of the annotated image");
  set.add("annotated_rate", annotated_rate_hz, 0.1, 1000, "Hz", "maximum number of annotated images a second");
  set.add("saliency_grid", saliency_grid, 0, 64, "cells",
          "edge of the grid of occlusion saliency that tints the annotated image; costs one prediction for each cell; "
          "0: no tint; kinds with attention show their own map");
  set.add("files", files,
          "folder of the files that load_weights and save_weights may use; empty: $ROS_HOME/early_fusion or\n"
          "~/.ros/early_fusion");
  addDiagnosticPeriod(set, diagnostic_period_sec);
  return set;
}

PolicyNode::PolicyNode(const Options& options, const NodeContext& context)
    : options_(options),
      node_(context.node),
      health_([this](diagnostic_updater::DiagnosticStatusWrapper& status) { report(status); }, context),
      watch_(context.node),
      pairing_(kWaitingImages, kWaitingBytes),
      annotation_(1 / options.annotated_rate_hz),
      image_transport_(node_),
      annotated_publisher_(image_transport_.advertise(kAnnotatedImageTopic, 2)),
      action_publisher_(node_.advertise<Action>(kActionTopic, 512)),
      frame_publisher_(node_.advertise<sensor_msgs::Image>(kFrameTopic, 64)),
      status_publisher_(node_.advertise<PolicyStatus>(kPolicyStatusTopic, 2, true)) {
  if (!options_.weights.empty()) loadFile(options_.weights);
  publishStatus();
  load_server_ = node_.advertiseService(kLoadWeightsService, &PolicyNode::onLoadWeights, this);
  save_server_ = node_.advertiseService(kSaveWeightsService, &PolicyNode::onSaveWeights, this);
  weights_subscriber_ =
      node_.subscribe<Weights>(kWeightsTopic, 1, [this](const WeightsConstPtr& message) { onWeights(*message); });
  camera_info_subscriber_ = node_.subscribe<sensor_msgs::CameraInfo>(
      kCameraInfoTopic, 1, [this](const sensor_msgs::CameraInfoConstPtr& message) {
        camera_info_ = message;
        watch_.heard(camera_info_subscriber_.getTopic(), camera_info_subscriber_.getNumPublishers());
      });
  const auto hints = ::ros::TransportHints().tcpNoDelay();
  request_subscriber_ = node_.subscribe<Request>(
      kRequestTopic, kRequestQueue, [this](const RequestConstPtr& request) { onRequest(request); },
      ::ros::VoidConstPtr(), hints);
  image_subscriber_ = image_transport_.subscribe(kImageTopic, kImageQueue, &PolicyNode::onImage, this,
                                                 image_transport::TransportHints(options_.image_transport, hints));
  if (policy_.loaded()) expectTopics();
}

void PolicyNode::expectTopics() {
  watch_.expect(neededImage(image_subscriber_.getTopic(), options_.image_transport,
                            "remap camera/image_raw to the camera's (real_camera.launch: image)"));
  NeededTopic requests{"request", request_subscriber_.getTopic(), "early_fusion/Request",
                       "start request_node in this namespace, or the simulator"};
  requests.if_silent =
      "it waits: for a request (rosservice call set_request), or for what its own log names, such as joint states";
  watch_.expect(requests);
}

void PolicyNode::onImage(const sensor_msgs::ImageConstPtr& image) {
  watch_.heard(image_subscriber_.getTopic(), image_subscriber_.getNumPublishers());
  NeededTopic info{"camera_info", camera_info_subscriber_.getTopic(), "sensor_msgs/CameraInfo",
                   "remap camera/camera_info to the camera's (real_camera.launch: camera_info); until then the policy "
                   "sees the largest square of the image"};
  info.one_publisher = true;
  watch_.expect(info);
  if (const auto pair = pairing_.add(image)) answer(*pair->first, *pair->second);
}

void PolicyNode::onRequest(const RequestConstPtr& request) {
  watch_.heard(request_subscriber_.getTopic());
  if (const auto pair = pairing_.add(request)) answer(*pair->first, *pair->second);
}

void PolicyNode::answer(const sensor_msgs::Image& image, const Request& request) {
  const ::ros::WallTime began = ::ros::WallTime::now();
  health_.count("images");
  if (!policy_.loaded()) {
    return health_.drop("image without weights",
                        "no weights yet; set ~weights, call 'load_weights', or publish them on 'weights'");
  }
  const bool again = answer_valid_ && answer_.header.stamp == request.header.stamp &&
                     answer_.episode == request.episode && answer_.step == request.step &&
                     answered_items_ == request.items;
  if (again) {
    publishFrame(image.header);
    return publishAnswer();
  }
  Decision decision;
  try {
    decision = decide(image, request);
  } catch (const std::exception& error) {  // a library's, too: no message may end the node
    return health_.drop("unusable image or request", error.what());
  }
  answer_.header = image.header;
  answer_.episode = request.episode;
  answer_.step = request.step;
  answer_.name = core::actionName(decision.action);
  answer_.probabilities = decision.probabilities;
  answer_.weights = weights_id_;
  answer_.mode = policy_.acting().mode;
  answer_.frames = static_cast<std::uint8_t>(decision.frames);
  answered_items_ = request.items;
  nameItem(decision.action, request);
  answer_valid_ = true;
  publishFrame(image.header);
  publishAnswer();
  latency_sec_ = (::ros::WallTime::now() - began).toSec();
  publishAnnotated(image.header, request);
}

/// A message of its own, because subscribers in this process get it without a copy.
void PolicyNode::publishAnswer() { action_publisher_.publish(boost::make_shared<Action>(answer_)); }

Decision PolicyNode::decide(const sensor_msgs::Image& image, const Request& request) {
  const core::Image frame = policyImage(image, cropOf(image), policy_.imageSize());
  return policy_.decide(frame, request.items, request.episode, request.step);
}

Crop PolicyNode::cropOf(const sensor_msgs::Image& image) {
  const bool rectified =
      options_.rectified == "auto" ? isRectifiedTopic(image_subscriber_.getTopic()) : options_.rectified == "true";
  Crop crop = cropToView(image, camera_info_.get(), rectified, policy_.horizontalFovDeg());
  if (!crop.warning.empty() && crop_warnings_.size() < kMaxCropWarnings && crop_warnings_.insert(crop.warning).second) {
    ROS_WARN("%s: %s", camera_info_subscriber_.getTopic().c_str(), crop.warning.c_str());
  }
  return crop;
}

void PolicyNode::nameItem(core::Action action, const Request& request) {
  const bool picks = core::picks(action);
  LikelyItem item;
  if (options_.name_items && !request.items.empty() && (picks || options_.name_items_always)) {
    item = policy_.likeliestItem(picks ? action : core::Action::kCollect);
  }
  answer_.item = item.name;
  answer_.item_probability = item.probability;
}

void PolicyNode::onWeights(const Weights& message) {
  try {
    const std::string bytes(message.data.begin(), message.data.end());
    const std::string source =
        "weights '" + core::excerpt(message.id) + "' from topic " + weights_subscriber_.getTopic();
    load(message.id, nn::WeightsFile::parse(bytes, source), source, {message.mode, message.seed, message.precision});
  } catch (const std::exception& error) {
    health_.drop("unusable weights", error.what());
  }
}

void PolicyNode::load(const std::string& id, nn::WeightsFile file, const std::string& source, const Acting& acting) {
  policy_.load(std::move(file), source, acting);
  weights_id_ = id;
  answer_valid_ = false;
  health_.count("weights loaded");
  publishStatus();
  if (image_subscriber_) expectTopics();
}

void PolicyNode::loadFile(const std::string& path) {
  nn::WeightsFile file = nn::WeightsFile::read(path);
  const auto id = file.metadata.find("id");
  load(id == file.metadata.end() ? path : id->second, std::move(file), path, options_.acting);
  ROS_INFO("using weights '%s' from %s", weights_id_.c_str(), path.c_str());
}

bool PolicyNode::onLoadWeights(LoadWeights::Request& request, LoadWeights::Response& response) {
  try {
    loadFile(pathInFolder(request.path, options_.files));
    response.success = true;
    response.message = "using weights '" + weights_id_ + "'";
  } catch (const core::Error& error) {
    response.success = false;
    response.message = error.what();
  }
  return true;
}

bool PolicyNode::onSaveWeights(SaveWeights::Request& request, SaveWeights::Response& response) {
  try {
    if (!policy_.loaded()) throw core::Error("there are no weights to save yet");
    const std::string path = pathInFolder(request.path, options_.files);
    policy_.file().write(path);
    response.success = true;
    response.message = "wrote weights '" + weights_id_ + "' to " + path;
  } catch (const core::Error& error) {
    response.success = false;
    response.message = error.what();
  }
  return true;
}

void PolicyNode::publishStatus() {
  PolicyStatus status;
  status.header.stamp = ::ros::Time::now();
  status.weights = weights_id_;
  if (policy_.loaded()) {
    status.kind = policy_.policy().options().kind;
    status.vocabulary = policy_.policy().vocabulary().names();
    status.mode = policy_.acting().mode;
    status.seed = policy_.acting().seed;
    status.precision = policy_.policy().options().precision;
  }
  status_publisher_.publish(status);
}

void PolicyNode::publishFrame(const std_msgs::Header& header) {
  if (frame_publisher_.getNumSubscribers() > 0) frame_publisher_.publish(imageMessage(policy_.lastFrame(), header));
}

void PolicyNode::publishAnnotated(const std_msgs::Header& header, const Request& request) {
  if (annotated_publisher_.getNumSubscribers() == 0 || !annotation_.due()) return;
  model::Annotation annotation;
  annotation.cone_radius_px =
      model::coneRadiusPx(sim::kConeHalfAngleRad, policy_.horizontalFovDeg() * M_PI / 180, policy_.imageSize());
  annotation.request = request.items;
  annotation.action = answer_.name;
  const core::Image tinted = policy_.lastImageTinted(options_.saliency_grid);
  annotated_publisher_.publish(imageMessage(model::annotate(tinted, annotation, options_.annotated_scale), header));
}

void PolicyNode::report(diagnostic_updater::DiagnosticStatusWrapper& status) const {
  status.add("weights", weights_id_.empty() ? "none yet" : weights_id_);
  status.add("mode", policy_.acting().mode);
  status.addf("decision time [ms]", "%.2f", latency_sec_ * 1e3);
  if (!policy_.loaded()) status.mergeSummary(diagnostic_msgs::DiagnosticStatus::WARN, "no weights yet");
}

}  // namespace early_fusion::nodes
