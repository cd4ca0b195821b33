/// The content key of a cell: same key, same numbers.
///
/// It covers the dataset with all its options and its repeat's seed, the bytes of every file it was
/// read from, the method's stages with all their options, the protocols with every rule, the times,
/// metrics and their options, min_coverage, how it is timed, whether a trace is kept, the version
/// of a plugin's method and the build. Labels, limits and the place in the sweep are not in it.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "harness/catalogue/catalogue.hpp"
#include "harness/model/cells.hpp"
#include "harness/model/sequence_facts.hpp"
#include "harness/model/sweep.hpp"

namespace loopbench {

class CellKeys {
 public:
  /// `build` stands for whatever else decides the numbers: build_id() outside tests.
  /// The sweep and the catalogue must live as long.
  CellKeys(const Sweep& sweep, const Catalogue& catalogue, DataRoot root, std::string build);

  /// What the config asks of a cell's sequence: a hash of dataset, options, seed and group.
  const std::string& asked(const Cell& cell);

  /// The same in words: "simulated: closures.angle=30.0, ...", every option, defaults included.
  std::string dataset_in_full(const Cell& cell) const;

  /// What the labels of metrics and methods stand for: "LABEL\tNAME, every option" a line; the
  /// stages of a method are joined by "; +".
  std::string metrics_in_full() const;
  std::string methods_in_full() const;

  /// Of what is kept about the sequence: of what is asked, the content of its files and the build.
  std::string sequence_key(const Cell& cell, const std::vector<InputFile>& inputs);

  /// `inputs`: the files the sequence was read from; empty when it never finished loading. O(1).
  std::string key(const Cell& cell, const std::vector<InputFile>& inputs);

  /// Files that the sequence was read from another time, as they are now: one that an option names
  /// is looked for again, and the content of each is hashed again. One that is gone is taken to be
  /// what it was. Throws InputError for one that cannot be read.
  std::vector<InputFile> as_they_are(const Cell& cell, std::vector<InputFile> inputs) const;

  const Sweep& sweep() const { return sweep_; }

  const std::string& build() const { return build_; }

 private:
  const Sweep& sweep_;
  const Catalogue& catalogue_;
  DataRoot root_;
  std::string build_;
  std::string judged_;                ///< protocols, metrics, times and the like, for all cells
  std::vector<std::string> methods_;  ///< for each method of the sweep
  std::map<std::pair<std::size_t, int>, std::string> asked_;
};

}  // namespace loopbench
