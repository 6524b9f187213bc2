#include "early_fusion/learning/training_session.h"

namespace early_fusion::learning {

namespace {

using MayStop = std::function<void()>;

void stopAtSteps(const MayStop& may_stop, RolloutRunner& runner) {
  if (may_stop) runner.setObserver([&](auto&&...) { may_stop(); });
}

/// Plays held-out episodes.
Evaluation score(TrainingSession& session, const std::function<void(const Progress&)>& report,
                 const MayStop& may_stop) {
  RolloutRunner held_out(session.world(), session.task(), kHeldOutSeed);
  stopAtSteps(may_stop, held_out);
  const std::unique_ptr<Agent> agent =
      makePolicyAgent(session.trainer().policy(), model::ActionChoice::kArgmax, kHeldOutSeed);
  return evaluate(held_out, *agent, session.options().evaluation_episodes, session.weightsPath(), [&](int done) {
    Progress progress = session.progress();
    progress.stage = "evaluation";
    progress.evaluated = done;
    report(progress);
  });
}

}  // namespace

Evaluation runSession(TrainingSession& session, const std::function<void(const Progress&)>& report,
                      const MayStop& may_stop) {
  Trainer& trainer = session.trainer();
  RolloutRunner runner = session.trainingRunner();
  stopAtSteps(may_stop, runner);
  while (!trainer.finished()) {
    if (session.scoreDue()) session.addScore(score(session, report, may_stop));
    const std::unique_ptr<Agent> agent = session.rolloutAgent();
    runner.run(trainer.trajectoriesSeen(), trainer.missingInRound(), *agent, true,
               [&](Trajectory trajectory) { trainer.add(std::move(trajectory)); });
    session.trainRound([&](double) {
      if (may_stop) may_stop();
    });
    report(session.progress());
  }
  const Evaluation evaluation = score(session, report, may_stop);
  session.finish(evaluation);
  return evaluation;
}

}  // namespace early_fusion::learning
