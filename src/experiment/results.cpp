#include "early_fusion/experiment/results.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <limits>
#include <map>
#include <nlohmann/json.hpp>
#include <sstream>

#include "early_fusion/core/error.h"
#include "early_fusion/core/file.h"
#include "early_fusion/core/names.h"

namespace early_fusion::experiment {

namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
enum Measure : std::size_t { kTrajectories, kMinutes, kF1, kPrecision, kRecall, kAgreement };

using Numbers = std::array<double, kMeasures.size()>;

std::vector<std::string> split(const std::string& line) {
  std::vector<std::string> cells;
  std::istringstream stream(line);
  for (std::string cell; std::getline(stream, cell, ',');) cells.push_back(cell);
  return cells;
}

double numberIn(const std::string& text, const std::string& source) {
  std::istringstream stream(text);
  double number = 0;
  if (!(stream >> number) || !(stream >> std::ws).eof()) throw core::Error(source + ": '" + text + "' is not a number");
  return number;
}

std::vector<ResultRow> ownScores(const CellFolder& folder) {
  std::vector<ResultRow> rows;
  const learning::ScoreCurve curve = folder.scoreCurve();
  for (const learning::ScorePoint& point : curve.points()) {
    const Numbers numbers = {static_cast<double>(point.trajectories),
                             point.minutes,
                             point.f1,
                             point.precision,
                             point.recall,
                             point.agreement};
    rows.push_back({&folder.cell(), kOwnEvaluation, numbers, false});
  }
  if (folder.trained() && !rows.empty()) rows.back().final = true;
  return rows;
}

/// What `evaluate --json` wrote. @param trained the session's final scoring.
ResultRow scoresInJson(const std::string& file, const FollowUp& follow_up, const ResultRow& trained) {
  ResultRow row{trained.cell, follow_up.name, trained.numbers, true};
  try {
    const auto json = nlohmann::json::parse(core::readFile(file));
    for (std::size_t i = kF1; i < kMeasures.size(); ++i) row.numbers[i] = json.at(kMeasures[i]).get<double>();
  } catch (const nlohmann::json::exception& error) {
    throw core::Error(file + ": has no scores as `evaluate --json` writes them: " + error.what());
  }
  return row;
}

/// A table with at least a column f1.
std::vector<ResultRow> scoresInCsv(const std::string& file, const FollowUp& follow_up, const Cell& cell) {
  std::istringstream stream(core::readFile(file));
  std::string line;
  std::getline(stream, line);
  const std::vector<std::string> header = split(line);
  if (std::find(header.begin(), header.end(), kMeasures[kF1]) == header.end()) {
    throw core::Error(file + ": the first line has no column " + kMeasures[kF1] + ": '" + line + "'");
  }
  std::vector<ResultRow> rows;
  std::map<std::string, std::size_t> last;  // row by evaluation
  while (std::getline(stream, line)) {
    const std::vector<std::string> cells = split(line);
    if (cells.size() != header.size()) throw core::Error(file + ": '" + line + "' has not as many columns as line 1");
    ResultRow row{&cell, follow_up.name, {}, false};
    row.numbers.fill(kNone);
    for (std::size_t i = 0; i < header.size(); ++i) {
      const auto measure = std::find(kMeasures.begin(), kMeasures.end(), header[i]);
      if (measure != kMeasures.end()) row.numbers[measure - kMeasures.begin()] = numberIn(cells[i], file);
      if (header[i] == "evaluation") row.evaluation += "/" + cells[i];
    }
    last[row.evaluation] = rows.size();
    rows.push_back(row);
  }
  for (const auto& [evaluation, index] : last) rows[index].final = true;
  return rows;
}

std::string csvCell(const std::string& text) {
  if (text.find_first_of(",\"\n") == std::string::npos) return text;
  std::string quoted = "\"";
  for (char c : text) quoted += c == '"' ? "\"\"" : std::string(1, c);
  return quoted + "\"";
}

std::string numberText(double number, int decimals) {
  if (std::isnan(number)) return "";
  char text[40];
  std::snprintf(text, sizeof(text), "%.*f", decimals, number);
  return text;
}

/// The final scorings of cells that differ only in their seed.
struct Group {
  std::vector<std::string> key;  // the values of the columns without the seed, and the evaluation
  std::vector<Numbers> seeds;

  double mean(Measure measure) const {
    double sum = 0;
    for (const Numbers& numbers : seeds) sum += numbers[measure];
    return sum / static_cast<double>(seeds.size());
  }

