#include "harness/run/bad_inputs.hpp"

#include <exception>
#include <set>

#include "datasets/core/error.hpp"
#include "harness/base/own_process.hpp"
#include "harness/catalogue/load_sequence.hpp"

namespace loopbench::harness {

std::vector<std::string> bad_inputs(const Sweep& sweep,
                                    const std::vector<Cell>& cells,
                                    const Catalogue& catalogue,
                                    const DataRoot& root) {
  std::vector<std::string> out;
  std::set<std::size_t> seen;
  for (const Cell& cell : cells) {
    if (!seen.insert(cell.dataset).second) continue;
    const DatasetChoice& choice = sweep.datasets[cell.dataset];
    const DatasetEntry& entry = find_dataset(catalogue, choice.dataset.name);
    try {
      in_own_process(
          [&] {
            if (entry.inspect) {
              entry.inspect(choice.dataset.options, root);
            } else {
              load_sequence(cell, sweep, catalogue, root);
            }
            return std::string();
          },
          {sweep.limits.seconds, sweep.limits.memory});
    } catch (const MissingPart&) {
      throw;
    } catch (const ProcessFailure& error) {
      out.push_back(choice.label + ": a process that loaded it " + error.what());
    } catch (const std::exception& error) {
      out.push_back(choice.label + ": " + error.what());
    }
  }
  return out;
}

void require_parts(const Sweep& sweep, const std::vector<Cell>& cells, const Catalogue& catalogue) {
  for (const Cell& cell : cells) {
    const DatasetChoice& choice = sweep.datasets[cell.dataset];
    const DatasetEntry& entry = find_dataset(catalogue, choice.dataset.name);
    if (!entry.missing_part.empty()) throw MissingPart(choice.label + ": " + entry.missing_part);
  }
}

}  // namespace loopbench::harness
