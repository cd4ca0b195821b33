/// Large files are read in parts, a thread each; what comes out is as if it were read by one.
#pragma once

#include <algorithm>
#include <utility>
#include <vector>

#include "datasets/core/parallel.hpp"
#include "datasets/formats/text_file.hpp"

namespace loopbench {

/// parse(TextFile&) of each part of `file`, in order. Whatever one part alone cannot judge (an
/// error, whose line number needs the parts before; neighbours a, b for which fits(a, b) is false)
/// is left to parse(file): then there is one part, or the error that a single thread finds.
template <class Parse, class Fits>
auto read_in_parts(TextFile& file, const Parse& parse, const Fits& fits) {
  using Part = decltype(parse(file));
  constexpr std::size_t kSmallest = std::size_t{1} << 20;  // [bytes]
  std::vector<Part> parts;
  if (file.bytes() >= 2 * kSmallest && cores() > 1) {
    try {
      std::vector<TextFile> texts = file.cut(std::min(cores(), file.bytes() / kSmallest));
      parts.resize(texts.size());
      in_parallel(texts.size(), [&](std::size_t i) { parts[i] = parse(texts[i]); });
      bool all_fit = true;
      for (std::size_t i = 1; i < parts.size(); ++i) all_fit &= fits(parts[i - 1], parts[i]);
      if (all_fit) {
        for (const TextFile& text : texts) {
          file.mended.off_unit = std::max(file.mended.off_unit, text.mended.off_unit);
          file.mended.repeated += text.mended.repeated;
        }
        return parts;
      }
    } catch (const InputError&) {
      // said again below, with the right line
    }
  }
  parts.clear();
  parts.push_back(parse(file));
  return parts;
}

/// At the end of `list`, which should have reserved room for it.
template <class T>
void append(std::vector<T>& list, std::vector<T> more) {
  list.insert(list.end(), more.begin(), more.end());
}

/// The parts as one list, in order.
template <class T>
std::vector<T> joined(std::vector<std::vector<T>> parts) {
  std::vector<T> out = std::move(parts.front());
  for (std::size_t i = 1; i < parts.size(); ++i) append(out, std::move(parts[i]));
  return out;
}

}  // namespace loopbench
