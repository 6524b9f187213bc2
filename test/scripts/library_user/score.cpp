// score WEIGHTS: plays three held-out episodes of SIMPLE with a weights file and prints its scores as JSON.
#include <early_fusion/core/error.h>
#include <early_fusion/learning/evaluation.h>
#include <early_fusion/model/policy_file.h>

#include <iostream>

int main(int argc, char** argv) {
  namespace ef = early_fusion;
  if (argc != 2) return 2;
  try {
    const auto policy = ef::model::loadPolicy(ef::nn::WeightsFile::read(argv[1]), argv[1]);
    ef::nn::Matrix copy = ef::nn::Matrix::Zero(3, 5);  // allocated here, by this program's flags
    copy = ef::nn::Matrix::Ones(7, 9);
    ef::model::Probabilities probabilities;  // allocated there, freed here
    const ef::core::Request request = policy->vocabulary().request({"banana"});
    policy->predict({ef::model::Observation{{}, &request}}, probabilities);
    if (copy.sum() != 63 || std::abs(probabilities.sum() - 1) > 1e-4) return 3;

    const auto world = ef::world::loadWorld("");
    const auto agent = ef::learning::makePolicyAgent(*policy, ef::model::ActionChoice::kArgmax, 1);
    const ef::sim::Task task = ef::sim::loadTask("simple");
    ef::learning::RolloutRunner runner(*world, task, ef::learning::kHeldOutSeed);
    std::cout << ef::learning::evaluate(runner, *agent, 3, argv[1]).toJson() << "\n";
    return 0;
  } catch (const ef::core::Error& error) {
    std::cerr << error.what() << "\n";
    return 1;
  }
}
