/// Answers claims from stores.
#pragma once

#include <algorithm>
#include <filesystem>
#include <map>
#include <string>
#include <string_view>

#include "datasets/core/error.hpp"
#include "harness/base/hash.hpp"
#include "harness/base/pattern.hpp"
#include "harness/compare/claim.hpp"
#include "harness/compare/observations.hpp"
#include "harness/compare/snapshot.hpp"
#include "harness/model/where.hpp"
#include "harness/store/read.hpp"
#include "harness/tables/all_records.hpp"
#include "harness/tables/comparison.hpp"

namespace loopbench::harness {

/// The claim's next look at a store. Throws InputError if its filters leave no score or several.
inline Look look_at_store(const Claim& claim, const std::filesystem::path& store) {
  CompareOptions options;
  options.baseline = claim.baseline;
  options.value = claim.value;
  options.over = claim.over == "sequences" ? Over::sequences : Over::groups;
  options.alpha = level_of_look(claim.alpha, claim.looks.size() + 1);
  std::vector<std::string> rules = claim.where;
  rules.push_back("method~\"" + pattern_of_any({claim.method, claim.baseline}) + "\"");
  const std::vector<Comparison> all = compare_store(store, claim.metric, rules, options);
  if (all.size() == 1) return look_at(claim, all.front(), options.alpha);
  std::string titles;
  for (const Comparison& one : all) titles += (titles.empty() ? "" : "; ") + title(one);
  throw InputError(claim.file.string() + ": where: expected filters that leave one score, found " +
                   std::to_string(all.size()) + ": " + titles);
}

/// What identifies a run in a claim: its options that differ from the defaults (`chosen`), and the
/// seed and the files of `all`, which lists all options ("NAME: a=1, seed=7; FILE BYTES HASH"). A
/// dataset can get a new option without another definition.
inline std::string definition_of_run(const std::string& chosen, const std::string& all) {
  const std::size_t files = std::min(all.find("; "), all.size());
  const std::string options = all.substr(0, files);
  constexpr std::string_view kSeed = ", seed=";
  const std::size_t seed = options.find(kSeed);
  std::string out = chosen;
  if (seed != std::string::npos) {
    const std::size_t end = options.find(',', seed + kSeed.size());
    out += options.substr(seed, end == std::string::npos ? end : end - seed);
  }
  return out + all.substr(files);
}

/// The sequences that the claim is about: the name of each with the hash of the definitions of its
/// runs, which is the same on every machine.
inline std::map<std::string, std::string> sequences_of(const Claim& claim,
                                                       const std::filesystem::path& store) {
  const Snapshot now = snapshot(store, {Tolerance{}});
  const auto passes = where(claim.where);
  std::map<std::string, std::string> chosen;  // options by run
  for (const CellRecord& cell : read_cells(store)) {
    Record run;
    run.sequence = cell.sequence;
    run.repeat = cell.repeat;
    chosen[run_name(run)] = cell.dataset_options.text();
  }
  std::map<std::string, std::map<std::string, std::string>> runs;  // definitions by sequence
  for (const GateCell& cell : now.cells) {
    if (cell.method != claim.method && cell.method != claim.baseline) continue;
    const bool is_kept =
        cell.scores.empty() ? passes(cell) : std::ranges::any_of(cell.scores, passes);
    const auto definition = now.sequences.find(run_name(cell));
    if (!is_kept || definition == now.sequences.end()) continue;
    const auto& [run, all] = *definition;
    runs[cell.sequence][run] = definition_of_run(chosen[run], all);
  }
  std::map<std::string, std::string> out;
  for (const auto& [sequence, definitions] : runs) {
    Fields fields;
    for (const auto& [run, definition] : definitions) fields.add(run).add(definition);
    out[sequence] = fields.hashed();
  }
  return out;
}

/// Throws InputError unless `now` has exactly the sequences that the claim names.
inline void require_same_sequences(const Claim& claim,
                                   const std::map<std::string, std::string>& now) {
  for (const auto& [sequence, hash] : claim.sequences) {
    const auto found = now.find(sequence);
    if (found == now.end()) {
      throw InputError(claim.file.string() + ": sequences: '" + sequence +
                       "' is not among the results; the config or its data changed");
    }
    if (found->second != hash) {
      throw InputError(claim.file.string() + ": sequences: '" + sequence +
                       "' has other runs, options or files: hash " + hash + " in the claim, " +
                       found->second + " of the results");
    }
  }
  for (const auto& [sequence, hash] : now) {
    if (claim.sequences.contains(sequence)) continue;
    throw InputError(claim.file.string() + ": sequences: the results have '" + sequence +
                     "' (hash " + hash + "), which the claim does not name");
  }
}

}  // namespace loopbench::harness
