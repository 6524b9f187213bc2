#pragma once

#include "early_fusion/core/frame_stack.h"
#include "early_fusion/expert/greedy_expert.h"

namespace early_fusion::expert {

/// Which way the camera was last panned over the frames that a policy sees, core::kStackedFrames: left, right, not at
/// all, or not at all and there have not been so many yet.
enum class Heading { kStart, kNone, kLeft, kRight };

/// @param pans of the frames so far, the oldest first [steps]; only the last core::kStackedFrames count.
Heading headingOver(const std::vector<int>& pans);

/// Whether a picture taken from `orientation` shows more than the edge of an instance, occlusion aside.
bool isInView(const sim::ConeTable& cone, int instance, world::Orientation orientation);

/// An expert that knows no more than a policy can: it goes greedily for the requested instances that are in view, and
/// looks for the others.
///
/// While none is in view it keeps to `heading`; where the view holds everything to that side, it turns round, after up
/// to two tilts to where the view holds more of the counter's front and back. It starts with the nearer end, which is
/// soon seen, and where it has no heading later, pans across the middle, away from where it most likely came from.
/// Whatever in the cone is large enough to hide what it looks for, it removes. So every label is a function of the last
/// few pictures. The greedy expert's way to what nobody can see is not: a policy that imitates it learns to turn to and
/// fro wherever the next unseen object is as likely on either side.
///
/// @param heading of the camera over the pictures that the policy sees.
Label searchingLabel(const sim::ConeTable& cone, const std::vector<sim::Instance>& instances, sim::InstanceMask present,
                     world::Orientation orientation, Heading heading, const core::Request& request);

}  // namespace early_fusion::expert
