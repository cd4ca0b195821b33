#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "harness/answers/compare/stated.hpp"
#include "harness/answers/compare/verdict.hpp"
#include "harness/sweep/text/counted.hpp"

namespace loopbench::harness {
namespace {

using Names = std::vector<std::string>;

double change_of_ratio(double ratio) { return 100.0 * (ratio - 1.0); }

void widen(std::optional<Change>& range, double low_ratio, double high_ratio) {
  const Change own{change_of_ratio(low_ratio), change_of_ratio(high_ratio)};
  range = range ? Change{std::min(range->low, own.low), std::max(range->high, own.high)} : own;
}

/// Whether both have changes, which are all within `points`, or none has.
bool are_near(const std::optional<Change>& a, const std::optional<Change>& b, double points) {
  if (!a || !b) return a.has_value() == b.has_value();
  return std::max(a->high, b->high) - std::min(a->low, b->low) <= points;
}

bool are_near(const VerdictGroup& a, const VerdictGroup& b, double points) {
  bool out = are_near(a.all, b.all, points);
  for (std::size_t s = 0; s < a.by_sequence.size(); ++s) {
    out = out && are_near(a.by_sequence[s], b.by_sequence[s], points);
  }
  return out;
}

/// The first place, and neighbours that differ by at most `points` from all of their group.
std::vector<VerdictGroup> groups_within(const Comparison& c,
                                        const Names& sequences,
                                        double points) {
  const auto as_group = [&](const std::vector<const MethodVerdict*>& members) {
    return group_of(members, sequences, c.options.baseline);
  };
  std::vector<VerdictGroup> out;
  std::vector<const MethodVerdict*> members;  // of the last group
  for (const MethodVerdict& m : c.methods) {
    if (m.is_worse && m.method == c.options.baseline) continue;
    const VerdictGroup own = as_group({&m});
    const bool joins = !out.empty() && out.back().is_first == own.is_first &&
                       (own.is_first || are_near(out.back(), own, points));
    if (!joins) {
      members.clear();
      out.emplace_back();
    }
    members.push_back(&m);
    out.back() = as_group(members);
  }
  return out;
}

/// One for each method that is compared with the baseline.
std::vector<VerdictGroup> single_groups(const Comparison& c, const Names& sequences) {
  std::vector<VerdictGroup> out;
  for (const MethodVerdict& m : c.methods) {
    if (m.method != c.options.baseline)
      out.push_back(group_of({&m}, sequences, c.options.baseline));
  }
  return out;
}

/// A method that is worse than the baseline.
struct Caution {
  bool is_clear = true;  ///< significantly
  double log_ratio = 0.0;
  std::string text;
  std::string sequence = {};  ///< empty: over all
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
  double least = 1.0, found = 1.0;
  for (const MethodVerdict& m : c.methods) {
    if (!m.ratio) continue;
    for (const SequenceRatio& one : m.ratio->by_sequence) {
      if (one.sequence != sequence || !one.is_clear) continue;
      const double ratio = c.kind.better == metrics::Better::higher ? 1.0 / one.ratio : one.ratio;
      if (!(ratio < least)) continue;
      best = &m;
      least = ratio;
      found = one.ratio;
    }
  }
  return best == nullptr ? ""
                         : ", " + shown_name(*best) + " " + percent_of_ratio(found) + " better";
}

/// The sequence on which a method is worst, significantly or not; null if it is not worse on any.
const SequenceRatio* worst_sequence(const Comparison& c, const MethodVerdict& m, bool is_clear) {
  const SequenceRatio* worst = nullptr;
  for (const SequenceRatio& one : m.ratio->by_sequence) {
    if (one.is_clear != is_clear || !is_worse_ratio(one.ratio, c)) continue;
    if (!worst || is_worse_ratio(one.ratio / worst->ratio, c)) worst = &one;
  }
  return worst;
}

/// At most one for each method: the worst sequence.
void add_clear(std::vector<Caution>& out, const Comparison& c, const std::string& axis) {
  for (const MethodVerdict& m : c.methods) {
    if (!m.ratio) continue;
    const SequenceRatio* const worst = worst_sequence(c, m, true);
    const double ratio = worst != nullptr ? worst->ratio : m.ratio->typical.estimate;
    // That a method is worse over all is in the table of groups, but not for the rotation.
    if (!worst && (axis.empty() || !m.is_beaten)) continue;
    Caution& own = out.emplace_back();
    own.log_ratio = std::abs(std::log(ratio));
    own.text =
        axis + shown_name(m) + " is " + percent_of_ratio(ratio) + " worse than " + baseline_name(c);
    if (worst == nullptr) continue;
    own.text += " on " + worst->sequence + best_there(c, worst->sequence);
    own.sequence = axis.empty() ? worst->sequence : "";
    const auto sequences = std::ranges::count_if(m.ratio->by_sequence, [&](const auto& one) {
      return one.is_clear && is_worse_ratio(one.ratio, c);
    });
    if (sequences > 1) own.text += fmt::format("; worse on {} sequences", sequences);
  }
}

/// Methods of the first place that are far worse on a sequence, which too few runs show.
void add_unclear(std::vector<Caution>& out, const Comparison& c) {
  constexpr double kFar = 1.5;
  if (std::ranges::none_of(c.methods, &MethodVerdict::is_worse)) return;
  for (const MethodVerdict& m : c.methods) {
    if (!m.ratio || m.is_worse || worst_sequence(c, m, true) != nullptr) continue;
    const SequenceRatio* const worst = worst_sequence(c, m, false);
    if (worst == nullptr || std::abs(std::log(worst->ratio)) < std::log(kFar)) continue;
    out.push_back({false,
                   std::abs(std::log(worst->ratio)),
                   shown_name(m) + " is " + percent_of_ratio(worst->ratio) + " worse than " +
                       baseline_name(c) + " on " + worst->sequence + " (not significant)",
                   worst->sequence});
  }
}

const char* mark_of(const MethodVerdict& m) { return m.is_stated ? kStatedMark : ""; }

/// Whether the method is a corrector with a smoother, and its name is what a config without a label
/// gives it.
bool is_named_by_stages(const MethodVerdict& m) {
  const auto& [replay, corrector, smoother, program] = m.parts;
  return replay.empty() && !corrector.empty() && !smoother.empty() &&
         m.method == corrector + " + " + smoother;
}

/// The names of a group, the user's own methods first.
std::string marked_names(std::vector<const MethodVerdict*> members) {
  std::ranges::stable_sort(members, {}, [](const MethodVerdict* m) { return !is_own(m->parts); });
  std::vector<MethodVerdict> marked;
  for (const MethodVerdict* m : members) {
    marked.push_back(*m);
    if (is_own(m->parts)) marked.back().method += " (own)";
  }
  std::vector<const MethodVerdict*> all;
  for (const MethodVerdict& m : marked) all.push_back(&m);
  return short_names(all, ", ");
}

}  // namespace

std::string shown_name(const MethodVerdict& m) { return m.method + mark_of(m); }

std::string baseline_name(const Comparison& c) {
  const MethodVerdict* const found = c.find(c.options.baseline);
  return found == nullptr ? c.options.baseline : shown_name(*found);
}

VerdictGroup group_of(const std::vector<const MethodVerdict*>& members,
                      const Names& sequences,
                      const std::string& baseline) {
  VerdictGroup out;
  out.is_first = !members.front()->is_worse;
  out.by_sequence.resize(sequences.size());
  bool has_interval = true;
  for (const MethodVerdict* m : members) {
    out.methods.push_back(m->method);
    if (members.size() > 1 && m->method == baseline) continue;
    has_interval = has_interval && m->ratio && m->ratio->has_interval;
    if (!m->ratio) continue;
    const Interval& typical = m->ratio->typical;
    widen(out.all, typical.estimate, typical.estimate);
    widen(out.interval, typical.low, typical.high);
    for (const SequenceRatio& one : m->ratio->by_sequence) {
      const auto found = std::ranges::find(sequences, one.sequence);
      if (found == sequences.end()) continue;
      widen(out.by_sequence[static_cast<std::size_t>(found - sequences.begin())],
            one.ratio,
            one.ratio);
    }
  }
  if (!has_interval) out.interval.reset();
  out.name = marked_names(members);
  return out;
}

std::string short_names(const std::vector<const MethodVerdict*>& methods,
                        const std::string& last_separator) {
  constexpr std::size_t kMost = 3;
  const SharedText& corrector = methods.front()->parts.corrector;
  Names names;
  for (const MethodVerdict* m : methods) {
    const bool is_same = m != methods.front() && is_named_by_stages(*m) &&
                         is_named_by_stages(*methods.front()) && m->parts.corrector == corrector;
    names.push_back(is_same ? m->parts.smoother + mark_of(*m) : shown_name(*m));
  }
  if (names.size() > kMost) {
    names[kMost - 1] = fmt::format("{} more", names.size() - (kMost - 1));
    names.resize(kMost);
    return fmt::format("{}", fmt::join(names, ", "));
  }
  if (names.size() == 1) return names.front();
  const std::string last = last_separator + names.back();
  names.pop_back();
  return fmt::format("{}{}", fmt::join(names, ", "), last);
}

std::vector<VerdictGroup> groups_of(const Comparison& c, const Names& sequences) {
  constexpr std::size_t kMostGroups = 5;
  double points = 1.0;
  if (std::ranges::none_of(c.methods, &MethodVerdict::is_worse)) return single_groups(c, sequences);
  std::vector<VerdictGroup> out = groups_within(c, sequences, points);
  for (int step = 0; step < 12 && out.size() > kMostGroups; ++step) {
    points *= 2.0;
    out = groups_within(c, sequences, points);
  }
  return out;
}

void add_cautions(Verdict& verdict, const Comparison& c, const std::vector<Comparison>& all) {
  constexpr std::size_t kMost = 3;
  std::vector<Caution> found;
  add_clear(found, c, "");
  for (const Comparison& other : all) {
    const bool is_rotation = other.kind.unit == "deg" && c.kind.unit != "deg" &&
                             other.kind.metric_label() == c.kind.metric_label() &&
                             other.kind.times == c.kind.times && other.kind.axis == c.kind.axis &&
                             other.kind.protocol == c.kind.protocol;
    if (is_rotation) add_clear(found, other, "rotation: ");
  }
  add_unclear(found, c);
  std::ranges::stable_sort(found, std::greater(), [](const Caution& one) {
    return std::pair(one.is_clear, one.log_ratio);
  });
  for (const Caution& each : found) {
    if (verdict.cautions.size() == kMost) {
      verdict.cautions.push_back(counted(found.size() - kMost, "more caution"));
      break;
    }
    verdict.cautions.push_back(each.text);
    if (!each.sequence.empty()) verdict.cautioned.push_back(each.sequence);
  }
}

}  // namespace loopbench::harness
