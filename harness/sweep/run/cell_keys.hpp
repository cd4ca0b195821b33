/// Content key of a cell: equal keys mean equal results.
///
/// It covers the dataset with all its options and its repeat's seed, the bytes of its input files,
/// the method's stages with all their options, the protocols with all fields, the times, metrics
/// and their options, min_coverage, the timing mode, whether a trace is kept, the version of a
/// plugin's method and the build. Labels, limits and the position in the sweep are not included.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "harness/sweep/catalogue/catalogue.hpp"
#include "harness/sweep/model/cells.hpp"
#include "harness/sweep/model/sequence_metadata.hpp"
#include "harness/sweep/model/sweep.hpp"

namespace loopbench::harness {

class CellKeys {
 public:
  /// `build` identifies the program: build_id(). Sweep and catalogue must outlive
  /// this.
  CellKeys(const Sweep& sweep, const Catalogue& catalogue, DataRoot root, std::string build);

  /// Hash of a cell's sequence as configured: dataset, options, seed and group.
  const std::string& configuration_hash(const Cell& cell);

  /// The same as text: "simulated: closures.angle=30.0, ..." with all options.
  std::string dataset_text(const Cell& cell) const;

  /// The stages of a method with all options.
  std::vector<Choice> stages_in_full(const MethodChoice& method) const;

  /// Definitions of the labels of metrics and methods: one line "LABEL\tNAME, all options" each;
  /// the stages of a method are joined by "; +".
  std::string metric_definitions() const;
  std::string method_definitions() const;

  /// Key of a sequence's stored metadata: configuration, content of its files and build.
  std::string sequence_key(const Cell& cell, const std::vector<InputFile>& inputs);

  /// `inputs`: input files of the sequence; empty if it could not be loaded. O(1).
  std::string key(const Cell& cell, const std::vector<InputFile>& inputs);

  /// Current state of files that the sequence was read from earlier: searches again for files named
  /// by an option and hashes all of them again. A file that does not exist is assumed unchanged.
  /// Throws InputError for a file that cannot be read.
  std::vector<InputFile> current_inputs(const Cell& cell, std::vector<InputFile> inputs) const;

  const Sweep& sweep() const { return sweep_; }

  const std::string& build() const { return build_; }

 private:
  const Sweep& sweep_;
  const Catalogue& catalogue_;
  DataRoot root_;
  std::string build_;
  std::string evaluation_;            ///< protocols, metrics, times and so on, common to all cells
  std::vector<std::string> methods_;  ///< for each method of the sweep
  std::map<std::pair<std::size_t, int>, std::string> asked_;
};

}  // namespace loopbench::harness
