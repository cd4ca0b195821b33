/// How the costs of methods grow with the size of their input.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "harness/answers/tables/power_law.hpp"
#include "harness/answers/tables/table.hpp"
#include "harness/sweep/model/record.hpp"

namespace loopbench::harness {

/// Entries of a sweep that differ in one or two numeric options only.
struct OptionFamily {
  struct Member {
    std::string name;            ///< label of the entry
    std::vector<double> values;  ///< of `options`
  };
  std::string name;                  ///< catalogue names: "dual + dm"
  std::vector<std::string> words;    ///< texts of options
  std::vector<std::string> options;  ///< that differ: "keyframes"
  std::vector<Member> members;       ///< at least two

  /// "simulated, room".
  std::string name_with_words() const;
};

/// A label with what the store has about its dataset or method, see CellRow.
using LabelledStages = std::pair<std::string, Shared<std::vector<Choice>>>;

/// The families of labels. Labels with other names of options are of other families. O(n log n).
std::vector<OptionFamily> option_families(const std::vector<LabelledStages>& labelled);

/// Those of the sequences and of the methods of these cells.
std::vector<OptionFamily> sequence_families(const std::vector<CellRow>& cells);
std::vector<OptionFamily> method_families(const std::vector<CellRow>& cells);

/// Costs of a method on sequences that differ in size: medians over the repeats of each sequence.
struct Growth {
  std::string family;
  std::string unit;  ///< of the sizes: keyframes or closures
  std::string method;
  std::vector<double> sizes;   ///< as loaded, increasing
  std::vector<double> cpu;     ///< processor time [ms]
  std::vector<double> wall;    ///< [ms]
  std::vector<double> memory;  ///< peak [MB]; NaN: unknown
  bool is_stated = false;      ///< some wall time is a statement of the program
};

/// Of each family of sequences with three sizes or more, and each method that has results on three.
std::vector<Growth> growths(const std::vector<CellRow>& cells);

/// A row for each of them with its fitted exponents; no rows without a sweep over a size.
Table growth_table(const std::vector<CellRow>& cells);

}  // namespace loopbench::harness
