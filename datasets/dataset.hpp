/// A dataset: from settings to one sequence. One line in datasets.cpp lists it.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "datasets/core/fields.hpp"
#include "datasets/core/sequence.hpp"

namespace loopbench {

/// Where relative paths in options are looked for, in order (config folder, --data DIR).
struct DataRoot {
  std::vector<std::filesystem::path> folders;

  /// The first existing file. Throws DataMissing naming every place tried.
  std::filesystem::path find(const std::string& path) const;
};

/// A file named in the settings is not there; tests on real data skip on it.
class DataMissing : public InputError {
 public:
  using InputError::InputError;
};

struct DatasetEntry {
  std::string name;
  std::string summary;
  std::vector<OptionInfo> options;
  std::function<void(const Params&)> check;  ///< throws OptionError; reads no file
  /// Throws OptionError, InputError. Same settings and files give the same bits.
  std::function<Sequence(const Params&, const DataRoot&)> load;
  /// Reads what tells quickly whether load() would find its input; null: load() itself is quick.
  /// Throws as load() does.
  std::function<void(const Params&, const DataRoot&)> inspect = {};
  std::string missing_part = {};  ///< why this build cannot load it; empty: it can
};

/// Wraps `Sequence load(const Options&, const DataRoot&)` and its Options as an entry. What no
/// field can refuse alone is refused by `void check_combination(const Options&)`, or by
/// `void check_combination(const Options&, const Params& given)`, which also receives the options
/// that a config states, where there is one.
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
          {}};
}

/// Every built-in.
std::vector<DatasetEntry> datasets();

}  // namespace loopbench