  std::string f1() const {
    std::string text = numberText(mean(kF1), 3);
    if (seeds.size() == 1) return text;
    const auto [least, greatest] = std::minmax_element(
        seeds.begin(), seeds.end(), [](const Numbers& a, const Numbers& b) { return a[kF1] < b[kF1]; });
    return text + " (" + numberText((*least)[kF1], 3) + " to " + numberText((*greatest)[kF1], 3) + ")";
  }
};

/// A column of the grid that has the name of a measure gets another one.
std::string headerOf(const std::string& column) {
  const bool is_measure = std::find(kMeasures.begin(), kMeasures.end(), column) != kMeasures.end();
  return (is_measure ? "session_" : "") + column;
}

bool isSeed(const std::string& column) { return column == "seed"; }

std::vector<Group> groupsOf(const Experiment& experiment, const std::vector<ResultRow>& rows) {
  std::vector<Group> groups;
  for (const ResultRow& row : rows) {
    if (!row.final) continue;
    std::vector<std::string> key;
    for (std::size_t i = 0; i < experiment.columns.size(); ++i) {
      if (!isSeed(experiment.columns[i])) key.push_back(row.cell->values[i]);
    }
    key.push_back(row.evaluation);
    auto group = std::find_if(groups.begin(), groups.end(), [&](const Group& other) { return other.key == key; });
    if (group == groups.end()) group = groups.insert(groups.end(), Group{key, {}});
    group->seeds.push_back(row.numbers);
  }
  return groups;
}

std::string tableRow(const std::vector<std::string>& cells) { return "| " + core::joined(cells, " | ") + " |\n"; }

}  // namespace

std::vector<ResultRow> collectResults(const Experiment& experiment, const std::vector<CellFolder>& folders) {
  std::vector<ResultRow> rows;
  for (const CellFolder& folder : folders) {
    const std::vector<ResultRow> own = ownScores(folder);
    rows.insert(rows.end(), own.begin(), own.end());
    for (const FollowUp& follow_up : experiment.follow_ups) {
      const std::string file = folder.scoresOf(follow_up);
      if (file.empty() || own.empty()) continue;
      if (std::filesystem::path(file).extension() == ".json") {
        rows.push_back(scoresInJson(file, follow_up, own.back()));
      } else {
        const std::vector<ResultRow> more = scoresInCsv(file, follow_up, folder.cell());
        rows.insert(rows.end(), more.begin(), more.end());
      }
    }
  }
  return rows;
}

std::string resultsCsv(const Experiment& experiment, const std::vector<ResultRow>& rows) {
  std::vector<std::string> header = {"cell"};
  for (const std::string& column : experiment.columns) header.push_back(headerOf(column));
  header.push_back("evaluation");
  header.insert(header.end(), kMeasures.begin(), kMeasures.end());
  std::string csv = core::joined(header, ",") + "\n";
  for (const ResultRow& row : rows) {
    std::vector<std::string> cells = {row.cell->name};
    for (const std::string& value : row.cell->values) cells.push_back(csvCell(value));
    cells.push_back(csvCell(row.evaluation));
    cells.push_back(numberText(row.numbers[kTrajectories], 0));
    cells.push_back(numberText(row.numbers[kMinutes], 2));
    for (std::size_t i = kF1; i < kMeasures.size(); ++i) cells.push_back(numberText(row.numbers[i], 6));
    csv += core::joined(cells, ",") + "\n";
  }
  return csv;
}

std::string resultsTable(const Experiment& experiment, const std::vector<ResultRow>& rows) {
  std::vector<std::string> header;
  for (const std::string& column : experiment.columns) {
    if (!isSeed(column)) header.push_back(headerOf(column));
  }
  header.insert(header.end(),
                {"evaluation", "seeds", "trajectories", "minutes", "F1", "precision", "recall", "agreement"});
  std::string table = experiment.question + "\n\n" + tableRow(header) + tableRow({header.size(), "---"});
  for (const Group& group : groupsOf(experiment, rows)) {
    std::vector<std::string> cells = group.key;
    cells.push_back(std::to_string(group.seeds.size()));
    cells.push_back(numberText(group.mean(kTrajectories), 0));
    cells.push_back(numberText(group.mean(kMinutes), 1));
    cells.push_back(group.f1());
    for (Measure measure : {kPrecision, kRecall, kAgreement}) cells.push_back(numberText(group.mean(measure), 3));
    table += tableRow(cells);
  }
  return table;
}

}  // namespace early_fusion::experiment
