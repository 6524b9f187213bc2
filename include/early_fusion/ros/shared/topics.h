#pragma once

/// The names of topics, services and actions. They are relative, so that namespaces and remappings apply.
///
/// The namespace is early_fusion::nodes and not early_fusion::ros, because generated message headers use `ros::` inside
/// namespace early_fusion for roscpp's.
namespace early_fusion::nodes {

// Of the simulator or of a real camera, with one stamp for each step.
inline constexpr char kImageTopic[] = "camera/image_raw";  ///< camera_info is in the same namespace
inline constexpr char kCameraInfoTopic[] = "camera/camera_info";
inline constexpr char kRequestTopic[] = "request";
inline constexpr char kSceneTopic[] = "scene";
inline constexpr char kJointStatesTopic[] = "joint_states";
inline constexpr char kEpisodeTopic[] = "episode";
inline constexpr char kMarkersTopic[] = "markers";
inline constexpr char kRunEpisodesAction[] = "run_episodes";
inline constexpr char kResetService[] = "reset";
inline constexpr char kSetRequestService[] = "set_request";

// Of the policy.
inline constexpr char kActionTopic[] = "action";
inline constexpr char kPolicyStatusTopic[] = "policy_status";  ///< latched
inline constexpr char kAnnotatedImageTopic[] = "camera/image_annotated";
inline constexpr char kLoadWeightsService[] = "load_weights";
inline constexpr char kSaveWeightsService[] = "save_weights";

// Of a person who corrects the policy. The policy then publishes its action as kPolicyActionTopic, by a remapping.
inline constexpr char kFrameTopic[] = "camera/frame";  ///< what the policy saw
inline constexpr char kPolicyActionTopic[] = "policy_action";
inline constexpr char kProposalTopic[] = "proposal";
inline constexpr char kPressTopic[] = "press";
inline constexpr char kJoyTopic[] = "joy";
inline constexpr char kCorrectionTopic[] = "correction";

// Of a robot. "command" topics are those of ros_control's controllers.
inline constexpr char kPanCommandTopic[] = "pan_position_controller/command";
inline constexpr char kTiltCommandTopic[] = "tilt_position_controller/command";
inline constexpr char kTrajectoryCommandTopic[] = "pan_tilt_trajectory_controller/command";
inline constexpr char kDepthImageTopic[] = "camera/depth/image_raw";
inline constexpr char kFoundTopic[] = "found";
inline constexpr char kFoundMarkersTopic[] = "found_markers";
inline constexpr char kPickAction[] = "pick";

// Of tracked objects, on a robot.
inline constexpr char kPutBackTopic[] = "put_back";  ///< latched: what a person is asked to do; empty: nothing
inline constexpr char kContinueService[] = "tf_scene/continue";

// Of the trainer.
inline constexpr char kWeightsTopic[] = "weights";  ///< latched
inline constexpr char kExpertTopic[] = "expert";
inline constexpr char kProgressTopic[] = "progress";  ///< latched

/// A launch file sets this parameter to "". A node that cannot go on sets it to the reason; see runNode().
inline constexpr char kFailureParameter[] = "session_failure";
inline constexpr char kSessionVariable[] = "EARLY_FUSION_SESSION";  // in the environment of a session's nodes

/// A launch file sets this parameter to false, the trainer sets it to true once its session has begun. A respawned
/// trainer then resumes that session instead of refusing its run folder.
inline constexpr char kStartedParameter[] = "session_started";

}  // namespace early_fusion::nodes
