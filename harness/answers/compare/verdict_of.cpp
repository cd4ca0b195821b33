#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "harness/answers/compare/stated.hpp"
#include "harness/answers/compare/verdict.hpp"

namespace loopbench::harness {
namespace {

using Names = std::vector<std::string>;

/// Sets the legends.
void add_legend(const Comparison& c, Verdict& v) {
  std::string out = "change: ";
  if (c.kind.better == metrics::Better::target) {
    out += fmt::format("of |value - {:g}| ", c.kind.target);
  }
  out += "relative to " + baseline_name(c) + " [%], typical over " + unit_text(c);
  if (std::ranges::any_of(
          c.methods, [](const MethodVerdict& m) { return m.ratio && m.ratio->is_of_sequences; }))
    out += " (mean of the sequences)";
  if (std::ranges::any_of(c.methods, [](const MethodVerdict& each) { return each.fails > 0; }))
    out += ", only those that both methods solved";
  if (c.can_show) out += fmt::format("; {:g} %: simultaneous interval over all methods", v.level);
  const auto is_several = [](const VerdictGroup& g) { return g.methods.size() > 1; };
  if (v.has_table() && std::ranges::any_of(v.groups, is_several)) {
    out += "; other ranges: spread within a group";
  }
  if (v.groups.size() > 1 && c.can_show) {
    out += fmt::format("; =: shares first place, >: shown to be worse, typically by {:g} % or more",
                       100.0 * c.options.relevant);
  }
  v.legend = v.legend_in_paper = out;
  const auto add = [&](const std::string& text, const std::string& paper) {
    v.legend += text;
    v.legend_in_paper += paper;
  };
  if (std::ranges::any_of(c.methods, &MethodVerdict::is_stated))
    add(std::string("; ") + kStatedNote, std::string("; ") + kStatedInPaper);
  const std::string dense = c.kind.times == "dense" ? "; dense: also between keyframes" : "";
  add(dense, dense);
  if (c.is_independent) {
    const std::string independent = "; runs of a sequence count as independent";
    add(independent + " (compare --paired pairs equal names)", independent);
  } else if (c.sequences < c.groups) {
    add("; for claims about other sequences: --over sequences", "");
  }
}

/// The sequences with a change, at most so many: those of cautions, then those with the largest.
Names sequences_with_changes(const Comparison& c, const Names& cautioned, std::size_t most) {
  Names out;
  std::map<std::string, double> largest;
  for (const MethodVerdict& m : c.methods) {
    if (!m.ratio || m.method == c.options.baseline) continue;
    for (const SequenceRatio& one : m.ratio->by_sequence) {
      if (!largest.contains(one.sequence)) out.push_back(one.sequence);
      double& size = largest[one.sequence];
      size = std::max(size, std::abs(std::log(one.ratio)));
    }
  }
  while (out.size() > most) {
    out.erase(std::ranges::min_element(out, {}, [&](const auto& name) {
      return std::pair(std::ranges::count(cautioned, name) > 0, largest[name]);
    }));
  }
  return out;
}

}  // namespace

int digits_of(const std::vector<VerdictGroup>& groups, double narrow) {
  constexpr int kMost = 3;
  for (int more = 0; more < kMost; ++more) {
    std::set<std::string> first, worse;
    for (const VerdictGroup& group : groups) {
      if (group.all) (group.is_first ? first : worse).insert(text(*group.all, narrow, more));
    }
    const auto is_first = [&](const std::string& each) { return first.contains(each); };
    if (std::ranges::none_of(worse, is_first)) return more;
  }
  return kMost;
}

const Comparison* headline(const std::vector<Comparison>& all) {
  const Comparison* out = nullptr;
  int best = -1;
  for (const Comparison& c : all) {
    const bool is_ate =
        c.kind.metric == "ate" && c.kind.relation == "translation" && c.kind.axis == "3d";
    const int rank = (is_ate ? 2 : 0) + (c.kind.times == "dense" ? 1 : 0);
    if (c.methods.size() < 2 || rank <= best) continue;
    best = rank;
    out = &c;
  }
  return out;
}

Verdict verdict_of(const Comparison& c, const std::vector<Comparison>& all) {
  constexpr std::size_t kMostSequences = 6;
  Verdict out;
  out.sentence = short_title(c) + ": " + sentence(c) + ".";
  if (c.methods.empty()) return out;
  add_cautions(out, c, all);
  if (c.groups < 2) return out;
  out.sequences = sequences_with_changes(c, out.cautioned, kMostSequences);
  out.has_places = c.can_show;
  out.groups = groups_of(c, out.sequences);
  out.level = 100.0 * (1.0 - c.options.alpha);
  add_legend(c, out);
  return out;
}

}  // namespace loopbench::harness
