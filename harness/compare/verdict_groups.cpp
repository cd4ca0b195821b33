#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "harness/compare/verdict.hpp"

namespace loopbench::harness {
namespace {

using Names = std::vector<std::string>;
using Changes = std::vector<std::optional<double>>;  // over all, then by sequence [%]

double change_of_ratio(double ratio) { return 100.0 * (ratio - 1.0); }

Changes changes_of(const MethodVerdict& m, const Names& sequences) {
  Changes out(1 + sequences.size());
  if (!m.ratio) return out;
  if (!m.is_divided && !m.is_contradicted) out[0] = change_of_ratio(m.ratio->typical.estimate);
  for (const SequenceRatio& one : m.ratio->by_sequence) {
    const auto found = std::ranges::find(sequences, one.sequence);
    if (found == sequences.end()) continue;
    out[1 + static_cast<std::size_t>(found - sequences.begin())] = change_of_ratio(one.ratio);
  }
  return out;
}

bool are_near(const Changes& a, const Changes& b, double points) {
  for (std::size_t i = 0; i < a.size(); ++i) {
    if (a[i].has_value() != b[i].has_value()) return false;
    if (a[i] && std::abs(*a[i] - *b[i]) > points) return false;
  }
  return true;
}

/// Of the members that have a value.
std::optional<Change> range_of(const std::vector<Changes>& members, std::size_t column) {
  std::optional<Change> out;
  for (const Changes& m : members) {
    if (!m[column]) continue;
    out = out ? Change{std::min(out->low, *m[column]), std::max(out->high, *m[column])}
              : Change{*m[column], *m[column]};
  }
  return out;
}

std::optional<Change> interval_of(const std::vector<const MethodVerdict*>& members) {
  std::optional<Change> out;
  for (const MethodVerdict* m : members) {
    if (m->is_divided || m->is_contradicted) continue;
    if (!m->ratio || !m->ratio->has_interval) return std::nullopt;
    const Change own{change_of_ratio(m->ratio->typical.low),
                     change_of_ratio(m->ratio->typical.high)};
    out = out ? Change{std::min(out->low, own.low), std::max(out->high, own.high)} : own;
  }
  return out;
}

/// Neighbours that differ by at most `points` from all of their group.
std::vector<VerdictGroup> groups_within(const Comparison& c,
                                        const Names& sequences,
                                        double points) {
  std::vector<std::vector<const MethodVerdict*>> groups;
  for (const MethodVerdict& m : c.methods) {
    if (m.is_worse && m.method == c.options.baseline) continue;
    const auto joins = [&](const MethodVerdict* other) {
      return other->is_worse == m.is_worse &&
             (!m.is_worse ||
              are_near(changes_of(*other, sequences), changes_of(m, sequences), points));
    };
    if (groups.empty() || !std::ranges::all_of(groups.back(), joins)) groups.emplace_back();
    groups.back().push_back(&m);
  }
  std::vector<VerdictGroup> out;
  for (const auto& members : groups)
    out.push_back(group_of(members, sequences, c.options.baseline));
  return out;
}

/// A method that is significantly worse than the baseline.
struct Caution {
  double log_ratio = 0.0;
  std::string text;
};

bool is_worse_ratio(double ratio, const Comparison& c) {
  const double loss = c.kind.better == metrics::Better::higher ? -std::log(ratio) : std::log(ratio);
  return loss > std::log1p(c.options.relevant);
}

std::string percent_of_ratio(double ratio) {
  return percent_text(std::abs(change_of_ratio(ratio))) + " %";
}

/// ", dm_robust 66 % better": the method that is best there, if that is significant.
std::string best_there(const Comparison& c, const std::string& sequence) {
  const MethodVerdict* best = nullptr;
  double least = 1.0;
  for (const MethodVerdict& m : c.methods) {
    if (!m.ratio) continue;
    for (const SequenceRatio& one : m.ratio->by_sequence) {
      if (one.sequence != sequence || !one.is_clear) continue;
      const double ratio = c.kind.better == metrics::Better::higher ? 1.0 / one.ratio : one.ratio;
      if (ratio < least) best = &m;
      least = std::min(least, ratio);
    }
  }
  return best == nullptr ? "" : ", " + best->method + " " + percent_of_ratio(least) + " better";
}

/// At most one for each method: the worst sequence.
void add_cautions(std::vector<Caution>& out, const Comparison& c, const std::string& axis) {
  for (const MethodVerdict& m : c.methods) {
    if (!m.ratio) continue;
    const SequenceRatio* worst = nullptr;
    std::size_t sequences = 0;
    for (const SequenceRatio& one : m.ratio->by_sequence) {
      if (!one.is_clear || !is_worse_ratio(one.ratio, c)) continue;
      ++sequences;
      if (!worst || is_worse_ratio(one.ratio / worst->ratio, c)) worst = &one;
    }
    const double ratio = worst != nullptr ? worst->ratio : m.ratio->typical.estimate;
    // That a method is worse over all is in the table of groups, but not for the rotation.
    if (!worst && (axis.empty() || !m.is_beaten)) continue;
    std::string text =
        axis + m.method + " is " + percent_of_ratio(ratio) + " worse than " + c.options.baseline;
    if (worst != nullptr) text += " on " + worst->sequence + best_there(c, worst->sequence);
    if (sequences > 1) text += fmt::format("; worse on {} sequences", sequences);
    out.push_back({std::abs(std::log(ratio)), text});
  }
}

}  // namespace

VerdictGroup group_of(std::vector<const MethodVerdict*> members,
                      const Names& sequences,
                      const std::string& baseline) {
  VerdictGroup out;
  out.is_first = !members.front()->is_worse;
  for (const MethodVerdict* m : members) out.methods.push_back(m->method);
  out.name = short_names(out.methods, ", ");
  if (members.size() > 1) {
    std::erase_if(members, [&](const MethodVerdict* m) { return m->method == baseline; });
  }
  std::vector<Changes> changes;
  for (const MethodVerdict* m : members) changes.push_back(changes_of(*m, sequences));
  out.all = range_of(changes, 0);
  if (out.all) out.interval = interval_of(members);
  for (std::size_t s = 1; s <= sequences.size(); ++s) {
    out.by_sequence.push_back(range_of(changes, s));
  }
  return out;
}

std::string short_names(Names names, const std::string& last_separator) {
  constexpr std::size_t kMost = 3;
  const std::size_t plus = names.front().find(" + ");
  for (std::size_t i = 1; i < names.size() && plus != std::string::npos; ++i) {
    if (names[i].starts_with(names.front().substr(0, plus + 3))) names[i].erase(0, plus + 3);
  }
  if (names.size() > kMost) {
    names[kMost - 1] = fmt::format("{} more", names.size() - (kMost - 1));
    names.resize(kMost);
    return fmt::format("{}", fmt::join(names, ", "));
  }
  std::string out;
  for (std::size_t i = 0; i < names.size(); ++i) {
    out += (i == 0 ? "" : i + 1 == names.size() ? last_separator : ", ") + names[i];
  }
  return out;
}

std::vector<VerdictGroup> groups_of(const Comparison& c, const Names& sequences) {
  constexpr std::size_t kMostGroups = 5;
  double points = 1.0;
  std::vector<VerdictGroup> out = groups_within(c, sequences, points);
  for (int step = 0; step < 12 && out.size() > kMostGroups; ++step) {
    points *= 2.0;
    out = groups_within(c, sequences, points);
  }
  return out;
}

std::vector<std::string> cautions_of(const Comparison& c, const std::vector<Comparison>& all) {
  constexpr std::size_t kMost = 3;
  std::vector<Caution> found;
  add_cautions(found, c, "");
  for (const Comparison& other : all) {
    const bool is_rotation = other.kind.unit == "deg" && c.kind.unit != "deg" &&
                             other.kind.metric_label() == c.kind.metric_label() &&
                             other.kind.times == c.kind.times && other.kind.axis == c.kind.axis &&
                             other.kind.protocol == c.kind.protocol;
    if (is_rotation) add_cautions(found, other, "rotation: ");
  }
  std::ranges::stable_sort(found, std::greater(), &Caution::log_ratio);
  Names out;
  for (const Caution& each : found) {
    if (out.size() < kMost) out.push_back(each.text);
  }
  if (found.size() > kMost) out.push_back(fmt::format("{} more like that", found.size() - kMost));
  return out;
}

}  // namespace loopbench::harness
