#include "early_fusion/learning/retention.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "early_fusion/core/error.h"
#include "early_fusion/model/policy_kinds.h"
#include "shipped_world.h"
#include "world/test_world.h"

namespace early_fusion::learning {
namespace {

constexpr std::uint64_t kSeed = 4;

TEST(FirstRequest, IsTheEpisodesOwnOrAnItemOfTheSceneThatItDoesNotRequest) {
  std::set<int> drawn;
  for (std::uint64_t number = 0; number < 50; ++number) {
    const sim::Episode episode(shippedWorld(), {sim::loadTask("simple"), kSeed, number});
    const std::vector<sim::Instance>& instances = episode.setup().instances;
    EXPECT_EQ(firstRequest(FirstRequest::kSame, kSeed, number, episode), episode.state().request);
    const core::Request other = firstRequest(FirstRequest::kOther, kSeed, number, episode);
    EXPECT_EQ(other, firstRequest(FirstRequest::kOther, kSeed, number, episode));
    ASSERT_EQ(other.size(), 1u);
    EXPECT_NE(other, episode.setup().request);
    const auto is_it = [&](const sim::Instance& instance) { return instance.item == other.front(); };
    EXPECT_TRUE(std::any_of(instances.begin(), instances.end(), is_it));
    drawn.insert(static_cast<int>(std::find_if(instances.begin(), instances.end(), is_it) - instances.begin()));
  }
  EXPECT_EQ(drawn.size(), 4u) << "any place in the scene";
}

TEST(FirstRequest, IsEmptyOnceNoInstanceOfItIsLeft) {
  sim::EpisodeSetup setup;
  setup.instances = {{0, 0.75, 0.2, 0}, {1, 0.75, 0, 0}, {0, 0.75, -0.2, 0}};
  setup.request = {0};
  const sim::Task task = sim::loadTask("simple");
  setup.orientation = shippedWorld().rig.lattice().lowest;
  sim::Episode episode(shippedWorld(), task, setup);
  EXPECT_EQ(firstRequest(FirstRequest::kOther, kSeed, 0, episode), core::Request{1});
  const sim::ConeTable& cone = episode.cone();
  for (int i = 0; i < cone.lattice().size(); ++i) {
    if (cone.nearest(cone.lattice().at(i), episode.state().present) == 1) setup.orientation = cone.lattice().at(i);
  }
  episode = sim::Episode(shippedWorld(), task, setup);
  episode.step(core::Action::kRemove);
  ASSERT_EQ(episode.state().present, 0b101u);
  EXPECT_TRUE(firstRequest(FirstRequest::kOther, kSeed, 0, episode).empty());
  setup.instances.pop_back();
  setup.instances[1].item = 0;
  EXPECT_TRUE(firstRequest(FirstRequest::kOther, kSeed, 0, sim::Episode(shippedWorld(), task, setup)).empty())
      << "there is no other item";
}

TEST(BranchSamples, HaveTheirOwnRequestOrAnotherThatTheyDoNotAskFor) {
  Trajectory trajectory;
  TrajectoryStep step;
  step.frame = std::make_shared<const std::vector<std::uint8_t>>(3);
  for (int item : {2, 5, 7}) step.labelled_requests.push_back({{item}, {core::Action::kIdle, 1 << 6, 1}});
  trajectory.steps = {step};
  TrainingOptions options;
  options.requests_per_frame = 3;
  const auto samplesFor = [&](FirstRequest condition, const core::Request& first) {
    BranchSamples samples;
    samples.add(condition, trajectory, 0, first, options, ClassWeights{});
    std::vector<std::pair<core::Request, core::Request>> requests;
    for (std::size_t i = 0; i < samples.samples.size(); ++i) {
      requests.emplace_back(samples.first[i], *samples.samples[i].observation.request);
    }
    return requests;
  };
  using Requests = std::vector<std::pair<core::Request, core::Request>>;
  EXPECT_EQ(samplesFor(FirstRequest::kSame, {2}), (Requests{{{2}, {2}}, {{5}, {5}}, {{7}, {7}}}));
  EXPECT_EQ(samplesFor(FirstRequest::kOther, {5}), (Requests{{{5}, {2}}, {{5}, {7}}}));
  EXPECT_EQ(samplesFor(FirstRequest::kOther, {}), (Requests{{{}, {2}}, {{}, {5}}, {{}, {7}}}));
}

class RetentionTest : public testing::Test {
 protected:
  RetentionTest() {
    session_ = resolveSessionOptions({{"task", folder_.write("short.yaml", "{instances: 3, requested: 1, steps: 4}")},
                                      {"preset", "fast"},
                                      {"trajectories_per_round", "4"}},
                                     "test");
    options_.trajectories = 10;
    options_.evaluate_every = 6;
    options_.evaluation_episodes = 3;
  }

  static std::unique_ptr<model::TrainablePolicy> policy(const std::string& kind) {
    model::PolicyOptions options;
    options.kind = kind;
    options.precision = "f32";
    return model::makePolicy(options, shippedWorld().objects.vocabulary(), 1);
  }

  std::string measure(model::TrainablePolicy& frozen, FirstRequest first) {
    Retention retention(frozen, shippedWorld(), session_, options_, first);
    std::vector<RetentionPoint> points;
    while (!retention.finished()) points.push_back(retention.next());
    return retentionCsv(points);
  }

  const world::TestFolder folder_;
  SessionOptions session_;
  RetentionOptions options_;
};

TEST_F(RetentionTest, OfEveryKindIsTheSameTableTwiceAndChangesNothing) {
  for (const std::string& kind : model::policyKindNames()) {
    const auto frozen = policy(kind);
    const Eigen::VectorXf values = frozen->parameters().values(), buffers = frozen->parameters().buffers();
    const std::string same = measure(*frozen, FirstRequest::kSame), other = measure(*frozen, FirstRequest::kOther);
    EXPECT_EQ(measure(*frozen, FirstRequest::kOther), other);
    EXPECT_NE(same, other);
    EXPECT_EQ(frozen->parameters().values(), values);
    EXPECT_EQ(frozen->parameters().buffers(), buffers);
    EXPECT_EQ(other.find("kind,evaluation,trajectories,loss,f1,precision,recall,agreement,episodes\n"), 0u);
    EXPECT_NE(other.find("\n" + kind + ",other,6,"), std::string::npos) << other;
    EXPECT_NE(other.find("\n" + kind + ",other,10,"), std::string::npos) << other;
    EXPECT_NE(same.find("\n" + kind + ",same,10,"), std::string::npos) << same;
  }
}

TEST_F(RetentionTest, TheBranchOfAnotherSeedIsAnother) {
  const auto frozen = policy("early_fusion");
  const std::string first = measure(*frozen, FirstRequest::kSame);
  options_.seed = 3;
  EXPECT_NE(measure(*frozen, FirstRequest::kSame), first);
}

TEST_F(RetentionTest, RefusesTheHeldOutSeedAndATaskThatRequestsMoreThanOne) {
  const auto frozen = policy("early_fusion");
  const auto error = [&] {
    return world::errorOf([&] { Retention(*frozen, shippedWorld(), session_, options_, FirstRequest::kSame); });
  };
  EXPECT_EQ(error(), "");
  options_.seed = kHeldOutSeed;
  EXPECT_NE(error().find("20191104"), std::string::npos);
  options_.seed = 1;
  session_.task = "medium";
  EXPECT_NE(error().find("task 'medium' requests 2 instances"), std::string::npos);
}

}  // namespace
}  // namespace early_fusion::learning
