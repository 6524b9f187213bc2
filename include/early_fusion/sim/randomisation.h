#pragma once

#include <cstdint>
#include <string>

#include "early_fusion/core/options.h"

namespace early_fusion::sim {

/// Domain randomisation (Tobin et al. 2017): how far the look of episodes departs from the world file's, so that a
/// policy learns what objects look like in many kitchens and cameras. Each number is the greatest departure, and 0
/// leaves the look as it is. docs/adapting.md explains them.
struct Randomisation {
  double light_direction_deg = 0;  ///< angle between the light and the shipped one
  double light_strength = 0;       ///< of the direct light: the factor is in [1 - this, 1 + this]
  double ambient_strength = 0;     ///< as light_strength
  double light_color = 0;          ///< as light_strength, for each channel of both lights
  double kitchen_textures = 0;     ///< share of the kitchen's parts that get a procedural texture
  double kitchen_color = 0;        ///< as light_strength, for each channel of each part
  double texture_scale = 0;        ///< of procedural textures: the factor is in [2^-this, 2^this]
  double object_brightness = 0;    ///< as light_strength, for each item
  double object_color = 0;         ///< as light_strength, for each channel of each item
  int distractors = 0;             ///< maximum number of boxes and cylinders between the objects
  double camera_roll_deg = 0;      ///< about the optical axis, in either direction
  double field_of_view = 0;        ///< the focal length's factor is in [1 - this, 1 + this]
  double exposure = 0;             ///< the factor is in [2^-this, 2^this]
  double white_balance = 0;        ///< as light_strength, for red and for blue
  double gamma = 0;                ///< the exponent is in [2^-this, 2^this]
  double noise = 0;                ///< standard deviation, in [0, this] [grey levels]
  double blur_px = 0;              ///< standard deviation, in [0, this] [px]
  double jpeg = 0;                 ///< share of the episodes whose frames are compressed, with a quality in [30, 95]
  std::string texture_set = "trained";  ///< which procedural textures: "trained" or "held_out"
  int looks = 0;                        ///< number of different looks; 0: a new one for each episode
  std::uint64_t look_seed = 1;          ///< determines them, if looks is above 0

  core::OptionSet options();
  bool isNone() const;
};

/// @param name_or_file NAME of config/randomisation/NAME.yaml, such as none, or a YAML file's path.
/// @throws Error naming file, key and value, or the known names.
Randomisation loadRandomisation(const std::string& name_or_file);

/// The options as YAML in braces, for messages. @throws Error naming option and value.
Randomisation parseRandomisation(const std::string& text);

/// The text that parseRandomisation() reads as this one; empty if it is none.
std::string randomisationText(Randomisation randomisation);

}  // namespace early_fusion::sim
