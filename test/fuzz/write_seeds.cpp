// Writes the seeds that only this program's code can make: the weights and the checkpoint of a tiny trainer. They have
// no digest, because every mutation would be refused with one.
#include <regex>

#include "early_fusion/core/file.h"
#include "early_fusion/model/policy_file.h"
#include "learning/tiny_trainer.h"

using namespace early_fusion;

namespace {

struct Parts {
  std::string header;
  std::string data;
};

Parts withoutDigest(const nn::WeightsFile& file) {
  constexpr std::size_t kLengthBytes = 8;
  const std::string bytes = file.serialize();
  const std::size_t data = kLengthBytes + (static_cast<unsigned char>(bytes[0]) | bytes[1] << 8 | bytes[2] << 16);
  const std::string header = bytes.substr(kLengthBytes, data - kLengthBytes);
  return {std::regex_replace(header, std::regex("\"digest\":\"[^\"]*\","), ""), bytes.substr(data)};
}

/// A byte with the length, and the text.
std::string counted(const std::string& text) { return static_cast<char>(text.size()) + text; }

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2) return 1;
  const std::string folder = argv[1];
  const std::unique_ptr<learning::Trainer> trainer = learning::makeTrainer();
  learning::runRound(*trainer);
  nn::WeightsFile saved = trainer->save();
  saved.metadata["session.curve"] =
      "round,trajectories,loss,learning_rate,f1,agreement,elapsed_sec\n1,4,1.9,0.01,0.5,0.25,2.5\n";
  const Parts checkpoint = withoutDigest(saved);
  core::writeFileAtomically(folder + "/checkpoint/tiny", checkpoint.header + "\n" + checkpoint.data);
  const Parts weights = withoutDigest(model::savePolicy(trainer->policy(), {{"id", "tiny"}}));
  std::string length(8, '\0');
  for (int i = 0; i < 8; ++i) length[i] = static_cast<char>(weights.header.size() >> (8 * i) & 0xff);
  core::writeFileAtomically(folder + "/weights/tiny.safetensors", length + weights.header + weights.data);
  for (const std::string mode : {"argmax", "persistent"}) {
    const std::string acting = counted(mode) + std::string(8, '\1') + counted("f32");
    core::writeFileAtomically(folder + "/weights_message/" + mode, acting + weights.header + "\n" + weights.data);
  }
  return 0;
}
