/// Parallel parsing of large files. The result is the same as with a single thread.
#pragma once

#include <algorithm>
#include <utility>
#include <vector>

#include "datasets/columns/text_file.hpp"
#include "datasets/core/parallel.hpp"

namespace loopbench {

/// Splits `file` into parts and returns the results of parse(TextFile&) for each, in order. Falls
/// back to a single parse(file) if a part throws InputError (its line numbers would be relative to
/// the part) or if fits(a, b) is false for two neighbouring results.
template <class Parse, class Fits>
auto read_parallel(TextFile& file, const Parse& parse, const Fits& fits) {
  using Part = decltype(parse(file));
  constexpr std::size_t kMinPartSize = std::size_t{1} << 20;  // [bytes]
  std::vector<Part> parts;
  if (file.bytes() >= 2 * kMinPartSize && hardware_threads() > 1) {
    try {
      std::vector<TextFile> texts =
          file.cut(std::min(hardware_threads(), file.bytes() / kMinPartSize));
      parts.resize(texts.size());
      parallel_invoke(texts.size(), [&](std::size_t i) { parts[i] = parse(texts[i]); });
      bool all_fit = true;
      for (std::size_t i = 1; i < parts.size(); ++i) all_fit &= fits(parts[i - 1], parts[i]);
      if (all_fit) {
        for (const TextFile& text : texts) {
          file.repaired.append(text.repaired);
        }
        return parts;
      }
    } catch (const InputError&) {
      // Thrown again below, with the line number in the complete file.
    }
  }
  parts.clear();
  parts.push_back(parse(file));
  return parts;
}

/// Appends `more` to `list`, which should have reserved capacity.
template <class T>
void append(std::vector<T>& list, std::vector<T> more) {
  list.insert(list.end(), more.begin(), more.end());
}

/// Concatenates the parts in order.
template <class T>
std::vector<T> joined(std::vector<std::vector<T>> parts) {
  std::vector<T> out = std::move(parts.front());
  for (std::size_t i = 1; i < parts.size(); ++i) append(out, std::move(parts[i]));
  return out;
}

}  // namespace loopbench
