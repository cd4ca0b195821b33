/// One results folder under attack.
#pragma once

#include <chrono>
#include <filesystem>
#include <map>
#include <random>
#include <set>
#include <stdexcept>
#include <string>
#include <vector>

#include "tests/campaign/child.hpp"

namespace loopbench::campaign {

struct Settings {
  std::filesystem::path binary;
  std::filesystem::path config;
  std::vector<std::filesystem::path> plugins;
  std::filesystem::path folder;            ///< for all files of the campaign
  std::chrono::milliseconds limit{60000};  ///< longest time without attack, then it counts as hang
};

/// The undisturbed sweep.
struct Undisturbed {
  int exit_code = 0;
  std::string text;  ///< store_text() without traces of sequences
  std::set<std::string> cells;
  std::chrono::duration<double> takes{};
};

/// A broken promise of the program.
struct Broken : std::runtime_error {
  using std::runtime_error::runtime_error;
};

class History {
 public:
  History(const Settings& settings, const Undisturbed& undisturbed, std::uint64_t seed);

  std::mt19937_64 random;
  std::map<std::string, int> counts;  ///< of what happened, for the report

  const Settings& settings() const { return settings_; }
  const Undisturbed& undisturbed() const { return undisturbed_; }
  const std::filesystem::path& out() const { return out_; }
  std::filesystem::path store() const { return out_ / "results.sqlite"; }
  std::filesystem::path path(const std::string& name) const { return folder_ / name; }

  /// `loopbench run CONFIG --out OUT MORE`, in words; OUT defaults to out().
  std::vector<std::string> run_words(const std::vector<std::string>& more = {},
                                     const std::filesystem::path& out = {}) const;

  /// Runs `loopbench WORDS` to its end. Throws Broken if its exit code is not one of `codes`.
  int command(const std::vector<std::string>& words,
              const std::set<int>& codes,
              std::uint64_t file_limit = 0);

  /// Throws Broken if the exit code is not one of `codes`, and if a process is left.
  int ended(Child& child, const std::set<int>& codes);

  /// Sleeps for a random share of the time of a sweep.
  void sleep_some();

  bool one_in(unsigned n) { return random() % n == 0; }

  /// Labels of the store's cells, with its log; empty without a store. Throws Broken if it is
  /// damaged.
  std::set<std::string> cells(const std::filesystem::path& store) const;

  /// Throws Broken unless `store` has all cells that it had.
  void expect_kept(const std::filesystem::path& store, const std::set<std::string>& before) const;

  /// Finishes the sweep and throws Broken if the store, or any file in the folders, is not as
  /// without attacks.
  void finish();

  std::string output() const;  ///< of the last process

 private:
  const Settings& settings_;
  const Undisturbed& undisturbed_;
  std::filesystem::path folder_;
  std::filesystem::path out_;
};

/// Runs the sweep once without attacks.
Undisturbed undisturbed_sweep(const Settings& settings);

}  // namespace loopbench::campaign
