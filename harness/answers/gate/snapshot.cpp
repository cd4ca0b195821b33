#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <set>
#include <sstream>

#include "datasets/core/error.hpp"
#include "harness/answers/compare/derived.hpp"
#include "harness/answers/gate/gate.hpp"
#include "harness/sweep/model/evaluated_run.hpp"
#include "harness/sweep/store/read.hpp"

namespace loopbench::harness {
namespace {

constexpr std::size_t kMostScores = 1'000'000;  ///< about 200 MB of memory

/// Format of a stored list of definitions, one per line: the delimiter after the label, and how
/// much of it belongs to the label.
std::map<std::string, std::string> definitions(const std::string& text,
                                               const std::string& end_of_label,
                                               std::size_t kept) {
  std::map<std::string, std::string> out;
  std::istringstream in(text);
  for (std::string line; std::getline(in, line);) {
    const std::size_t end = line.find(end_of_label);
    if (end == std::string::npos) continue;
    out[line.substr(0, end + kept)] = line.substr(end + end_of_label.size());
  }
  return out;
}

/// A file is identified by name, size and content, for any folder.
std::string inputs_of(const std::vector<InputFile>& files) {
  std::string out;
  for (const InputFile& file : files) {
    out += "; " + std::filesystem::path(file.path).filename().string() + " " +
           std::to_string(file.bytes) + " " + file.hash;
  }
  return out;
}

std::string text_of(const std::map<std::string, std::string>& run,
                    const std::string& key,
                    const std::filesystem::path& store) {
  const auto found = run.find(key);
  if (found != run.end()) return found->second;
  throw InputError(store.string() + ": does not contain the " + key +
                   " of its config in full; `run` with the same config adds them");
}

/// Sequences of a store of evaluated files: the reference and the options of reading. The estimates
/// are the results that are checked, so neither their files nor the contents of the runs belong to
/// the definition.
void add_evaluated_sequences(const std::filesystem::path& store,
                             const std::string& options,
                             Snapshot& out) {
  const auto inputs = read_inputs(store);
  for (const Record& r : out.records) {
    const std::string label = r.cell->run_name();
    const auto files = inputs.find(label);
    if (files == inputs.end() || out.sequences.contains(label)) continue;
    const auto reference = std::ranges::find(files->second, "reference", &InputFile::option);
    if (reference == files->second.end()) continue;
    out.sequences[label] = "files: " + options + inputs_of({*reference});
  }
}

void add_sequences(const std::filesystem::path& store, Snapshot& out) {
  const auto inputs = read_inputs(store);
  const auto options = read_dataset_options(store);
  for (const CellRow& cell : read_cells(store)) {
    const std::string label = cell.run_name();
    if (out.sequences.contains(label)) continue;
    const auto files = inputs.find(label);
    const auto own = options.find(label);
    // A sequence that could not be loaded has only the options of the config.
    out.sequences[label] = (own == options.end() ? cell.dataset_options.text() : own->second) +
                           (files == inputs.end() ? "" : inputs_of(files->second));
  }
  std::set<std::string> grouped;
  for (const Record& r : out.records) {
    const CellRow& cell = *r.cell;
    const std::string label = cell.run_name();
    if (!cell.content.empty()) out.contents[label] = cell.content;
    // Larger groups leave fewer independent runs, so that the test could no longer fail.
    const bool is_named = cell.group_kind == GroupKind::named;
    if (is_named && grouped.insert(label).second) out.sequences[label] += "; " + cell.group;
  }
}

/// The parts of `text` ("name: a=1, b=2; file bytes hash") that are not in `other`.
std::string only_in(const std::string& text, const std::string& other) {
  const auto parts = [](const std::string& whole) {
    std::vector<std::string> out{""};
    for (const char c : whole) {
      if (c == ',' || c == ';') {
        out.emplace_back();
      } else if (c != ' ' || !out.back().empty()) {
        out.back() += c;
      }
    }
    return out;
  };
  const std::vector<std::string> others = parts(other);
  std::string out;
  for (const std::string& part : parts(text)) {
    if (std::ranges::count(others, part) > 0) continue;
    out += (out.empty() ? "" : ", ") + part;
  }
  return out.empty() ? text : out;
}

std::string difference(const DefinitionKind& kind,
                       const std::string& label,
                       const std::string& before,
                       const std::string* now) {
  if (kind.member == &Snapshot::contents) {
    return "the baseline has different data for the sequence '" + label +
           "' with the same options and files: its poses, edges or reference differ (hash " +
           before + ", these results " + *now + ")";
  }
  const std::string named = fmt::format("the {} '{}'", kind.one, label);
  if (now == nullptr) return "the baseline has " + named + ", but the results do not";
  return "the baseline defines " + named + " differently: it has '" + only_in(before, *now) +
         "', these results have '" + only_in(*now, before) + "'";
}

/// Throws InputError about the first label that differs, with the number of further ones. Only
/// protocols cannot be missing.
void require_same(const DefinitionKind& kind, const Snapshot& baseline, const Snapshot& now) {
  std::string first;
  std::size_t more = 0;
  for (const auto& [label, before] : baseline.*kind.member) {
    const auto found = (now.*kind.member).find(label);
    const bool is_missing = found == (now.*kind.member).end();
    if (is_missing ? kind.member != &Snapshot::protocols : found->second == before) continue;
    more += first.empty() ? 0 : 1;
    if (first.empty())
      first = difference(kind, label, before, is_missing ? nullptr : &found->second);
  }
  if (first.empty()) return;
  throw InputError(more == 0 ? first : fmt::format("{} (and {} more)", first, more));
}

}  // namespace

Snapshot snapshot(const std::filesystem::path& store, const std::vector<Tolerance>& limits) {
  const auto run = read_run(store);
  const auto provenance = read_provenance(store);
  const auto value_of = [&](const std::string& name) {
    const auto found = provenance.find(name);
    return found == provenance.end() ? "unknown" : found->second;
  };
  Snapshot out;
  out.sweep = run.at("sweep");
  out.machine = value_of("compiler") + ", " + value_of("flags") + ", " + value_of("c library") +
                ", " + value_of("cpu");
  out.protocols = definitions(run.at("protocol"), "]: ", 1);
  out.metrics = definitions(text_of(run, "metrics", store), "\t", 0);
  out.methods = definitions(text_of(run, "methods", store), "\t", 0);
  const bool has_times = limits_time(limits);
  std::vector<std::string> asked;
  for (const Tolerance& limit : limits) {  // rejects an unknown statistic
    for (const std::string& statistic : limit.values) value({}, statistic);
    asked.insert(asked.end(), limit.where.begin(), limit.where.end());
  }
  RecordReader(store).for_each_chunk([&](std::vector<Record>& records) {
    if (has_times) {
      std::vector<Record> costs = cost_scores(records, asked);
      std::ranges::move(run_times(records), std::back_inserter(records));
      std::ranges::move(costs, std::back_inserter(records));
    }
    std::ranges::move(checked_records(std::move(records), limits), std::back_inserter(out.records));
    if (out.records.size() <= kMostScores) return true;
    throw InputError(fmt::format(
        "{}: has more than {} scores to check, which a baseline cannot hold; restrict them by the "
        "`where` of the baseline's limits",
        store.string(),
        kMostScores));
  });
  if (has_times) {
    // Times on different machines are not comparable.
    const std::string cpu = value_of("cpu");
    out.protocols["time"] = cpu == "unknown" ? "on an unknown CPU" : "on " + cpu;
  }
  if (out.records.empty()) throw InputError(store.string() + ": has no cells to check");
  if (const auto config = run.find("config"); config != run.end() && is_of_files(config->second)) {
    add_evaluated_sequences(store, evaluated_options(config->second), out);
  } else {
    add_sequences(store, out);
  }
  return out;
}

std::string require_same_definitions(const Snapshot& baseline, const Snapshot& now) {
  const bool is_same_machine = !baseline.machine.empty() && baseline.machine == now.machine;
  for (const DefinitionKind& kind : kDefinitions) {
    if (kind.member != &Snapshot::contents || is_same_machine) require_same(kind, baseline, now);
  }
  if (is_same_machine || baseline.contents.empty()) return "";
  return "contents of sequences are not compared: the baseline is from another machine (" +
         baseline.machine + ")";
}

std::map<std::string, std::string> build_summary(const std::filesystem::path& store) {
  std::map<std::string, std::string> out{{"loopbench", read_run(store).at("loopbench")}};
  for (const auto& [key, value] : read_provenance(store)) {
    for (const char* kept : {"commit", "source", "compiler", "flags"}) {
      if (key == kept) out[key] = value;
    }
  }
  return out;
}

}  // namespace loopbench::harness
