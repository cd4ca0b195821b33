#include <fmt/format.h>

#include "harness/eval/evaluation_text_parts.hpp"
#include "harness/text/wrap.hpp"

namespace loopbench::harness {
namespace {

/// `text` beside `name`, in lines that fit.
std::string property(const std::string& name, const std::string& text, std::size_t columns) {
  constexpr std::size_t kMargin = 11;
  std::string out = padded(name, kMargin, true);
  std::size_t count = 0;
  for (const std::string& line : wrapped(text, columns - kMargin)) {
    out += (count++ == 0 ? "" : std::string(kMargin, ' ')) + line + "\n";
  }
  return out;
}

std::string path_text(const std::string& path, std::size_t poses, std::size_t columns) {
  const std::string count = fmt::format(" ({} poses)", poses);
  return shortened(path, columns - 11 - count.size()) + count;
}

std::string diagnosis(const std::vector<metrics::Score>& scores) {
  std::string out;
  for (const metrics::Score& score : scores) {
    out += fmt::format("{}{} {:.4g}{}",
                       out.empty() ? "" : ", ",
                       score.relation,
                       score.statistics.mean,
                       score.unit == "1" ? "" : " " + score.unit);
  }
  return out;
}

/// "rpe 1 s x [m]".
std::string score_name(const EvaluatedMetric& metric, const metrics::Score& score) {
  const bool is_usual = score.relation == "translation" || score.relation == "rotation";
  const bool is_total = score.axis.empty() || score.axis == "3d" || score.axis == "all";
  return label(metric) + (is_usual ? "" : " " + score.relation) +
         (is_total ? "" : " " + score.axis) + " [" + score.unit + "]";
}

TableView scores_view(const EvaluationResult& result) {
  TableView out{"", {"score", "rmse", "mean", "median", "std", "min", "max", "count"}, {}, {}};
  for (const EvaluatedMetric& metric : result.metrics) {
    for (const metrics::Score& score : metric.scores) {
      if (!score.why_undefined.empty()) continue;
      const metrics::Statistics& s = score.statistics;
      std::vector<TableViewEntry>& line = out.lines.emplace_back();
      line.push_back({score_name(metric, score)});
      for (const double value : {s.rmse, s.mean, s.median, s.std, s.min, s.max}) {
        line.push_back({fixed(value, decimals(s.rmse))});
      }
      line.push_back({std::to_string(s.count)});
    }
  }
  out.notes = grouped(missing_scores(result, ""));
  return out;
}

}  // namespace

std::string terminal(const EvaluationResult& result, const TerminalStyle& style) {
  const std::size_t columns = std::max<std::size_t>(40, style.width);
  const auto line = [&](const char* name, const std::string& text) {
    return text.empty() ? "" : property(name, text, columns);
  };
  std::string out =
      line("reference", path_text(result.reference, result.reference_poses, columns)) +
      line("body", result.reference_body) +
      line("estimate", path_text(result.estimate, result.estimate_poses, columns)) +
      line("protocol", protocol_text(result.protocol)) +
      line("pairs",
           fmt::format("{} of {} ({:.1f} %), over {:.1f} % of the reference's time",
                       result.coverage.pairs,
                       result.coverage.possible,
                       100.0 * result.coverage.share(),
                       100.0 * result.coverage.span)) +
      line("incomplete", result.incomplete_reason) +
      line(
          "alignment",
          fmt::format("{}, scale {:.6g}", to_text(result.alignment.type), result.alignment.scale)) +
      line("diagnosis", diagnosis(result.diagnosis)) +
      line("other body", result.other_body.empty() ? "" : result.other_body + "; see --ref-body");
  for (const std::string& note : result.notes) out += line("note", note);
  return out + "\n" + terminal(scores_view(result), style);
}

}  // namespace loopbench::harness
