#pragma once

#include <string>

#include "early_fusion/experiment/cell_folder.h"
#include "temporary_folder.h"

namespace early_fusion::experiment {

/// An experiment of three cells, early_fusion-seed_1, early_fusion-seed_2 and late_fusion, in a folder of its own. Its
/// cells have run folders that a test writes.
class SmallExperiment {
 public:
  explicit SmallExperiment(const std::string& more = "")
      : experiment(loadExperiment(files.write("trial.yaml",
                                              "question: Which?\n"
                                              "options: {trajectories: 100}\n"
                                              "grid:\n"
                                              "  - {kind: [early_fusion], seed: [1, 2]}\n"
                                              "  - {kind: [late_fusion]}\n" +
                                                  more))) {}

  std::string output() const { return files.path("run"); }
  std::vector<CellFolder> folders() const { return cellFolders(experiment, output()); }

  void write(const std::string& cell, const std::string& file, const std::string& text) const {
    files.write("run/" + cell + "/" + file, text);
  }

  /// A finished session with one score on its way.
  void writeScores(const std::string& cell, const std::string& f1) const {
    write(cell, "scores.csv",
          "trajectories,minutes,f1,precision,recall,agreement\n50,1.500,0.100000,0.2,0.3,0.4\n100,3.000," + f1 +
              ",0.800000,0.700000,0.600000\n");
    write(cell, "result.json", "{}");
  }

  const TemporaryFolder files;
  const Experiment experiment;
};

}  // namespace early_fusion::experiment
