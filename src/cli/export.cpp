#include <filesystem>
#include <memory>

#include "command.h"
#include "early_fusion/core/error.h"
#include "early_fusion/core/output_file.h"
#include "early_fusion/model/policy_export.h"
#include "early_fusion/model/policy_file.h"

namespace early_fusion::cli {

namespace {

struct ExportOptions {
  std::string frames = "bytes";
  std::string out;

  core::OptionSet options() {
    core::OptionSet set("export");
    set.addChoice("frames", frames, {"bytes", "float"},
                  "type of the numbers in the frames, 0 to 255; float is for runtimes that take no bytes");
    set.add("out", out, "the ONNX file to write; - is standard output");
    return set;
  }
};

struct Arguments {
  std::string weights;
  core::GivenOptions given;
};

void exportWeights(const Arguments& arguments) {
  ExportOptions options;
  core::OptionSet set = options.options();
  for (const auto& [name, value] : arguments.given) set.set(name, value, "command line");
  std::error_code not_there;
  if (std::filesystem::equivalent(options.out, arguments.weights, not_there)) {
    throw core::Error("--out: " + options.out + " is the weights file itself; name another file");
  }
  core::OutputFile out("--out", options.out);
  const nn::WeightsFile file = nn::WeightsFile::read(arguments.weights);
  const auto policy = model::loadPolicy(file, arguments.weights, "f32");
  out.write(model::exportOnnx(*policy, options.frames == "bytes" ? nn::OnnxType::kByte : nn::OnnxType::kFloat,
                              {file.metadata.begin(), file.metadata.end()}));
}

}  // namespace

void addExport(CLI::App& app) {
  CLI::App* command = app.add_subcommand(
      "export",
      "Write a trained policy as an ONNX file, for other runtimes such as onnxruntime, TensorRT and OpenCV.\n"
      "Example: early_fusion export models/medium.safetensors --out policy.onnx");
  const auto arguments = std::make_shared<Arguments>();
  command->add_option("weights", arguments->weights, "a weights file or a checkpoint")->required();
  addOptionFlags<ExportOptions>(*command, arguments->given);
  command->get_option("--out")->required();
  command->callback([arguments] { exportWeights(*arguments); });
}

}  // namespace early_fusion::cli
