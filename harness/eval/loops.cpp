#include "harness/eval/loops.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <utility>

#include "datasets/core/error.hpp"
#include "harness/catalogue/catalogue.hpp"
#include "harness/catalogue/external_methods.hpp"
#include "harness/eval/correct.hpp"

namespace loopbench::harness {
namespace {

/// 0: the others confirm the closure, 1: doubtful, 2: one of the most suspicious. A false closure
/// makes true ones contradict the others, but not the odometry.
std::size_t suspicion(const LoopsResult& result, std::size_t closure, std::size_t rank) {
  constexpr double kConfirmed = 3.0, kContradiction = 10.0;  // chi2 per degree of freedom
  const methods::LedgerRow& row = result.ledger.rows[closure];
  const double without = row.cost_drop / (result.problem.planar ? 3.0 : 6.0);
  const double chi2 = std::max(row.predicted ? row.predicted->chi2 : 0.0, without);
  const bool is_contradicted = methods::is_contradicted(result.ledger.verdict);
  const bool is_far = std::min(chi2, row.in_odometry.chi2) > kContradiction;
  if (is_contradicted && (rank < 2 || is_far)) return 2;
  return row.predicted && chi2 <= kConfirmed ? 0 : 1;
}

}  // namespace

LoopsResult loops(Problem problem, std::string estimate) {
  if (const std::string why = methods::why_no_ledger(problem); !why.empty()) {
    throw InputError(estimate + ": " + why);
  }
  LoopsResult out{std::move(estimate), std::move(problem), {}};
  out.ledger = methods::closure_ledger(out.problem);
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
  thin(out.curves[0]);
  std::vector<DrawnCurve> kinds{
      {.name = "closures that the others confirm", .style = 2, .dash = 1},
      {.name = "doubtful closures", .style = 4, .dash = 1},
      {.name = "most suspicious closures", .style = 3, .dash = 1},
  };
  for (std::size_t rank = 0; rank < result.ledger.suspects.size(); ++rank) {
    const std::size_t k = result.ledger.suspects[rank];
    DrawnCurve& curve = kinds[suspicion(result, k, rank)];
    const Edge& edge = result.problem.closures[k];
    for (const std::size_t end : {edge.from, edge.to}) {
      add_position(curve, result.problem.keyframes[end].world_from_body.translation);
    }
    add_position(curve, Vector3::Constant(NAN));  // a gap between two closures
  }
  for (DrawnCurve& curve : kinds) {
    if (!curve.columns.empty()) out.curves.push_back(std::move(curve));
  }
  return out;
}

}  // namespace loopbench::harness
