#include "harness/execution/verify/verify.hpp"

#include <algorithm>
#include <array>
#include <map>
#include <optional>

#include "harness/execution/isolate/isolated_sweep.hpp"
#include "harness/execution/isolate/pack_result.hpp"
#include "harness/execution/run/run_sweep.hpp"
#include "harness/external/exchange.hpp"
#include "harness/text/hash.hpp"

namespace loopbench::harness {
namespace {

constexpr std::array kParts{"status", "scores", "report", "trace"};

struct Digest {
  std::array<Hash, kParts.size()> parts;  ///< in the order of kParts
  bool ended_worker = false;
};

template <class... T>
Hash hash_of_values(const T&... values) {
  Packer pack;
  (pack(values), ...);
  return hash_of(pack.bytes());
}

Digest result_digest(const CellResult& r) {
  std::vector<methods::Count> counts = r.report.counts;
  std::erase_if(counts, [](const methods::Count& count) {
    return count.name == kProgramTime || count.name == kProgramMemory;
  });
  return {{hash_of_values(r.status, r.why, r.signal),
           hash_of_values(r.scores),
           hash_of_values(counts, r.report.notes, r.report.sections),
           hash_of_values(r.trace.times, r.trace.samples)},
          r.status == Status::crashed || r.status == Status::timeout ||
              r.status == Status::out_of_memory};
}

}  // namespace

std::string RunMode::name() const {
  const std::string what = isolated ? " worker" : " thread";
  return std::to_string(jobs) + what + (jobs == 1 ? "" : "s");
}

std::vector<Difference> verify(const Sweep& sweep,
                               const std::vector<Cell>& cells,
                               const Catalogue& catalogue,
                               const DataRoot& root,
                               const std::vector<RunMode>& modes,
                               const SandboxOptions& sandbox,
                               const StopRequests& stop,
                               const std::function<void(const std::string& mode)>& step) {
  std::map<std::size_t, std::size_t> index_of_cell;  // index of a cell by its position
  for (std::size_t i = 0; i < cells.size(); ++i) index_of_cell.emplace(cells[i].index, i);
  std::vector<std::optional<Digest>> first(cells.size());
  std::vector<Difference> out;
  for (std::size_t m = 0; m < modes.size(); ++m) {
    const RunMode& mode = modes[m];
    std::vector<Cell> chosen;
    for (std::size_t i = 0; i < cells.size(); ++i) {
      const bool crashes = first[i] && first[i]->ended_worker;
      if (mode.isolated || !crashes) chosen.push_back(cells[i]);
    }
    if (chosen.empty()) continue;
    std::vector<Difference> found;
    const auto finished = [&](const CellResult& result) {
      step(mode.name());
      const std::size_t cell = index_of_cell.at(result.cell.index);
      const Digest digest = result_digest(result);
      if (m == 0) first[cell] = digest;
      if (!first[cell]) return;  // interrupted
      const auto differ = std::ranges::mismatch(digest.parts, first[cell]->parts);
      if (differ.in1 == digest.parts.end()) return;
      found.push_back(
          {cell, mode.name(), kParts[static_cast<std::size_t>(differ.in1 - digest.parts.begin())]});
    };
    if (mode.isolated) {
      run_isolated(sweep, chosen, catalogue, root, mode.jobs, sandbox, stop, finished);
    } else {
      Sequences sequences(sweep, catalogue, root, chosen);
      run_sweep(sweep, chosen, catalogue, sequences, mode.jobs, stop, finished);
    }
    std::ranges::sort(found, {}, &Difference::cell);
    out.insert(out.end(), found.begin(), found.end());
  }
  return out;
}

}  // namespace loopbench::harness
