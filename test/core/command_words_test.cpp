#include "early_fusion/core/command_words.h"

#include <gtest/gtest.h>

#include <array>
#include <cstdio>

namespace early_fusion::core {
namespace {

std::string outputOf(const std::string& command) {
  FILE* const pipe = ::popen(command.c_str(), "r");
  std::string output;
  std::array<char, 256> buffer{};
  for (std::size_t n = 0; (n = std::fread(buffer.data(), 1, buffer.size(), pipe)) > 0;) output.append(buffer.data(), n);
  ::pclose(pipe);
  return output;
}

TEST(CommandWords, FlagsHaveTheSetsOrderAndTheLastGivenValue) {
  int trajectories = 0;
  bool resume = false, quiet = true;
  OptionSet set("test");
  set.add("trajectories_per_round", trajectories, 0, 10, "", "");
  set.add("resume", resume, "");
  set.add("quiet", quiet, "");
  EXPECT_EQ(flagWords(set, {{"quiet", "false"},
                            {"resume", "true"},
                            {"trajectories_per_round", "3"},
                            {"resume", "true"},
                            {"trajectories_per_round", "4"}}),
            (Words{"--trajectories-per-round", "4", "--resume", "--quiet=false"}));
}

TEST(CommandWords, AShellReadsTheWordsThatWereWritten) {
  const Words words = {"plain-1.5/x", "", "two words", "it's", "$HOME", "a;b|c&d", "\"", "\\", "*", "{cell}", "~"};
  std::string expected;
  for (const std::string& word : words) expected += word + "\n";
  EXPECT_EQ(outputOf("printf '%s\\n' " + shellText(words)), expected);
  EXPECT_EQ(shellText({"early_fusion", "--task", "hard"}), "early_fusion --task hard");
}

}  // namespace
}  // namespace early_fusion::core
