// The YAML text of a session's options, and that the values are written as they were read.
#include "early_fusion/learning/session_options.h"
#include "fuzz_target.h"

using namespace early_fusion;

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  learning::SessionOptions options, again;
  const std::string text(reinterpret_cast<const char*>(data), size);
  if (fuzz::allowError([&] { options.options().setFromYamlText(text, "input"); })) return 0;
  fuzz::allowError([&] {
    again.options().setFromYamlText(options.options().toYaml(), "output");
    fuzz::require(again.options().toYaml() == options.options().toYaml(), "the options changed");
  });
  return 0;
}
