#pragma once

#include "early_fusion/core/frame_stack.h"
#include "early_fusion/expert/greedy_expert.h"

namespace early_fusion::expert {

/// The direction of the latest pan within the frames that a policy sees, core::kStackedFrames. kNone: no pan in all
/// these frames. kStart: no pan, and the episode has had fewer frames than that.
enum class PanDirection { kStart, kNone, kLeft, kRight };

/// @param pans the pan of each frame so far [steps], the oldest first. Only the last core::kStackedFrames are used.
PanDirection panDirectionOver(const std::vector<int>& pans);

/// Whether a frame from `orientation` shows more than the edge of an instance, if nothing occluded it.
bool isInView(const sim::ConeTable& cone, int instance, world::Orientation orientation);

/// The label of the searching expert. It goes greedily for the requested instances in view and searches for the others.
///
/// If no requested instance is in view, it keeps the pan direction. Where the view holds everything on that side, it
/// tilts to where the view holds the counter's front and back, and turns round. At an episode's start it pans to the
/// nearer end. If it has no pan direction later, it pans across the middle, because the camera most likely came from
/// the nearer end. While it searches, it removes every object in the cone that is large enough to hide another.
///
/// Each label is a function of the last few frames. The greedy expert's way to an unseen object is not: a policy that
/// imitates it pans back and forth where the object is equally likely on either side.
/// @param pan_direction the camera's pan direction over the frames that the policy sees.
Label searchingLabel(const sim::ConeTable& cone, const std::vector<sim::Instance>& instances, sim::InstanceMask present,
                     world::Orientation orientation, PanDirection pan_direction, const core::Request& request);

}  // namespace early_fusion::expert
