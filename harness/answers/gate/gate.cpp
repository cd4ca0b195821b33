#include "harness/answers/gate/gate.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>

#include "datasets/core/error.hpp"
#include "datasets/core/fields.hpp"
#include "harness/answers/gate/loss.hpp"

namespace loopbench::harness {
namespace {

/// Severity of a status: complete, low coverage, no number, no result.
int severity(Status status) {
  if (status == Status::ok) return 0;
  if (status == Status::incomplete) return 1;
  return status == Status::declined ? 2 : 3;
}

/// Numbers are compared only if these are equal.
std::string meaning(const ScoreKind& kind) {
  return fmt::format("metric '{}', unit '{}', best value: {}",
                     kind.metric,
                     kind.unit,
                     kind.better == metrics::Better::target ? fmt::format("{}", kind.target)
                                                            : to_text(kind.better));
}

using CellRecords = std::span<const Record>;

std::string name(const CellRecords& cell) { return cell.front().cell->name(); }

/// Which cell it is. Names can be equal: "a / b" of method c, and a of method "b / c".
using CellId = std::tuple<std::string, std::int64_t, std::string>;

CellId id_of(const CellRecords& cell) {
  const CellRow& row = *cell.front().cell;
  return {row.sequence, row.repeat, row.method};
}

/// Which score of a cell it is, likewise.
auto id_of(const ScoreKind& kind) {
  return std::tuple(kind.metric_label(), kind.relation, kind.axis, kind.times, kind.protocol);
}

/// A cell with scores has no failure of its own.
Status status_of(const CellRecords& cell) {
  return cell.front().has_score() ? Status::ok : cell.front().status;
}

/// Larger relative differences of a method whose runs on equal input differ are regressions.
constexpr double kMostUnsteady = 0.05;

bool is_unsteady(const CellRow& cell) {
  return std::ranges::any_of(
      cell.notes, [](const Note& note) { return note.kind == NoteKind::nondeterministic; });
}

class Checker {
 public:
  Checker(const Baseline& baseline, const Snapshot& now, GateExtent extent)
      : extent_(extent), limit_of_(limit_of(baseline.limits)) {
    const std::vector<CellRecords> before = by_cell(baseline.snapshot.records);
    const std::vector<CellRecords> cells = by_cell(now.records);
    for (const CellRecords& cell : cells) now_.emplace(id_of(cell), cell);
    const auto is_there = [&](const CellRecords& cell) { return now_.contains(id_of(cell)); };
    if (std::ranges::none_of(before, is_there)) {
      throw InputError("the baseline is from another sweep: the results contain no cell of '" +
                       baseline.snapshot.sweep + "'");
    }
    for (const CellRecords& cell : before) add(cell);
    merge_failures();
    for (const auto& [method, most] : unsteady_) {
      report_.notes.push_back(
          fmt::format("not deterministic: {}: runs on equal input differ, so that differences of "
                      "up to {:.2g} % from the baseline are no finding",
                      method,
                      100.0 * most));
    }
    for (const CellRecords& cell : cells) {
      if (!now_.contains(id_of(cell))) continue;
      method_ = cell.front().cell->method;
      find(Finding::Kind::added, name(cell), "", "not in the baseline");
    }
    if (unlimited_ > 0) {
      report_.notes.push_back(
          fmt::format("{} {} no limit", unlimited_, unlimited_ == 1 ? "score has" : "scores have"));
    }
    if (implausible_ > 0) {
      report_.notes.push_back(
          fmt::format("implausible: {} {} hardly any error left (at most 1 % of it; first: {}); "
                      "does the method read the reference?",
                      implausible_,
                      implausible_ == 1 ? "number has" : "numbers have",
                      first_implausible_));
    }
  }

  GateReport report() && { return std::move(report_); }

 private:
  void find(Finding::Kind kind,
            const std::string& cell,
            const std::string& score,
            const std::string& what,
            double change = std::numeric_limits<double>::infinity()) {
    report_.findings.push_back({kind, cell, score, what, method_, change});
  }

  /// Whether both have a number.
  bool status(Status before, Status now, const std::string& cell, const std::string& score) {
    if (severity(now) != severity(before)) {
      find(
          severity(now) > severity(before) ? Finding::Kind::regression : Finding::Kind::improvement,
          cell,
          score,
          "was " + to_text(before) + ", is " + to_text(now));
    }
    return has_numbers(before) && has_numbers(now);
  }

  void oracle(const CellRow& before, const CellRow& now) {
    const auto flag = [&](bool was, bool is, const std::string& what) {
      if (was == is) return;
      find(is ? Finding::Kind::regression : Finding::Kind::improvement,
           before.name(),
           "",
           what + (is ? ", was not" : " no longer"));
    };
    flag(before.oracle, now.oracle, "oracle: the method or its data uses the reference");
    flag(before.oracle_closures,
         now.oracle_closures,
         "oracle: closures are measured in the reference");
  }

