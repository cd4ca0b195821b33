#include "harness/compare/gate.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <tuple>

#include "datasets/core/error.hpp"
#include "datasets/core/fields.hpp"
#include "harness/compare/gate_limits.hpp"
#include "harness/compare/snapshot.hpp"

namespace loopbench::harness {
namespace {

/// Severity of a status: complete, low coverage, no number, no result.
int severity(Status status) {
  if (status == Status::ok) return 0;
  if (status == Status::incomplete) return 1;
  return status == Status::declined ? 2 : 3;
}

/// Positive: worse.
double loss(const GateScore& score, double before, double now) {
  switch (score.better) {
    case metrics::Better::lower:
      return now - before;
    case metrics::Better::higher:
      return before - now;
    case metrics::Better::target:
      return std::abs(now - score.target) - std::abs(before - score.target);
    case metrics::Better::neither:
      return std::abs(now - before);
  }
  return 0.0;
}

/// Whether at most a hundredth of an error is left. Times can shrink that much.
bool has_vanished(const GateScore& score, double before, double now) {
  if (is_measured_time(score)) return false;
  if (score.better != metrics::Better::lower && score.better != metrics::Better::target)
    return false;
  const double best = score.better == metrics::Better::target ? score.target : 0.0;
  return std::abs(now - best) <= 0.01 * std::abs(before - best);
}

/// Reason why the two numbers cannot be compared, or empty.
std::string why_not_comparable(const GateScore& before, const GateScore& now) {
  if (now.metric != before.metric) {
    return fmt::format("metric '{}', was '{}'", now.metric.text(), before.metric.text());
  }
  if (now.unit != before.unit)
    return fmt::format("unit '{}', was '{}'", now.unit.text(), before.unit.text());
  if (now.better == before.better && now.target == before.target) return "";
  const auto direction = [](const GateScore& score) {
    return score.better == metrics::Better::target ? fmt::format("target {}", score.target)
                                                   : to_text(score.better);
  };
  return fmt::format("best value: {}, was: {}", direction(now), direction(before));
}

class Checker {
 public:
  Checker(const Baseline& baseline, const Snapshot& now, GateExtent extent)
      : extent_(extent), limit_of_(limit_of(baseline.limits)) {
    for (const GateCell& cell : now.cells) now_.emplace(key(cell), &cell);
    const auto is_there = [&](const GateCell& cell) { return now_.contains(key(cell)); };
    if (std::ranges::none_of(baseline.snapshot.cells, is_there)) {
      throw InputError("the baseline is from another sweep: the results contain no cell of '" +
                       baseline.snapshot.sweep + "'");
    }
    for (const GateCell& cell : baseline.snapshot.cells) add(cell);
    for (const GateCell& cell : now.cells) {
      if (now_.contains(key(cell)))
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
  using CellKey = std::tuple<std::string, std::int64_t, std::string>;
  static CellKey key(const GateCell& cell) { return {cell.sequence, cell.repeat, cell.method}; }

  void find(Finding::Kind kind,
            const std::string& cell,
            const std::string& score,
            const std::string& what) {
    report_.findings.push_back({kind, cell, score, what});
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

  void oracle(const GateCell& before, const GateCell& now) {
    const auto flag = [&](bool was, bool is, const std::string& what) {
      if (was == is) return;
      find(is ? Finding::Kind::regression : Finding::Kind::improvement,
           name(before),
           "",
           what + (is ? ", was not" : " no longer"));
    };
    flag(before.oracle, now.oracle, "oracle: the method or its data uses the reference");
    flag(before.oracle_closures,
         now.oracle_closures,
         "oracle: closures are measured in the reference");
  }

  void add(const GateCell& before) {
    const auto found = now_.find(key(before));
    if (found == now_.end() && extent_ == GateExtent::part) return;
    ++report_.cells;
    report_.names.push_back(name(before));
    if (found == now_.end()) {
      find(Finding::Kind::regression, name(before), "", "missing");
      return;
    }
    const GateCell& now = *found->second;
    now_.erase(found);
    oracle(before, now);
    if (!status(before.status, now.status, name(before), "")) return;
    std::map<std::string, const GateScore*> scores;
    for (const GateScore& score : now.scores) scores.emplace(name(score), &score);
    for (const GateScore& score : before.scores) {
      const auto same = scores.find(name(score));
      if (same == scores.end()) {
        find(Finding::Kind::regression, name(before), name(score), "missing");
      } else if (status(score.status, same->second->status, name(before), name(score))) {
        compare(now, score, *same->second);
      }
    }
  }

  void compare(const GateCell& cell, const GateScore& before, const GateScore& now) {
    const Tolerance* const limit = limit_of_(before);
    ++(limit == nullptr ? unlimited_ : report_.scores);
    const auto regression = [&](const std::string& what) {
      find(Finding::Kind::regression, name(cell), name(before), what);
    };
    if (const std::string other = why_not_comparable(before, now); !other.empty()) {
      regression(other);
      return;
    }
    if (now.pairs < before.pairs) {
      regression(fmt::format("evaluated {} pose pairs, was {}", now.pairs, before.pairs));
    } else if (now.pairs * before.possible < before.pairs * now.possible) {
      regression(fmt::format("evaluated {} of {} possible pose pairs, was {} of {}",
                             now.pairs,
                             now.possible,
                             before.pairs,
                             before.possible));
    }
    if (limit == nullptr) return;
    const double fewest = static_cast<double>(before.count) * (1.0 - limit->relative);
    if (static_cast<double>(now.count) < fewest) {
      regression(fmt::format("statistics over {} errors, was {}", now.count, before.count));
    }
    for (const std::string& statistic : limit->values) {
      const auto old_value = before.values.find(statistic);
      const auto new_value = now.values.find(statistic);
      if (old_value == before.values.end() || new_value == now.values.end()) continue;
      measure(cell, before, statistic, *limit, old_value->second, new_value->second);
    }
  }

  void measure(const GateCell& cell,
               const GateScore& score,
               const std::string& statistic,
               const Tolerance& limit,
               double before,
               double now) {
    const double allowed = limit.absolute + limit.relative * std::abs(before);
    const double worse = loss(score, before, now);
    if (std::abs(worse) <= allowed) return;  // NaN exceeds every limit
    if (has_vanished(score, before, now) && ++implausible_ == 1) {
      first_implausible_ = name(cell) + ", " + name(score);
    }
    find(worse < 0.0 ? Finding::Kind::improvement : Finding::Kind::regression,
         name(cell),
         name(score),
         fmt::format("{} {:.9g} {}, was {:.9g} ({:+.3g} %, limit {:.3g})",
                     statistic,
                     now,
                     score.unit.text(),
                     before,
                     before == 0.0 ? 0.0 : 100.0 * (now / before - 1.0),
                     allowed));
  }

  GateExtent extent_;
  std::function<const Tolerance*(const Record&)> limit_of_;
  std::size_t implausible_ = 0;  // errors that nearly vanished
  std::string first_implausible_;
  std::size_t unlimited_ = 0;               // scores without a limit
  std::map<CellKey, const GateCell*> now_;  // that the baseline did not have so far
  GateReport report_;
};

}  // namespace

std::size_t GateReport::count(Finding::Kind kind) const {
  return static_cast<std::size_t>(std::ranges::count(findings, kind, &Finding::kind));
}

GateReport check(const Baseline& baseline, const Snapshot& now, GateExtent extent) {
  require_used_limits(baseline);
  require_same_definitions(baseline.snapshot, now);
  GateReport out = Checker(baseline, now, extent).report();
  for (std::string& note : notes_on_limits(baseline.limits)) out.notes.push_back(std::move(note));
  const std::string contents = note_on_contents(baseline.snapshot, now);
  if (!contents.empty()) out.notes.push_back(contents);
  return out;
}

}  // namespace loopbench::harness
