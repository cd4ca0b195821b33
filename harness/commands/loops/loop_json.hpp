/// What commands about closures have in common in JSON. Numbers that are not finite become null.
#pragma once

#include <nlohmann/json.hpp>
#include <vector>

#include "datasets/core/problem.hpp"
#include "harness/sweep/model/loops.hpp"
#include "methods/correctors/consensus/judgement.hpp"

namespace loopbench::harness {

/// The id of a keyframe (text of a symbol: "a12"), or its stamp.
inline nlohmann::ordered_json keyframe_json(const Problem& problem, std::size_t keyframe) {
  if (!problem.ids.empty()) {
    const std::int64_t id = problem.ids[keyframe];
    if (is_symbol(id)) return id_text(id);
    return id;
  }
  return shown_stamp(problem.keyframes[keyframe].stamp);
}

/// [{from, to, metres, degrees, inflation (null: unbounded)}].
inline nlohmann::ordered_json steps_json(const Problem& problem,
                                         const std::vector<methods::FreedStep>& steps) {
  nlohmann::ordered_json out = nlohmann::ordered_json::array();
  for (const methods::FreedStep& step : steps) {
    out.push_back({{"from", keyframe_json(problem, step.from)},
                   {"to", keyframe_json(problem, step.from + 1)},
                   {"metres", step.metres},
                   {"degrees", step.degrees},
                   {"inflation", step.inflation}});
  }
  return out;
}

}  // namespace loopbench::harness
