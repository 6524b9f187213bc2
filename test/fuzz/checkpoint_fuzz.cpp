// A checkpoint of the trainer with its learning curve. The episodes are synthetic, so no world is needed.
#include "early_fusion/learning/learning_curve.h"
#include "fuzz_target.h"
#include "learning/tiny_trainer.h"
#include "safetensors_input.h"

using namespace early_fusion;

namespace {

/// As a session replays them: the checkpoint's actions, in an episode of any number.
void replay(const std::vector<learning::EpisodeActions>& episodes,
            const std::function<void(learning::Trajectory)>& finished) {
  for (const learning::EpisodeActions& episode : episodes) {
    if (episode.actions.size() != learning::kTinySteps) throw core::Error("a trajectory has another number of steps");
    learning::Trajectory trajectory = learning::syntheticTrajectory(episode.episode);
    for (int s = 0; s < learning::kTinySteps; ++s) trajectory.steps[s].action = episode.actions[s];
    finished(std::move(trajectory));
  }
}

}  // namespace

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::unique_ptr<learning::Trainer> trainer = learning::makeTrainer();
  const bool refused = fuzz::allowError([&] {
    const std::string bytes = fuzz::safetensorsFile({reinterpret_cast<const char*>(data), size});
    const nn::WeightsFile file = nn::WeightsFile::parse(bytes, "checkpoint");
    const auto curve = file.metadata.find("session.curve");
    if (curve != file.metadata.end()) learning::LearningCurve::parse(curve->second, "checkpoint");
    trainer->restore(file, "checkpoint", replay);
  });
  if (refused) return 0;
  const nn::WeightsFile saved = trainer->save();
  fuzz::require(!saved.tensors.empty(), "a restored trainer has no tensors");
  return 0;
}
