#include "tests/studies/error_rates.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "harness/store/read.hpp"
#include "harness/tables/all_records.hpp"
#include "tests/studies/synthetic_store.hpp"
#include "tests/support/temporary_folder.hpp"

namespace loopbench::synthetic {

using namespace methods;
using namespace metrics;
using namespace harness;

namespace {

const MethodVerdict* verdict_of(const Comparison& c, std::size_t method) {
  const auto found =
      std::ranges::find(c.methods, "m" + std::to_string(method), &MethodVerdict::method);
  return found == c.methods.end() ? nullptr : &*found;
}

/// The only method with the lowest effect; the number of methods if several share it.
std::size_t truly_best(const Truth& truth) {
  const auto least = std::ranges::min_element(truth.effects);
  if (std::ranges::count(truth.effects, *least) > 1) return truth.effects.size();
  return static_cast<std::size_t>(least - truth.effects.begin());
}

/// Whether the letters claim an order that does not hold: methods without a common letter are
/// claimed to differ, the first in order being better. Of methods with equal effects, the one that
/// fails less often is better.
bool has_false_claim(const Comparison& c, const Truth& truth) {
  const auto error = [&](const MethodVerdict& m) {
    const auto i = static_cast<std::size_t>(std::stoi(m.method.substr(1)));
    return std::pair(truth.effects[i], truth.failures.empty() ? 0.0 : truth.failures[i]);
  };
  for (std::size_t i = 0; i < c.methods.size(); ++i) {
    for (std::size_t j = i + 1; j < c.methods.size(); ++j) {
      const bool is_claimed =
          c.methods[i].letters.find_first_of(c.methods[j].letters) == std::string::npos;
      if (is_claimed && error(c.methods[i]) >= error(c.methods[j])) return true;
    }
  }
  return false;
}

/// The method that a table of the records marks as best; the number of methods if none is marked.
std::size_t marked(const std::vector<Record>& all, std::size_t methods) {
  const Table table = pivot(all, TableSpec{.split = {"times"}, .show = {}, .where = {}}).at(0);
  for (std::size_t row = 0; row < table.rows.size(); ++row) {
    for (const TableEntry& entry : table.entries[row]) {
      if (entry.mark == Mark::best)
        return static_cast<std::size_t>(std::stoi(table.rows[row].substr(1)));
    }
  }
  return methods;
}

/// Comparison and records of one draw.
struct Drawn {
  Comparison comparison;
  std::vector<Record> records;
};

Drawn drawn(const std::vector<Record>& all, Through through, const TemporaryFolder& folder) {
  if (through == Through::memory) return {compare(all, {.baseline = "m0"}).at(0), all};
  write_store(all, folder.path());
  std::vector<Record> read = read_records(folder.path());
  return {compare_store(folder.path(), "ate", {}, {}).at(0), std::move(read)};
}

}  // namespace

ErrorRates error_rates(
    const Truth& truth, const Shape& shape, int repeats, std::uint64_t seed, Through through) {
  std::mt19937_64 bits(seed);
  const TemporaryFolder folder;
  ErrorRates out;
  const std::size_t best = truly_best(truth);
  for (int i = 0; i < repeats; ++i) {
    const auto [c, all] = drawn(records(truth, shape, bits), through, folder);
    const bool is_right = c.is_best_proven && c.methods[0].method == "m" + std::to_string(best);
    out.found += is_right ? 1.0 : 0.0;
    out.false_best += c.is_best_proven && !is_right ? 1.0 : 0.0;
    out.false_better += has_false_claim(c, truth) ? 1.0 : 0.0;
    const std::size_t mark = marked(all, truth.effects.size());
    out.marked_wrong += mark != truth.effects.size() && mark != best ? 1.0 : 0.0;
  }
  for (double* rate : {&out.found, &out.false_best, &out.false_better, &out.marked_wrong}) {
    *rate /= repeats;
  }
  return out;
}

IntervalCoverage coverage(
    const Truth& truth, const Shape& shape, int repeats, std::uint64_t seed, Through through) {
  std::mt19937_64 bits(seed);
  const TemporaryFolder folder;
  const double ratio = std::exp(truth.effects[1] - truth.effects[0]);
  int given = 0;
  int held = 0;
  for (int i = 0; i < repeats; ++i) {
    const Comparison c = drawn(records(truth, shape, bits), through, folder).comparison;
    const MethodVerdict* method = verdict_of(c, 1);
    if (method == nullptr || !method->has_interval) continue;
    ++given;
    held += method->ratio->low <= ratio && ratio <= method->ratio->high ? 1 : 0;
  }
  return {given > 0 ? static_cast<double>(held) / given : 1.0,
          1.0 - static_cast<double>(given) / repeats};
}

}  // namespace loopbench::synthetic
