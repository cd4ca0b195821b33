/// Comparison of a sweep with its baseline.
#pragma once

#include <filesystem>
#include <limits>
#include <map>
#include <string>
#include <vector>

#include "harness/answers/gate/baseline.hpp"

namespace loopbench::harness {

/// The numbers of a store that have `limits`, with all options of its sequences, the hashes of
/// their files, and the rules of its protocols. Throws InputError if it is not a store or has no
/// cells.
Snapshot snapshot(const std::filesystem::path& store, const std::vector<Tolerance>& limits);

/// Throws InputError if a sequence, protocol, metric or method of the baseline has the same label
/// in `now` but different options, stages, files or content; the message names the first difference
/// and the number of further ones. Labels that are missing in `now` are reported with their cells
/// and scores, except protocols. Contents of sequences are compared only between equal machines,
/// because the last digits of a simulated sequence can differ otherwise; returns a note where they
/// are not, otherwise an empty text.
std::string require_same_definitions(const Snapshot& baseline, const Snapshot& now);

/// Provenance of a baseline from this store.
std::map<std::string, std::string> build_summary(const std::filesystem::path& store);

struct Finding {
  enum class Kind {
    regression,   ///< worse beyond a limit, newly failed, or missing
    improvement,  ///< better beyond a limit, or newly working
    added         ///< not in the baseline
  };
  Kind kind = Kind::regression;
  std::string cell;    ///< result of `name`; of a method that fails everywhere its name
  std::string score;   ///< empty: the complete cell
  std::string what;    ///< old and new value, with the limit
  std::string method;  ///< of the cell
  /// Absolute relative change of the number; infinite if it has none to compare with.
  double change = std::numeric_limits<double>::infinity();
};

struct GateReport {
  std::size_t cells = 0;           ///< of the baseline
  std::size_t scores = 0;          ///< compared scores, that is, those with a limit
  std::vector<std::string> names;  ///< of the baseline's cells, in order
  std::map<std::string, std::size_t> cells_of_method;  ///< of the baseline, by method
  std::vector<Finding> findings;                       ///< in the order of the baseline
  std::map<std::string, std::string> failed;  ///< cells that failed now, with the stored reason
  std::vector<std::string> notes;  ///< checks that were not possible, and what is not checked
  std::vector<std::string> above;  ///< notes of the runs that can change a conclusion

  std::size_t count(Finding::Kind kind) const;
  bool passes() const { return count(Finding::Kind::regression) == 0; }
};

/// Whether `now` is the complete sweep, or a part whose missing cells are accepted.
enum class GateExtent { complete, part };

/// Throws InputError if the baseline was computed with other definitions (see
/// require_same_definitions()), has no cell in common with the results, or has a limit that selects
/// no score. Removed sequences or methods are reported as missing cells, not as other definitions.
/// O(n log n).
GateReport check(const Baseline& baseline,
                 const Snapshot& now,
                 GateExtent extent = GateExtent::complete);

}  // namespace loopbench::harness
