/// Reading and checking of what workers send.
#pragma once

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string_view>

#include "harness/execution/isolate/pack_result.hpp"
#include "harness/model/sweep.hpp"

namespace loopbench::harness {

/// False if the bytes are not a T.
template <class T>
bool unpack_answer(std::string_view bytes, T& out) {
  try {
    Unpacker unpack(bytes);
    unpack(out);
    return true;
  } catch (const std::runtime_error&) {
    return false;
  }
}

/// Whether a result can be used: a cell that wrote over its memory can send anything.
inline bool is_valid(const CellResult& result, const Sweep& sweep) {
  const auto is_choice = [](auto value) {
    return std::ranges::any_of(choices(value), [&](const auto& c) { return c.second == value; });
  };
  return is_choice(result.status) && is_choice(result.trace.times) &&
         std::ranges::all_of(result.scores, [&](const ScoreResult& score) {
           return score.protocol < sweep.protocols.size() && is_choice(score.times) &&
                  is_choice(score.status) && is_choice(score.score.better) &&
                  std::isfinite(score.score.target);
         });
}

}  // namespace loopbench::harness
