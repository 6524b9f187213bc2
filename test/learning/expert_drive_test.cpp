#include "early_fusion/learning/expert_drive.h"

#include <gtest/gtest.h>

#include "early_fusion/core/error.h"

namespace early_fusion::learning {
namespace {

TEST(ExpertDrive, DrivesTheShareOfSteps) {
  const ExpertDrive never{0, DriveUnit::kStep}, always{1, DriveUnit::kStep}, some{0.3, DriveUnit::kStep};
  int driven = 0, switches = 0;
  for (std::uint64_t episode = 0; episode < 100; ++episode) {
    for (int step = 0; step < 48; ++step) {
      EXPECT_FALSE(never.drives(1, episode, step));
      EXPECT_TRUE(always.drives(1, episode, step));
      driven += some.drives(1, episode, step);
      switches += some.drives(1, episode, step) != some.drives(1, episode, step + 1);
    }
  }
  EXPECT_NEAR(driven / 4800.0, 0.3, 0.03);
  EXPECT_NEAR(switches / 4800.0, 2 * 0.3 * 0.7, 0.03) << "steps are drawn independently";
}

TEST(ExpertDrive, DrivesTheShareOfWholeTrajectories) {
  const ExpertDrive some{0.3, DriveUnit::kTrajectory};
  int driven = 0;
  for (std::uint64_t episode = 0; episode < 2000; ++episode) {
    driven += some.drives(1, episode, 0);
    for (int step = 1; step < 48; ++step) EXPECT_EQ(some.drives(1, episode, step), some.drives(1, episode, 0));
  }
  EXPECT_NEAR(driven / 2000.0, 0.3, 0.03);
}

TEST(ExpertDrive, OtherSeedsDriveOtherSteps) {
  const ExpertDrive half{0.5, DriveUnit::kStep};
  int differing = 0;
  for (int step = 0; step < 1000; ++step) differing += half.drives(1, 7, step) != half.drives(2, 7, step);
  EXPECT_NEAR(differing / 1000.0, 0.5, 0.06);
}

TEST(ExpertDrive, TheShareFallsLinearlyToTheLastRound) {
  TrainingOptions options;
  options.trajectories = 450;
  options.trajectories_per_round = 100;
  options.expert_share = 0.9;
  options.final_expert_share = 0.1;
  EXPECT_EQ(expertDrive(options, 0).share, 0.9);
  EXPECT_NEAR(expertDrive(options, 100).share, 0.7, 1e-12);
  EXPECT_NEAR(expertDrive(options, 200).share, 0.5, 1e-12);
  EXPECT_EQ(expertDrive(options, 400).share, 0.1) << "the last round, which is shorter";
  options.expert_share = options.final_expert_share = 1;
  for (std::uint64_t first = 0; first < 500; first += 100) EXPECT_EQ(expertDrive(options, first).share, 1);
}

TEST(ExpertDrive, TheShareCanFallEarlierAndASessionOfOneRoundHasTheFirst) {
  TrainingOptions options;
  options.trajectories = 400;
  options.trajectories_per_round = 100;
  options.expert_share = 1;
  options.expert_share_trajectories = 100;
  EXPECT_EQ(expertDrive(options, 0).share, 1) << "the expert drives the first round alone";
  for (const std::uint64_t first : {100, 200, 300}) EXPECT_EQ(expertDrive(options, first).share, 0);
  options.expert_share_trajectories = 0;
  options.trajectories = 100;
  EXPECT_EQ(expertDrive(options, 0).share, 1);
}

TEST(ExpertDrive, UnitsHaveNames) {
  TrainingOptions options;
  EXPECT_EQ(expertDrive(options, 0).per, DriveUnit::kStep);
  options.expert_share_per = "trajectory";
  EXPECT_EQ(expertDrive(options, 0).per, DriveUnit::kTrajectory);
  EXPECT_THROW(driveUnitFromName("day"), core::Error);
}

}  // namespace
}  // namespace early_fusion::learning
