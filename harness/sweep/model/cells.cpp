#include "harness/sweep/model/cells.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>

#include "datasets/core/error.hpp"
#include "datasets/core/hash.hpp"
#include "harness/sweep/text/pattern.hpp"

namespace loopbench::harness {
namespace {

void expect_few_cells(const Sweep& sweep, const std::vector<bool>& seeded) {
  const std::size_t count = count_cells(sweep, seeded);
  if (count <= static_cast<std::size_t>(sweep.limits.cells)) return;
  throw InputError(
      fmt::format("{}: {} datasets, {} methods and {} repeats of seeded datasets give {} cells, "
                  "expected at most {}; 'limits: {{cells: N}}' accepts more",
                  sweep.config.string(),
                  sweep.datasets.size(),
                  sweep.methods.size(),
                  sweep.repeats,
                  count,
                  sweep.limits.cells));
}

}  // namespace

std::size_t count_cells(const Sweep& sweep, const std::vector<bool>& seeded) {
  std::size_t sequences = 0;
  for (std::size_t d = 0; d < sweep.datasets.size(); ++d) {
    const auto repeats = static_cast<std::size_t>(seeded[d] ? sweep.repeats : 1);
    if (__builtin_add_overflow(sequences, repeats, &sequences)) return SIZE_MAX;
  }
  std::size_t out = 0;
  return __builtin_mul_overflow(sequences, sweep.methods.size(), &out) ? SIZE_MAX : out;
}

std::vector<Cell> cells(const Sweep& sweep,
                        const std::vector<bool>& seeded,
                        const std::string& only) {
  expect_few_cells(sweep, seeded);
  const Pattern wanted = Pattern::of_option("--only", only);
  std::vector<std::pair<Pattern, Pattern>> exclusions;
  for (const Exclusion& rule : sweep.exclude)
    exclusions.emplace_back(Pattern(rule.dataset), Pattern(rule.method));
  const auto excluded = [&](const std::string& dataset, const std::string& method) {
    return std::ranges::any_of(exclusions, [&](const auto& rule) {
      return rule.first.matches(dataset) && rule.second.matches(method);
    });
  };

  std::vector<Cell> out;
  std::size_t index = 0;
  for (std::size_t d = 0; d < sweep.datasets.size(); ++d) {
    const std::string& dataset = sweep.datasets[d].label;
    std::vector<std::size_t> chosen;
    std::vector<std::size_t> offset;
    std::size_t kept = 0;
    for (std::size_t m = 0; m < sweep.methods.size(); ++m) {
      const std::string& method = sweep.methods[m].label;
      if (excluded(dataset, method)) continue;
      if (wanted.matches_part(dataset + " / " + method)) {
        chosen.push_back(m);
        offset.push_back(kept);
      }
      ++kept;
    }
    const int repeats = seeded[d] ? sweep.repeats : 1;
    for (int repeat = 0; repeat < repeats; ++repeat) {
      for (std::size_t i = 0; i < chosen.size(); ++i) {
        out.push_back({index + offset[i], d, chosen[i], repeat});
      }
      index += kept;
    }
  }
  return out;
}

std::int64_t derived_seed(std::int64_t seed, int repeat) {
  if (repeat == 0) return seed;
  constexpr std::uint64_t kIncrement = 0x9e3779b97f4a7c15u;  // added by hash_combine() once
  const std::uint64_t state =
      static_cast<std::uint64_t>(seed) + static_cast<std::uint64_t>(repeat - 1) * kIncrement;
  return static_cast<std::int64_t>(hash_combine(state) >> 1);
}

}  // namespace loopbench::harness
