#include "early_fusion/core/action.h"

#include "early_fusion/core/names.h"

namespace early_fusion::core {

namespace {

constexpr std::array<const char*, kActionCount> kNames = {"PAN_LEFT", "PAN_RIGHT", "TILT_UP", "TILT_DOWN",
                                                          "COLLECT",  "REMOVE",    "IDLE"};

}  // namespace

const char* actionName(Action action) { return kNames[static_cast<int>(action)]; }

Action actionFromName(const std::string& name) {
  static const std::vector<std::string> names(kNames.begin(), kNames.end());
  return kAllActions[indexOf(name, names, "action")];
}

}  // namespace early_fusion::core