  void add(const CellRecords& before) {
    const std::string label = name(before);
    const auto found = now_.find(id_of(before));
    if (found == now_.end() && extent_ == GateExtent::part) return;
    ++report_.cells;
    report_.names.push_back(label);
    method_ = before.front().cell->method;
    ++report_.cells_of_method[method_];
    if (found == now_.end()) {
      find(Finding::Kind::regression, label, "", "missing");
      return;
    }
    const CellRecords now = found->second;
    now_.erase(found);
    const std::string& method = now.front().cell->method;
    ++cells_of_[method];
    if (is_failure(status_of(now))) {
      report_.failed[label] = to_text(status_of(now)) + ": " + now.front().why;
      if (!is_failure(status_of(before))) newly_failed_[method].push_back(label);
    }
    oracle(*before.front().cell, *now.front().cell);
    if (!status(status_of(before), status_of(now), label, "")) return;
    std::map<decltype(id_of(ScoreKind())), const Record*> scores;
    for (const Record& score : now) scores.emplace(id_of(*score.kind), &score);
    for (const Record& score : before) {
      if (!score.has_score()) continue;
      const std::string score_name = score.kind->name();
      const auto same = scores.find(id_of(*score.kind));
      if (same == scores.end()) {
        find(Finding::Kind::regression, label, score_name, "missing");
      } else if (status(score.status, same->second->status, label, score_name)) {
        compare(score, *same->second);
      }
    }
  }

  /// One finding for a method that fails on all its cells, instead of one for each.
  void merge_failures() {
    for (const auto& each : newly_failed_) {
      const std::vector<std::string>& labels = each.second;
      if (labels.size() < 2 || labels.size() < cells_of_[each.first]) continue;
      const std::string what = fmt::format("fails on all {} cells; {}: {}",
                                           labels.size(),
                                           labels.front(),
                                           report_.failed[labels.front()]);
      const auto is_own = [&](const Finding& f) {
        return f.score.empty() && std::ranges::count(labels, f.cell) > 0;
      };
      *std::ranges::find_if(report_.findings, is_own) = {
          Finding::Kind::regression, each.first, "", what, each.first};
      std::erase_if(report_.findings, is_own);
    }
  }

  void compare(const Record& before, const Record& now) {
    const Tolerance* const limit = limit_of_(before);
    is_unsteady_ = is_unsteady(*now.cell);
    ++(limit == nullptr ? unlimited_ : report_.scores);
    const auto regression = [&](const std::string& what) {
      find(Finding::Kind::regression, before.cell->name(), before.kind->name(), what);
    };
    if (meaning(*now.kind) != meaning(*before.kind)) {
      regression(meaning(*now.kind) + "; was " + meaning(*before.kind));
      return;
    }
    if (now.pairs < before.pairs || now.pairs * before.possible < before.pairs * now.possible) {
      regression(fmt::format("evaluated {} of {} possible pose pairs, was {} of {}",
                             now.pairs,
                             now.possible,
                             before.pairs,
                             before.possible));
    }
    if (limit == nullptr) return;
    const std::size_t count = now.statistics.count;
    const auto count_before = static_cast<double>(before.statistics.count);
    if (static_cast<double>(count) < count_before * (1.0 - limit->relative)) {
      regression(fmt::format("statistics over {} errors, was {}", count, before.statistics.count));
    }
    for (const std::string& statistic : limit->values) {
      measure(before, statistic, *limit, value(now, statistic));
    }
  }

  void measure(const Record& score,
               const std::string& statistic,
               const Tolerance& limit,
               double now) {
    const double before = value(score, statistic);
    const double allowed = limit.absolute + limit.relative * std::abs(before);
    const double worse = loss(*score.kind, before, now);
    if (std::abs(worse) <= allowed) return;  // NaN exceeds every limit
    const double share = std::abs(worse) / std::abs(before);
    if (share <= kMostUnsteady && is_unsteady_ && !is_measured_time(score)) {
      double& most = unsteady_[score.cell->method];
      most = std::max(most, share);
      return;
    }
    if (has_vanished(score, before, now) && ++implausible_ == 1) {
      first_implausible_ = score.cell->name() + ", " + score.kind->name();
    }
    find(worse < 0.0 ? Finding::Kind::improvement : Finding::Kind::regression,
         score.cell->name(),
         score.kind->name(),
         fmt::format("{} {:.9g} {}, was {:.9g} ({:+.3g} %, limit {:.3g})",
                     statistic,
                     now,
                     score.kind->unit,
                     before,
                     before == 0.0 ? 0.0 : 100.0 * (now / before - 1.0),
                     allowed),
         std::isnan(share) ? std::numeric_limits<double>::infinity() : share);
  }

  GateExtent extent_;
  std::function<const Tolerance*(const Record&)> limit_of_;
  std::size_t implausible_ = 0;  // errors that nearly vanished
  std::string first_implausible_;
  std::map<std::string, std::size_t> cells_of_;                   // by method
  std::map<std::string, std::vector<std::string>> newly_failed_;  // cells by method
  std::map<std::string, double> unsteady_;                        // largest difference, by method
  bool is_unsteady_ = false;                                      // the present cell
  std::string method_;                                            // likewise
  std::size_t unlimited_ = 0;                                     // scores without a limit
  std::map<CellId, CellRecords> now_;  // cells that the baseline did not have so far
  GateReport report_;
};

}  // namespace

std::size_t GateReport::count(Finding::Kind kind) const {
  return static_cast<std::size_t>(std::ranges::count(findings, kind, &Finding::kind));
}

GateReport check(const Baseline& baseline, const Snapshot& now, GateExtent extent) {
  require_used_limits(baseline);
  const std::string contents = require_same_definitions(baseline.snapshot, now);
  GateReport out = Checker(baseline, now, extent).report();
  for (std::string& note : notes_on_limits(baseline.limits)) out.notes.push_back(std::move(note));
  if (!contents.empty()) out.notes.push_back(contents);
  return out;
}

}  // namespace loopbench::harness
