#include "harness/article/paper_run.hpp"

#include <cctype>
#include <cmath>

#include "harness/catalogue/load_sequence.hpp"
#include "harness/execution/run/run_cell.hpp"
#include "metrics/trajectory/tracking_gaps.hpp"

namespace loopbench::harness {
namespace {

const std::string kPaperBaseline = "ORB_SLAM2";

/// "first rest of it" into both.
std::pair<std::string, std::string> split_label(const std::string& label) {
  const std::size_t blank = label.find(' ');
  if (blank == std::string::npos) return {label, ""};
  return {label.substr(0, blank), label.substr(blank + 1)};
}

PaperCell named(const Sweep& sweep, const Cell& cell) {
  PaperCell out;
  std::tie(out.sequence, out.input) = split_label(sweep.datasets[cell.dataset].label);
  const std::string& method = sweep.methods[cell.method].label;
  if (method == kPaperBaseline) {
    out.variant = method;
    return out;
  }
  out.reading = method;  // of a row without N or M
  for (std::size_t k = 0; k + 2 < method.size(); ++k) {
    const bool is_window = method[k] == ' ' && (method[k + 1] == 'N' || method[k + 1] == 'M') &&
                           std::isdigit(static_cast<unsigned char>(method[k + 2])) != 0;
    if (!is_window) continue;
    out.reading = method.substr(0, k);
    out.variant = method.substr(k + 1);
    break;
  }
  return out;
}

double roughness(const Trajectory& poses) {
  double sum = 0.0;
  std::size_t count = 0;
  for (std::size_t i = 1; i + 1 < poses.size(); ++i) {
    const double before = poses[i].stamp - poses[i - 1].stamp;
    const double after = poses[i + 1].stamp - poses[i].stamp;
    const Vector3 velocity_before =
        (poses[i].world_from_body.translation - poses[i - 1].world_from_body.translation) / before;
    const Vector3 velocity_after =
        (poses[i + 1].world_from_body.translation - poses[i].world_from_body.translation) / after;
    sum += ((velocity_after - velocity_before) / (0.5 * (before + after))).squaredNorm();
    ++count;
  }
  return count == 0 ? 0.0 : std::sqrt(sum / static_cast<double>(count));
}

}  // namespace

const metrics::Statistics* find_score(const PaperCell& cell,
                                      const std::string& label,
                                      const std::string& axis,
                                      metrics::Times times,
                                      const std::string& relation) {
  for (const ScoreResult& s : cell.result.scores) {
    if (s.status == Status::ok && s.times == times && s.label == label && s.score.axis == axis &&
        s.score.relation == relation) {
      return &s.score.statistics;
    }
  }
  return nullptr;
}

std::vector<PaperCell> run_paper(const Sweep& sweep,
                                 const Catalogue& catalogue,
                                 const DataRoot& root,
                                 const std::function<void(PaperCell&)>& finished) {
  const std::vector<Cell> planned = cells(sweep, seeded(sweep, catalogue), "");
  Sequences sequences(sweep, catalogue, root, planned);
  std::vector<PaperCell> out;
  for (const Cell& cell : planned) out.push_back(named(sweep, cell));
  for (std::size_t i = 0; i < planned.size(); ++i) {
    const auto sequence = sequences.get(planned[i]);
    PaperCell& paper = out[i];
    paper.result = run_cell(planned[i], sweep, *sequence, catalogue);
    if (paper.result.status == Status::ok) {
      methods::Report unused;
      const auto curve =
          make_method(sweep.methods[planned[i].method], catalogue, sequence->reference)
              ->estimate(sequence->problem, unused);
      paper.dense = metrics::evaluate(sequence->reference,
                                      *curve,
                                      stamps(sequence->problem.keyframes),
                                      metrics::Times::dense,
                                      sweep.protocols.front().rules,
                                      metrics::tracked_stamps(sequence->problem));
      paper.keyframes = metrics::moved(paper.dense.alignment, sequence->problem.keyframes);
      paper.roughness = roughness(paper.dense.estimate);
    }
    sequences.done(planned[i]);
    finished(paper);
  }
  return out;
}

std::optional<AxisNumbers> axis_numbers(const PaperCell& cell,
                                        const std::string& axis,
                                        metrics::Times times) {
  const metrics::Statistics* errors = find_score(cell, "axis_error", axis, times);
  const metrics::Statistics* relative = find_score(cell, "rpe", axis, times);
  if (errors == nullptr || relative == nullptr) return std::nullopt;
  return AxisNumbers{errors->max, errors->min, errors->mean, errors->rmse, relative->rmse};
}

std::optional<double> ate_3d(const PaperCell& cell, metrics::Times times) {
  const metrics::Statistics* errors = find_score(cell, "ate", "3d", times);
  if (errors == nullptr) return std::nullopt;
  return errors->rmse;
}

const PaperCell* find_cell(const std::vector<PaperCell>& cells,
                           const PaperCell& like,
                           const std::string& reading,
                           const std::string& variant) {
  for (const PaperCell& cell : cells) {
    const bool reads = variant == kPaperBaseline || cell.reading == reading;
    if (cell.sequence == like.sequence && cell.input == like.input && reads &&
        cell.variant.starts_with(variant)) {
      return &cell;
    }
  }
  return nullptr;
}

}  // namespace loopbench::harness
