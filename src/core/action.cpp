#include "early_fusion/core/action.h"

#include "early_fusion/core/error.h"

namespace early_fusion::core {

namespace {

constexpr std::array<const char*, kActionCount> kNames = {"PAN_LEFT", "PAN_RIGHT", "TILT_UP", "TILT_DOWN",
                                                          "COLLECT",  "REMOVE",    "IDLE"};

}  // namespace

const char* actionName(Action action) { return kNames[static_cast<int>(action)]; }

Action actionFromName(const std::string& name) {
  std::string known;
  for (Action action : kAllActions) {
    if (name == actionName(action)) return action;
    known += std::string(known.empty() ? "" : ", ") + actionName(action);
  }
  throw Error("unknown action '" + name + "'; known are " + known);
}

}  // namespace early_fusion::core
