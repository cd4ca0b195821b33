/// Division of a sweep into shards that run on different machines.
#pragma once

#include <charconv>
#include <cstddef>
#include <string>
#include <vector>

#include "datasets/core/error.hpp"
#include "harness/sweep/model/cells.hpp"
#include "harness/sweep/text/hash.hpp"

namespace loopbench::harness {

/// One of `count` parts of a sweep, numbered from 1.
struct Shard {
  std::size_t number = 1;
  std::size_t count = 1;

  std::string name() const;    ///< "3/8"
  std::string folder() const;  ///< "3-of-8"
};

inline constexpr std::size_t kMostShards = 1'000'000;

/// For each cell the number of its sequence, from 0.
inline std::vector<std::size_t> sequence_numbers(const std::vector<Cell>& cells) {
  std::vector<std::size_t> out;
  for (std::size_t i = 0; i < cells.size(); ++i) {
    const bool begins = i > 0 && (cells[i].dataset != cells[i - 1].dataset ||
                                  cells[i].repeat != cells[i - 1].repeat);
    out.push_back(i == 0 ? 0 : out.back() + static_cast<std::size_t>(begins));
  }
  return out;
}

inline std::string Shard::name() const {
  return std::to_string(number) + "/" + std::to_string(count);
}

inline std::string Shard::folder() const {
  return std::to_string(number) + "-of-" + std::to_string(count);
}

/// "3/8". Throws InputError for any other text.
inline Shard parse_shard(const std::string& text) {
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

/// The cells of a shard, in the order of the sweep. Sequences are dealt out in turn, so that each
/// is loaded by one shard; single cells if there are fewer sequences than shards. O(cells).
inline std::vector<Cell> cells_of(const Shard& shard, const std::vector<Cell>& cells) {
  const std::vector<std::size_t> sequences = sequence_numbers(cells);
  const bool deals_sequences = !cells.empty() && sequences.back() + 1 >= shard.count;
  std::vector<Cell> out;
  for (std::size_t i = 0; i < cells.size(); ++i) {
    const std::size_t turn = deals_sequences ? sequences[i] : i;
    if (turn % shard.count + 1 == shard.number) out.push_back(cells[i]);
  }
  return out;
}

/// Hash of the cells that are divided, equal for shards that belong together.
inline std::string division_hash(const std::vector<Cell>& cells) {
  std::string bytes;
  for (const Cell& cell : cells) bytes += std::to_string(cell.index) + ";";
  return hex(hash_of(bytes)).substr(0, 16);
}

}  // namespace loopbench::harness
