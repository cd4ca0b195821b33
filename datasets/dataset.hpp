/// A dataset: from settings to one sequence. One line in datasets.cpp lists it.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "datasets/core/fields.hpp"
#include "datasets/core/sequence.hpp"

namespace loopbench {

/// What a loader is given beside its options: where relative paths are looked for, in order (config
/// folder, --data DIR), and what slow loaders use.
struct DataRoot {
  std::vector<std::filesystem::path> folders;
  /// Called by slow loaders as they go, from one thread at a time: stage, done, of how many.
  std::function<void(const std::string&, std::size_t, std::size_t)> progress = {};
  /// Called with each of a loaded sequence's notes (Provenance).
  std::function<void(const std::string&)> note = {};
  /// Where slow loaders keep what they have worked out; empty: nowhere.
  std::filesystem::path cache = {};

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
};

/// Wraps `Sequence load(const Options&, const DataRoot&)` and its Options as an entry.
template <class Options, class Load>
DatasetEntry dataset(std::string name, std::string summary, Load load) {
  return {std::move(name),
          std::move(summary),
          describe(Options{}),
          [](const Params& given) { with(Options{}, given); },
          [load](const Params& given, const DataRoot& root) {
            return load(with(Options{}, given), root);
          }};
}

/// Every built-in.
std::vector<DatasetEntry> datasets();

}  // namespace loopbench
