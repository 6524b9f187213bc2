#pragma once

#include <array>
#include <cstdint>
#include <string>

namespace early_fusion::core {

/// The actions of one step (Walsman et al. 2019, sec. IV-A). A move is 2 degrees.
///
/// Signs follow REP-103: pan is positive to the left; tilt is a rotation about y, which points left, so it is positive
/// downwards.
enum class Action : std::uint8_t { kPanLeft, kPanRight, kTiltUp, kTiltDown, kCollect, kRemove, kIdle };

inline constexpr int kActionCount = 7;

inline constexpr std::array<Action, kActionCount> kAllActions = {Action::kPanLeft,  Action::kPanRight, Action::kTiltUp,
                                                                 Action::kTiltDown, Action::kCollect,  Action::kRemove,
                                                                 Action::kIdle};

/// The name used in messages, traces and on the command line: "PAN_LEFT", ..., "IDLE".
const char* actionName(Action action);

/// Whether the action takes an object away: COLLECT or REMOVE.
constexpr bool picks(Action action) { return action == Action::kCollect || action == Action::kRemove; }

/// @throws Error listing the seven names if `name` is none of them.
Action actionFromName(const std::string& name);

}  // namespace early_fusion::core
