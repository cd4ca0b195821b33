#include "harness/commands/loops/loops.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <utility>

#include "datasets/core/error.hpp"
#include "harness/commands/correct/correct.hpp"
#include "harness/sweep/catalogue/catalogue.hpp"
#include "harness/sweep/catalogue/external_methods.hpp"

namespace loopbench::harness {

LoopsResult loops(Problem problem, std::string estimate) {
  if (const std::string why = methods::why_no_ledger(problem); !why.empty()) {
    throw InputError(estimate + ": " + why);
  }
  LoopsResult out{std::move(estimate), std::move(problem), {}};
  try {
    out.ledger = methods::closure_ledger(out.problem);
  } catch (const InputError&) {
    throw;
  } catch (const std::runtime_error& error) {
    throw InputError(out.estimate + ": its closures cannot be checked: " + error.what());
  }
  return out;
}

void add_rejections(LoopsResult& result) {
  const Catalogue known = catalogue({});
  for (const std::string name : {"pose_graph_pcm", "pose_graph_gnc_tls"}) {
    const auto method = make_method(method_without_reference(name, known), known, {});
    if (!methods::reason_to_decline(*method, result.problem).empty()) continue;
    methods::Report report;
    try {
      method->estimate(result.problem, report);
      if (report.rejected) result.rejected[name] = *report.rejected;
    } catch (const std::runtime_error&) {  // a failed method rejects nothing
    }
  }
}

FigureData loops_figure(const LoopsResult& result) {
  const std::string title = std::filesystem::path(result.estimate).filename().string();
  FigureData out{title, "", {{.name = "keyframes"}}, {}, {}};
  add_poses(out.curves[0], result.problem.keyframes, 0.0);
  std::map<std::string, DrawnCurve> kinds{
      // drawn in this order
      {"confirmed",
       {.name = "closures that the others confirm", .style = 2, .dash = 1, .is_thin = true}},
      {"doubtful", {.name = "doubtful closures", .style = 4, .dash = 1, .is_thin = true}},
      {"suspicious", {.name = "most suspicious closures", .style = 3, .dash = 1, .is_thin = true}},
  };
  for (std::size_t rank = 0; rank < result.ledger.suspects.size(); ++rank) {
    DrawnCurve& curve = kinds.at(judgement(result, rank));
    const Edge& edge = result.problem.closures[result.ledger.suspects[rank]];
    for (const std::size_t end : {edge.from, edge.to}) {
      add_position(curve, result.problem.keyframes[end].world_from_body.translation);
    }
    add_position(curve, Vector3::Constant(NAN));  // a gap between two closures
  }
  for (auto& [kind, curve] : kinds) {
    if (!curve.columns.empty()) out.curves.push_back(std::move(curve));
  }
  return out;
}

}  // namespace loopbench::harness
