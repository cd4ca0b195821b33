/// Interface of a dataset, which loads one sequence from options. Registered in datasets.cpp.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "datasets/core/fields.hpp"
#include "datasets/core/sequence.hpp"

namespace loopbench {

/// Search folders for relative paths in options, in order (config folder, --data DIR).
struct DataRoot {
  std::vector<std::filesystem::path> folders;

  /// Returns the first existing file. Throws DataMissing with the list of searched folders.
  std::filesystem::path find(const std::string& path) const;
};

/// A file named in an option does not exist. Tests on real data are skipped in this case.
class DataMissing : public InputError {
 public:
  using InputError::InputError;
};

struct DatasetEntry {
  std::string name;
  std::string summary;
  std::vector<OptionInfo> options;
  std::function<void(const Params&)> check;  ///< throws OptionError; does not read files
  /// Throws OptionError, InputError. Bit-identical results for equal options and files.
  std::function<Sequence(const Params&, const DataRoot&)> load;
  /// Checks quickly whether the input of load() exists; null if load() itself is fast. Throws the
  /// same exceptions as load().
  std::function<void(const Params&, const DataRoot&)> inspect = {};
  std::string missing_part = {};  ///< why this build cannot load it; empty: it can
  /// Computes what sequences with other seeds share, in the process that is copied for each of
  /// them; null: nothing. Quick, and without threads.
  std::function<void(const Params&)> prepare = {};
};

/// Wraps `Sequence load(const Options&, const DataRoot&)` and its Options as an entry. Combinations
/// of options are checked by `void check_combination(const Options&)` or
/// `void check_combination(const Options&, const Params& given)`, if one is declared; `given` holds
/// the options set in the config.
template <class Options, class Load>
DatasetEntry dataset(std::string name, std::string summary, Load load) {
  return {std::move(name),
          std::move(summary),
          describe(Options{}),
          [](const Params& given) {
            const Options options = with(Options{}, given);
            if constexpr (requires { check_combination(options, given); }) {
              check_combination(options, given);
            } else if constexpr (requires { check_combination(options); }) {
              check_combination(options);
            }
          },
          [load](const Params& given, const DataRoot& root) {
            return load(with(Options{}, given), root);
          },
          {},
          {},
          {}};
}

/// All built-in datasets that need no images.
std::vector<DatasetEntry> datasets();

}  // namespace loopbench
