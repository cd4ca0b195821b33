#include "harness/shards/shard.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <functional>
#include <numeric>
#include <queue>

#include "datasets/core/error.hpp"
#include "harness/text/hash.hpp"

namespace loopbench::harness {
namespace {

constexpr std::size_t kMostShards = 1'000'000;
constexpr double kImbalance = 0.05;    // of the largest shard that is accepted without splitting
constexpr std::size_t kMostTries = 6;  // each halves the longest part of a sequence

/// Consecutive cells of one sequence.
struct SequencePart {
  std::size_t begin = 0;
  std::size_t end = 0;
  double cost = 0.0;
};

/// Sequences, split into parts of about equal cost where their cells take longer than `longest`.
std::vector<SequencePart> pieces(const std::vector<Cell>& cells,
                                 const CellCosts& costs,
                                 double longest) {
  std::vector<SequencePart> out;
  const auto is_same = [&](std::size_t a, std::size_t b) {
    return cells[a].dataset == cells[b].dataset && cells[a].repeat == cells[b].repeat;
  };
  for (std::size_t begin = 0; begin < cells.size();) {
    std::size_t end = begin;
    double sum = 0.0;
    while (end < cells.size() && is_same(begin, end)) sum += costs.cells[end++];
    const double parts =
        std::clamp(std::ceil(sum / longest), 1.0, static_cast<double>(end - begin));
    double passed = 0.0;
    double part = -1.0;
    for (std::size_t i = begin; i < end; ++i) {
      const double own =
          std::floor(parts * (passed + 0.5 * costs.cells[i]) / std::max(sum, 1e-300));
      if (own > part) out.push_back({i, i, costs.load});
      part = std::max(part, own);
      out.back().end = i + 1;
      out.back().cost += costs.cells[i];
      passed += costs.cells[i];
    }
    begin = end;
  }
  return out;
}

struct Division {
  std::vector<std::size_t> shards;
  double largest = 0.0;
  double mean = 0.0;
};

Division divided(std::vector<SequencePart> parts, std::size_t cells, std::size_t count) {
  std::ranges::stable_sort(parts, std::ranges::greater{}, &SequencePart::cost);
  using Load = std::pair<double, std::size_t>;  // of a shard, and its number
  std::priority_queue<Load, std::vector<Load>, std::greater<>> loads;
  for (std::size_t shard = 1; shard <= count; ++shard) loads.emplace(0.0, shard);
  Division out;
  out.shards.resize(cells);
  for (const SequencePart& part : parts) {
    auto [load, shard] = loads.top();
    loads.pop();
    for (std::size_t i = part.begin; i < part.end; ++i) out.shards[i] = shard;
    load += part.cost;
    out.largest = std::max(out.largest, load);
    out.mean += part.cost / static_cast<double>(count);
    loads.emplace(load, shard);
  }
  return out;
}

}  // namespace

std::string Shard::name() const { return std::to_string(number) + "/" + std::to_string(count); }

std::string Shard::folder() const {
  return std::to_string(number) + "-of-" + std::to_string(count);
}

Shard parse_shard(const std::string& text) {
  Shard out;
  const char* const end = text.data() + text.size();
  const auto first = std::from_chars(text.data(), end, out.number);
  const bool has_slash = first.ec == std::errc() && first.ptr != end && *first.ptr == '/';
  const auto second =
      has_slash ? std::from_chars(first.ptr + 1, end, out.count) : std::from_chars_result{};
  const bool is_pair = has_slash && second.ec == std::errc() && second.ptr == end;
  if (!is_pair || out.number < 1 || out.number > out.count || out.count > kMostShards) {
    throw InputError("--shard: found '" + text +
                     "', expected I/N with I from 1 to N, for example 3/8, and N up to " +
                     std::to_string(kMostShards));
  }
  return out;
}

std::vector<std::size_t> divide(const std::vector<Cell>& cells,
                                const CellCosts& costs,
                                std::size_t count) {
  if (count == 1) return std::vector<std::size_t>(cells.size(), 1);
  const double all = std::reduce(costs.cells.begin(), costs.cells.end(), 0.0);
  double longest = std::max(all / static_cast<double>(count), 1e-300);
  Division best;
  for (std::size_t attempt = 0; attempt <= kMostTries; ++attempt) {
    // First without splitting, then with parts of at most the mean, half of it, and so on.
    const double limit = attempt == 0 ? 2.0 * all + 1.0 : longest;
    Division own = divided(pieces(cells, costs, limit), cells.size(), count);
    const bool is_balanced = own.largest <= (1.0 + kImbalance) * own.mean;
    // A split loads its sequence once more, and must gain more than that.
    if (attempt == 0 || own.largest < best.largest * (1.0 - 1e-6)) best = std::move(own);
    if (is_balanced) break;
    if (attempt > 0) longest *= 0.5;
  }
  return best.shards;
}

std::string division_hash(const std::vector<Cell>& cells, const std::vector<std::size_t>& shards) {
  std::string bytes;
  for (std::size_t i = 0; i < cells.size(); ++i) {
    bytes += std::to_string(cells[i].index) + ":" + std::to_string(shards[i]) + ";";
  }
  return hex(hash_of(bytes)).substr(0, 16);
}

std::vector<Cell> cells_of(const Shard& shard,
                           const std::vector<Cell>& cells,
                           const std::vector<std::size_t>& shards) {
  std::vector<Cell> out;
  for (std::size_t i = 0; i < cells.size(); ++i) {
    if (shards[i] == shard.number) out.push_back(cells[i]);
  }
  return out;
}

}  // namespace loopbench::harness
