#include "harness/gate/check.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <tuple>

#include "datasets/core/error.hpp"
#include "harness/export/where.hpp"
#include "harness/gate/consistent_loss.hpp"

namespace loopbench {
namespace {

/// What one of two texts of options, `name: a=1, b=2; file bytes hash`, has and the other has not.
std::string only_in(const std::string& text, const std::string& other) {
  const auto parts = [](const std::string& whole) {
    std::vector<std::string> out{""};
    for (const char c : whole) {
      if (c == ',' || c == ';') {
        out.emplace_back();
      } else if (c != ' ' || !out.back().empty()) {
        out.back() += c;
      }
    }
    return out;
  };
  const std::vector<std::string> others = parts(other);
  std::string out;
  for (const std::string& part : parts(text)) {
    if (std::ranges::count(others, part) > 0) continue;
    out += (out.empty() ? "" : ", ") + part;
  }
  return out;
}

void refuse_others(const std::map<std::string, std::string>& baseline,
                   const std::map<std::string, std::string>& now,
                   const std::string& what,
                   bool may_be_missing) {
  for (const auto& [label, text] : baseline) {
    const auto found = now.find(label);
    if (found == now.end()) {
      if (may_be_missing) continue;
      throw InputError("the baseline has the " + what + " '" + label + "', these results do not");
    }
    if (found->second == text) continue;
    throw InputError("the baseline is of another " + what + " '" + label + "': it has '" +
                     only_in(text, found->second) + "', these results have '" +
                     only_in(found->second, text) + "'");
  }
}

bool is_failure(const std::string& status) {
  return status != "ok" && status != "declined" && status != "incomplete";
}

/// 1: worse, -1: better, 0: neither.
int status_move(const std::string& before, const std::string& now) {
  if (before == now) return 0;
  if (now == "ok" || (is_failure(before) && !is_failure(now))) return -1;
  return before == "ok" || is_failure(now) ? 1 : 0;
}

class Checker {
 public:
  Checker(const Baseline& baseline, const Snapshot& now, GateExtent extent)
      : baseline_(baseline), extent_(extent) {
    for (const Tolerance& limit : baseline.limits) keeps_.push_back(where(limit.where));
    for (const GateCell& cell : now.cells) now_.emplace(key(cell), &cell);
    const auto is_there = [&](const GateCell& cell) { return now_.contains(key(cell)); };
    if (std::ranges::none_of(baseline.snapshot.cells, is_there)) {
      throw InputError("the baseline is of another sweep: no cell of '" + baseline.snapshot.sweep +
                       "' is among these results");
    }
    for (const GateCell& cell : baseline.snapshot.cells) add(cell);
    for (const GateCell& cell : now.cells) {
      if (!seen_.contains(key(cell))) {
        find(Finding::Kind::added, name(cell), "", "is not in the baseline");
      }
    }
    for (const Finding& finding : losses_.findings()) report_.findings.push_back(finding);
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

  bool status(const std::string& before,
              const std::string& now,
              const std::string& cell,
              const std::string& score) {
    const int move = status_move(before, now);
    if (move != 0) {
      find(move > 0 ? Finding::Kind::regression : Finding::Kind::improvement,
           cell,
           score,
           "was " + before + ", is " + now);
    }
    return before == "ok" && now == "ok";
  }

  void add(const GateCell& before) {
    const auto found = now_.find(key(before));
    if (found == now_.end() && extent_ == GateExtent::part) return;
    ++report_.cells;
    report_.names.push_back(name(before));
    seen_.emplace(key(before), true);
    if (found == now_.end()) {
      find(Finding::Kind::regression, name(before), "", "vanished");
      return;
    }
    const GateCell& now = *found->second;
    if (!status(before.status, now.status, name(before), "")) return;
    std::map<std::string, const GateScore*> scores;
    for (const GateScore& score : now.scores) scores.emplace(name(score), &score);
    for (const GateScore& score : before.scores) {
      const auto same = scores.find(name(score));
      if (same == scores.end()) {
        find(Finding::Kind::regression, name(before), name(score), "vanished");
      } else if (status(score.status, same->second->status, name(before), name(score))) {
        compare(before, score, *same->second);
      }
    }
  }

  void compare(const GateCell& cell, const GateScore& before, const GateScore& now) {
    ++report_.scores;
    const Record record = as_record(cell, before);
    if (now.pairs < before.pairs) {
      find(Finding::Kind::regression,
           name(cell),
           name(before),
           fmt::format("judged {} pose pairs, was {}", now.pairs, before.pairs));
    }
    for (std::size_t i = 0; i < keeps_.size(); ++i) {
      if (!keeps_[i](record)) continue;
      const Tolerance& limit = baseline_.limits[i];
      const auto old_value = before.values.find(limit.value);
      const auto new_value = now.values.find(limit.value);
      if (old_value == before.values.end() || new_value == now.values.end()) return;
      measure(cell, before, limit, now.better, old_value->second, new_value->second);
      return;
    }
  }

  void measure(const GateCell& cell,
               const GateScore& score,
               const Tolerance& limit,
               Better way,
               double before,
               double now) {
    const double allowed = limit.absolute + limit.relative * std::abs(before);
    const double worse = way == Better::higher  ? before - now
                         : way == Better::lower ? now - before
                                                : std::abs(now - before);
    losses_.add(cell.method, name(score), limit, way, before, now);
    if (std::abs(worse) <= allowed) return;  // also refuses NaN below: not <=
    find(worse < 0.0 ? Finding::Kind::improvement : Finding::Kind::regression,
         name(cell),
         name(score),
         fmt::format("{} {:.9g} {}, was {:.9g} ({:+.3g} %, may move {:.3g})",
                     limit.value,
                     now,
                     score.unit,
                     before,
                     before == 0.0 ? 0.0 : 100.0 * (now / before - 1.0),
                     allowed));
  }

  const Baseline& baseline_;
  GateExtent extent_;
  std::vector<std::function<bool(const Record&)>> keeps_;
  std::map<CellKey, const GateCell*> now_;
  std::map<CellKey, bool> seen_;
  ConsistentLosses losses_;
  GateReport report_;
};

}  // namespace

std::size_t GateReport::count(Finding::Kind kind) const {
  return static_cast<std::size_t>(std::ranges::count(findings, kind, &Finding::kind));
}

GateReport check(const Baseline& baseline, const Snapshot& now, GateExtent extent) {
  refuse_others(baseline.snapshot.sequences, now.sequences, "sequence", true);
  refuse_others(baseline.snapshot.protocols, now.protocols, "protocol", false);
  return Checker(baseline, now, extent).report();
}

}  // namespace loopbench
