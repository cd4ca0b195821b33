#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <charconv>
#include <cmath>
#include <map>
#include <sstream>
#include <tuple>

#include "datasets/core/fields.hpp"
#include "datasets/formats/regular_file.hpp"
#include "harness/commands/commands.hpp"
#include "harness/store/import_scores.hpp"

namespace loopbench::harness {
namespace {

/// Fields of a line of CSV; quotes are removed.
std::vector<std::string> fields_of(const std::string& line) {
  std::vector<std::string> out(1);
  bool is_quoted = false;
  for (const char c : line) {
    if (c == '"') {
      is_quoted = !is_quoted;
    } else if (c == ',' && !is_quoted) {
      out.emplace_back();
    } else if (c != '\r') {
      out.back() += c;
    }
  }
  return out;
}

double number_of(const std::string& text, const std::string& place) {
  double out = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), out);
  if (error == std::errc() && end == text.data() + text.size() && std::isfinite(out)) return out;
  throw InputError(place + ": found '" + text + "', expected a number");
}

template <class Enum>
Enum word_of(const std::string& text, const std::string& place) {
  if (const auto found = from_text<Enum>(text)) return *found;
  throw InputError(place + ": found '" + text + "', expected " + choice_list<Enum>());
}

/// Rows with equal texts apart from the value are the values of one score.
std::vector<ImportedScore> read_scores(const std::filesystem::path& file) {
  constexpr std::size_t kLargest = std::size_t{1} << 30;  // [bytes]
  static const std::map<std::string, std::string> kDefaults{{"times", "keyframes"},
                                                            {"relation", "value"},
                                                            {"axis", ""},
                                                            {"unit", "1"},
                                                            {"better", "lower"},
                                                            {"target", "0"}};
  std::istringstream lines(read_regular_file(file, kLargest, "file"));
  std::string line;
  std::getline(lines, line);
  const std::vector<std::string> names = fields_of(line);
  for (const char* name : {"key", "metric", "value"}) {
    if (std::ranges::count(names, name) == 1) continue;
    throw InputError(file.string() + ":1: expected a header with one column " + name +
                     ", and key, metric, value[, times, relation, axis, unit, better, target]");
  }
  std::vector<ImportedScore> out;
  std::vector<std::vector<double>> values;
  std::map<std::map<std::string, std::string>, std::size_t> known;
  for (std::size_t number = 2; std::getline(lines, line); ++number) {
    if (line.empty()) continue;
    const std::string place = fmt::format("{}:{}", file.string(), number);
    const std::vector<std::string> texts = fields_of(line);
    if (texts.size() != names.size()) {
      throw InputError(
          fmt::format("{}: found {} columns, expected {}", place, texts.size(), names.size()));
    }
    std::map<std::string, std::string> row = kDefaults;
    std::string value;
    for (std::size_t i = 0; i < names.size(); ++i) {
      const bool is_known =
          names[i] == "key" || names[i] == "metric" || kDefaults.contains(names[i]);
      if (names[i] == "value") value = texts[i];
      if (is_known) row[names[i]] = texts[i];
    }
    const auto [found, is_new] = known.try_emplace(row, out.size());
    if (is_new) {
      ImportedScore& score =
          out.emplace_back(ImportedScore{place, row["key"], {}, row["metric"], {}});
      if (score.metric.empty()) throw InputError(place + ": metric is empty, expected a name");
      score.times = word_of<metrics::Times>(row["times"], place);
      score.score = {row["relation"], row["axis"], row["unit"], {}};
      score.score.better = word_of<metrics::Better>(row["better"], place);
      score.score.target = number_of(row["target"], place);
      values.emplace_back();
    }
    values[found->second].push_back(number_of(value, place));
  }
  for (std::size_t i = 0; i < out.size(); ++i) {
    metrics::Score& score = out[i].score;
    score.statistics =
        values[i].size() == 1
            ? metrics::single(score.relation, score.axis, score.unit, values[i].front()).statistics
            : metrics::statistics(std::move(values[i]), 0);
  }
  return out;
}

}  // namespace

void add_import(CLI::App& app, int& exit_code) {
  auto store = std::make_shared<std::filesystem::path>();
  auto file = std::make_shared<std::filesystem::path>();
  CLI::App* command =
      app.add_subcommand("import", "Put scores that were computed elsewhere into a store");
  command->add_option("store", *store, "Folder of results, or its results.sqlite")->required();
  command
      ->add_option("scores",
                   *file,
                   "CSV file with the columns key (of the cell, as in index.csv of `export --what "
                   "trajectories`), metric and value; optional: times, relation, axis, unit, "
                   "better (lower, higher, target or neither), target; others are ignored. Rows "
                   "that differ only in the value are the values of one score")
      ->required();
  command->footer("Imported scores have the label 'METRIC (imported)' and the protocol imported.");
  command->callback([store, file, &exit_code] {
    const std::vector<ImportedScore> scores = read_scores(*file);
    const std::size_t cells = import_scores(*store, scores);
    fmt::print("{} scores of {} cells imported into {}\n", scores.size(), cells, store->string());
    exit_code = kExitOk;
  });
}

}  // namespace loopbench::harness
