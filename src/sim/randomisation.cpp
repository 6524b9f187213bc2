#include "early_fusion/sim/randomisation.h"

#include <algorithm>

#include "early_fusion/core/file.h"
#include "early_fusion/world/appearance.h"

namespace early_fusion::sim {

core::OptionSet Randomisation::options() {
  core::OptionSet set("randomisation");
  set.add("light_direction", light_direction_deg, 0, 45, "degrees",
          "greatest angle between the light and the shipped one");
  set.add("light_strength", light_strength, 0, 0.95, "",
          "the direct light's factor is drawn from [1 - this, 1 + this]");
  set.add("ambient_strength", ambient_strength, 0, 0.95, "", "the same for the ambient light");
  set.add("light_color", light_color, 0, 0.95, "", "the same for each channel of both lights");
  set.add("kitchen_textures", kitchen_textures, 0, 1, "",
          "share of the kitchen's parts (counter, walls, floor and others) that get a procedural texture");
  set.add("kitchen_color", kitchen_color, 0, 0.95, "",
          "the factor of each channel of each part is drawn from [1 - this, 1 + this]");
  set.add("texture_scale", texture_scale, 0, 3, "octaves",
          "procedural textures are repeated 2^x times as often, x in [-this, this]");
  set.add("object_brightness", object_brightness, 0, 0.95, "", "each item's factor is drawn from [1 - this, 1 + this]");
  set.add("object_color", object_color, 0, 0.95, "", "the same for each channel of each item");
  set.add("distractors", distractors, 0, world::kMaxDistractors, "",
          "maximum number of boxes and cylinders that stand between the objects and are none");
  set.add("camera_roll", camera_roll_deg, 0, 45, "degrees", "greatest turn of the camera about its axis");
  set.add("field_of_view", field_of_view, 0, 0.5, "", "the focal length's factor is drawn from [1 - this, 1 + this]");
  set.add("exposure", exposure, 0, 3, "stops", "frames are 2^x times as bright, x in [-this, this]");
  set.add("white_balance", white_balance, 0, 0.95, "", "red's and blue's factors are drawn from [1 - this, 1 + this]");
  set.add("gamma", gamma, 0, 2, "octaves", "the exponent on the frames' values is 2^x, x in [-this, this]");
  set.add("noise", noise, 0, 100, "grey levels", "greatest standard deviation of the frames' noise");
  set.add("blur", blur_px, 0, 3, "px", "greatest standard deviation of the frames' blur");
  set.add("jpeg", jpeg, 0, 1, "", "share of the episodes whose frames are compressed, with a quality in [30, 95]");
  set.addChoice("texture_set", texture_set, {"trained", "held_out"},
                "which procedural textures are drawn; none is in both sets");
  set.add("looks", looks, 0, 1000000, "", "number of different looks, without distractors; 0: one for each episode");
  set.add("look_seed", look_seed, "determines these looks");
  return set;
}

bool Randomisation::isNone() const {
  return distractors == 0 &&
         std::max({light_direction_deg, light_strength, ambient_strength, light_color, kitchen_textures, kitchen_color,
                   texture_scale, object_brightness, object_color, camera_roll_deg, field_of_view, exposure,
                   white_balance, gamma, noise, blur_px, jpeg}) == 0;
}

Randomisation loadRandomisation(const std::string& name_or_file) {
  Randomisation randomisation;
  randomisation.options().setFromYamlFile(core::findConfig("randomisation", name_or_file));
  return randomisation;
}

Randomisation parseRandomisation(const std::string& text) {
  Randomisation randomisation;
  if (!text.empty()) randomisation.options().setFromYamlText(text, "randomisation");
  return randomisation;
}

std::string randomisationText(Randomisation randomisation) {
  return randomisation.isNone() ? "" : randomisation.options().toYamlLine();
}

}  // namespace early_fusion::sim
