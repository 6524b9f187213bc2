#include "early_fusion/ros/correction/correction_node.h"

#include "early_fusion/core/error.h"
#include "early_fusion/ros/shared/topics.h"

namespace early_fusion::nodes {

namespace {

constexpr int kStepQueue = 64;
constexpr int kRecordQueue = 4096;  // a trainer or a bag must not miss one
constexpr double kTimerSec = 0.01;

double nowSec() { return ::ros::WallTime::now().toSec(); }

}  // namespace

core::OptionSet CorrectionNode::Options::options() {
  core::OptionSet set("correction");
  set.include(take_over.options());
  set.include(joy.options());
  set.add("listeners", listeners, 0, 100, "",
          "no step is opened before so many listen to 'correction': the trainer, and a bag that records it");
  addDiagnosticPeriod(set, diagnostic_period_sec);
  return set;
}

CorrectionNode::CorrectionNode(const Options& options)
    : options_(options),
      take_over_(options.take_over),
      joy_(options.joy),
      health_([this](diagnostic_updater::DiagnosticStatusWrapper& status) {
        status.add("waits for", take_over_.waitsFor());
      }),
      action_publisher_(node_.advertise<Action>(kActionTopic, kStepQueue)),
      proposal_publisher_(node_.advertise<Action>(kProposalTopic, kStepQueue)),
      correction_publisher_(node_.advertise<Correction>(kCorrectionTopic, kRecordQueue)),
      frame_subscriber_(node_, kFrameTopic, kStepQueue, ::ros::TransportHints().tcpNoDelay()),
      request_subscriber_(node_, kRequestTopic, kStepQueue, ::ros::TransportHints().tcpNoDelay()),
      policy_subscriber_(node_, kPolicyActionTopic, kStepQueue, ::ros::TransportHints().tcpNoDelay()),
      synchronizer_(SameStamp(kStepQueue), frame_subscriber_, request_subscriber_, policy_subscriber_) {
  synchronizer_.registerCallback(&CorrectionNode::onStep, this);
  press_subscriber_ = node_.subscribe<Press>(
      kPressTopic, kStepQueue, [this](const PressConstPtr& press) { onPress(press->name, press->header.stamp); });
  joy_subscriber_ = node_.subscribe<sensor_msgs::Joy>(kJoyTopic, kStepQueue,
                                                      [this](const sensor_msgs::JoyConstPtr& joy) { onJoy(*joy); });
  timer_ = node_.createWallTimer(::ros::WallDuration(kTimerSec), [this](const ::ros::WallTimerEvent&) { onTimer(); });
  watch_.expect({"policy's action", policy_subscriber_.getTopic(), "early_fusion/Action",
                 "start policy_node with action:=policy_action (real_camera.launch: corrections:=true)"});
}

void CorrectionNode::onStep(const sensor_msgs::ImageConstPtr& frame, const RequestConstPtr& request,
                            const ActionConstPtr& policy) {
  watch_.heard(policy_subscriber_.getTopic());
  health_.count("steps");
  if (policy->episode != request->episode || policy->step != request->step) {
    return health_.drop("action for another request",
                        "the policy's action is for episode " + std::to_string(policy->episode) + ", step " +
                            std::to_string(policy->step) + ", and the request of the same stamp is for episode " +
                            std::to_string(request->episode) + ", step " + std::to_string(request->step));
  }
  if (correction_publisher_.getNumSubscribers() < static_cast<std::uint32_t>(options_.listeners)) {
    return health_.drop("step without a listener", std::to_string(correction_publisher_.getNumSubscribers()) + " of " +
                                                       std::to_string(options_.listeners) + " listen to " +
                                                       correction_publisher_.getTopic() +
                                                       "; start correction_trainer_node, or set ~listeners");
  }
  const auto held = joy_.held();
  publish(take_over_.onStep(*policy, *request, *frame, held ? core::actionName(*held) : "", nowSec()));
}

void CorrectionNode::onPress(const std::string& name, const ::ros::Time& stamp) {
  try {
    publish(take_over_.onPress(name, stamp, nowSec()));
    health_.count("presses");
  } catch (const core::Error& error) {
    health_.drop("unusable press", error.what());
  }
}

void CorrectionNode::onJoy(const sensor_msgs::Joy& joy) {
  try {
    const auto before = joy_.held();
    const std::optional<std::string> press = joy_.add(joy);
    if (press) return onPress(*press, ::ros::Time());
    if (joy_.held() && joy_.held() != before) onPress(core::actionName(*joy_.held()), ::ros::Time());
  } catch (const core::Error& error) {
    health_.drop("unusable joystick", error.what());
  }
}

void CorrectionNode::onTimer() { publish(take_over_.onTime(nowSec())); }

void CorrectionNode::publish(const TakeOver::Output& output) {
  if (output.end) correction_publisher_.publish(*output.end);
  if (output.proposal) proposal_publisher_.publish(*output.proposal);
  if (output.record) correction_publisher_.publish(*output.record);
  if (output.action) action_publisher_.publish(*output.action);
}

}  // namespace early_fusion::nodes
