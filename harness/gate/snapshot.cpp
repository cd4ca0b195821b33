#include "harness/gate/snapshot.hpp"

#include <sstream>

#include "datasets/core/error.hpp"
#include "harness/export/derived.hpp"
#include "harness/store/read.hpp"

namespace loopbench {
namespace {

/// One protocol a line, "label [version]: every rule", as the store keeps them.
std::map<std::string, std::string> protocols(const std::string& text) {
  std::map<std::string, std::string> out;
  std::istringstream in(text);
  for (std::string line; std::getline(in, line);) {
    const std::size_t end = line.find("]: ");
    if (end == std::string::npos) continue;
    out[line.substr(0, end + 1)] = line.substr(end + 3);
  }
  return out;
}

/// Where a file lies is not what it is: names, sizes and hashes of content.
std::string inputs_of(const std::vector<InputFile>& files) {
  std::string out;
  for (const InputFile& file : files) {
    out += "; " + std::filesystem::path(file.path).filename().string() + " " +
           std::to_string(file.bytes) + " " + file.hash;
  }
  return out;
}

}  // namespace

Snapshot snapshot(const std::filesystem::path& store, const std::vector<Tolerance>& limits) {
  const auto run = read_run(store);
  Snapshot out;
  out.sweep = run.at("sweep");
  out.protocols = protocols(run.at("protocol"));
  std::vector<Record> records = read_records(store);
  if (limits_time(limits)) {
    for (Record& time : run_times(records)) records.push_back(std::move(time));
    const auto made = read_provenance(store);
    const auto cpu = made.find("cpu");
    // Times on another machine are not worse or better, they are others.
    out.protocols["time"] = cpu == made.end() ? "on an unknown CPU" : "on " + cpu->second;
  }
  out.cells = gate_cells(records, limits);
  if (out.cells.empty()) throw InputError(store.string() + ": holds no cell, nothing to check");
  const auto inputs = read_inputs(store);
  const auto options = read_dataset_options(store);
  for (const CellRecord& cell : read_cells(store)) {
    const std::string label = cell.repeat == 0
                                  ? cell.sequence
                                  : cell.sequence + " (repeat " + std::to_string(cell.repeat) + ")";
    if (out.sequences.contains(label)) continue;
    const auto files = inputs.find(label);
    const auto own = options.find(label);
    // One that never finished loading has only what the config says of it.
    out.sequences[label] = (own == options.end() ? cell.dataset_options : own->second) +
                           (files == inputs.end() ? "" : inputs_of(files->second));
  }
  return out;
}

std::map<std::string, std::string> made_by(const std::filesystem::path& store) {
  std::map<std::string, std::string> out{{"loopbench", read_run(store).at("loopbench")}};
  for (const auto& [key, value] : read_provenance(store)) {
    for (const char* kept : {"commit", "state", "compiler", "flags"}) {
      if (key == kept) out[key] = value;
    }
  }
  return out;
}

}  // namespace loopbench
