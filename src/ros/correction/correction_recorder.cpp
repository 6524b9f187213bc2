#include "early_fusion/ros/correction/correction_recorder.h"

#include <rosbag/bag.h>
#include <rosbag/view.h>
#include <sensor_msgs/image_encodings.h>

#include <set>

#include "early_fusion/core/error.h"
#include "early_fusion/core/names.h"

namespace early_fusion::nodes {

namespace {

std::string stepName(const Correction& message) {
  return "episode " + std::to_string(message.episode) + ", step " + std::to_string(message.step);
}

}  // namespace

learning::WatchedStep CorrectionRecorder::stepOf(const Correction& message) const {
  const auto size = static_cast<std::uint32_t>(image_size_);
  const sensor_msgs::Image& frame = message.frame;
  if (frame.encoding != sensor_msgs::image_encodings::RGB8 || frame.width != size || frame.height != size ||
      frame.step != 3 * size || frame.data.size() != 3 * size * size) {
    throw core::Error("the frame is " + std::to_string(frame.width) + " x " + std::to_string(frame.height) + " " +
                      frame.encoding + "; the weights that the trainer started from need " + std::to_string(size) +
                      " x " + std::to_string(size) + " rgb8");
  }
  if (frame.header.stamp != message.header.stamp) {
    throw core::Error("the frame's stamp is not the correction's, so it shows another step");
  }
  learning::WatchedStep step;
  step.frame = std::make_shared<const std::vector<std::uint8_t>>(frame.data.begin(), frame.data.end());
  step.request = vocabulary_.request(message.items);
  step.policys = core::actionFromName(message.policy);
  if (!message.person.empty()) step.persons = core::actionFromName(message.person);
  step.confirmed = message.confirmed;
  return step;
}

std::optional<std::vector<learning::WatchedStep>> CorrectionRecorder::add(const Correction& message) {
  if (message.ends) {
    cut_ = false;
    return std::exchange(steps_, {});
  }
  if (message.step == 0) {
    steps_.clear();
    cut_ = false;
    episode_ = message.episode;
  }
  if (cut_) return std::nullopt;
  try {
    if (message.step != steps_.size() || message.episode != episode_) {
      throw core::Error("does not follow from the previous step (" + std::to_string(steps_.size()) +
                        " steps of episode " + std::to_string(episode_) + " are known)");
    }
    steps_.push_back(stepOf(message));
  } catch (const core::Error& error) {
    cut_ = true;
    throw core::Error(stepName(message) + ": " + error.what() + "; the rest of the episode is left out");
  }
  return std::nullopt;
}

std::vector<CorrectionConstPtr> correctionsInBag(const std::string& file) {
  std::vector<CorrectionConstPtr> corrections;
  std::set<std::string> topics;
  try {
    rosbag::Bag bag(file);
    for (const rosbag::MessageInstance& message : rosbag::View(bag)) {
      CorrectionConstPtr correction = message.instantiate<Correction>();
      if (!correction) continue;
      topics.insert(message.getTopic());
      corrections.push_back(std::move(correction));
    }
  } catch (const rosbag::BagException& error) {
    throw core::Error(file + ": cannot be read as a bag (" + error.what() + ")");
  }
  if (topics.empty()) {
    throw core::Error(file + ": has no early_fusion/Correction messages; record the topic 'correction'");
  }
  if (topics.size() > 1) {
    throw core::Error(file + ": has the corrections of several sessions (" +
                      core::joined({topics.begin(), topics.end()}) + "); 'rosbag filter' takes out one of them");
  }
  return corrections;
}

}  // namespace early_fusion::nodes
