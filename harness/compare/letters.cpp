#include <algorithm>

#include "harness/compare/ranking.hpp"

namespace loopbench::harness {
namespace {

using LetterColumn = std::vector<std::size_t>;  // indices in the ranking, ascending

LetterColumn without(const LetterColumn& column, std::size_t method_index) {
  LetterColumn out = column;
  std::erase(out, method_index);
  return out;
}

/// Adds a column unless another column contains it.
void absorb(std::vector<LetterColumn>& columns, const LetterColumn& added) {
  const auto contains = [&](const LetterColumn& other) {
    return std::ranges::includes(other, added);
  };
  if (std::ranges::none_of(columns, contains)) columns.push_back(added);
}

}  // namespace

std::vector<std::string> letters(const Ranking& ranking) {
  const std::size_t k = ranking.order.size();
  std::vector<LetterColumn> columns(1);
  for (std::size_t method_index = 0; method_index < k; ++method_index)
    columns[0].push_back(method_index);
  std::vector<std::string> out(k);
  for (std::size_t i = 0; i < k; ++i) {
    for (std::size_t j = i + 1; j < k; ++j) {
      const std::size_t a = ranking.order[i];
      const std::size_t b = ranking.order[j];
      if (!ranking.beats[a][b] && !ranking.beats[b][a]) continue;
      std::vector<LetterColumn> kept;
      std::vector<LetterColumn> split;
      for (LetterColumn& column : columns) {
        const bool has_both =
            std::ranges::binary_search(column, i) && std::ranges::binary_search(column, j);
        (has_both ? split : kept).push_back(std::move(column));
      }
      for (const LetterColumn& column : split) {
        absorb(kept, without(column, j));
        absorb(kept, without(column, i));
      }
      columns = std::move(kept);
      if (columns.size() > 100) return out;
    }
  }
  std::ranges::sort(columns);
  for (std::size_t c = 0; c < columns.size(); ++c) {
    std::string letter(1, static_cast<char>('a' + c % 26));
    if (c >= 26) letter += std::to_string(c / 26);
    for (const std::size_t method_index : columns[c]) out[ranking.order[method_index]] += letter;
  }
  return out;
}

}  // namespace loopbench::harness
