// A camera's URDF: for the simulator, and for a real pan-tilt unit.
#include "early_fusion/world/camera_rig.h"
#include "early_fusion/world/pan_tilt_unit.h"
#include "fuzz_target.h"

using namespace early_fusion;

namespace {

constexpr char kPan[] = "pan_joint", kTilt[] = "tilt_joint", kFrame[] = "camera_optical_frame";

}  // namespace

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const fuzz::InputFolder folder;
  const std::string text(reinterpret_cast<const char*>(data), size);
  fuzz::allowError([&] {
    const world::CameraRig rig = world::CameraRig::load(folder.write("camera.urdf", text), kPan, kTilt, kFrame);
    const world::OrientationLattice& lattice = rig.lattice();
    for (int i = 0; i < lattice.size(); ++i) {
      fuzz::require(rig.worldFromCamera(lattice.at(i)).matrix().allFinite(), "a pose that is not finite");
    }
  });
  fuzz::allowError([&] {
    const world::PanTiltUnit unit = world::PanTiltUnit::parse(text, "input", kPan, kTilt, kFrame);
    for (const world::UnitJoint& joint : {unit.pan, unit.tilt}) {
      fuzz::require(joint.continuous || joint.lower_rad <= joint.upper_rad, "a joint's limits");
    }
  });
  return 0;
}
