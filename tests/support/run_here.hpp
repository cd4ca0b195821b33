/// Runs cells one after another in this process: no worker processes, no limits.
#pragma once

#include <functional>
#include <map>
#include <memory>
#include <utility>
#include <vector>

#include "harness/catalogue/load_sequence.hpp"
#include "harness/model/result.hpp"
#include "harness/run/run_cell.hpp"
#include "harness/run/summarise_sequence.hpp"

namespace loopbench {

inline void run_here(const harness::Sweep& sweep,
                     const std::vector<harness::Cell>& cells,
                     const harness::Catalogue& catalogue,
                     const DataRoot& root,
                     const std::function<void(const harness::CellResult&)>& finished) {
  using Metadata = std::shared_ptr<const harness::SequenceMetadata>;
  std::map<std::pair<std::size_t, int>, std::pair<Sequence, Metadata>> loaded;
  for (const harness::Cell& cell : cells) {
    const std::pair key{cell.dataset, cell.repeat};
    if (!loaded.contains(key)) {
      Sequence sequence = harness::load_sequence(cell, sweep, catalogue, root);
      auto metadata = std::make_shared<const harness::SequenceMetadata>(
          harness::metadata_of(sequence, cell, sweep));
      loaded.emplace(key, std::pair{std::move(sequence), std::move(metadata)});
    }
    const auto& [sequence, metadata] = loaded.at(key);
    harness::CellResult result = harness::run_cell(cell, sweep, sequence, catalogue);
    result.metadata = metadata;
    finished(result);
  }
}

}  // namespace loopbench
