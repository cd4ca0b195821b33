/// The answer of a comparison: a sentence, a table of groups, cautions. All commands, formats and
/// the report show the same one.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "harness/answers/compare/compare.hpp"

namespace loopbench::harness {

/// Changes against the baseline [%], below zero where the value is lower.
struct Change {
  double low = 0.0;
  double high = 0.0;
};

/// Methods of one place with similar changes.
struct VerdictGroup {
  bool is_first = true;  ///< shares the first place (=); otherwise significantly worse (>)
  std::string name;      ///< "dual + dm_n3, dm_n4, 8 more"
  std::vector<std::string> methods;
  std::optional<Change> all;       ///< of the members that have one, see MethodVerdict
  std::optional<Change> interval;  ///< from the lowest to the highest end of theirs
  std::vector<std::optional<Change>> by_sequence;  ///< in the order of Verdict::sequences
};

struct Verdict {
  std::string sentence;                ///< the score, what is best or decided, and by how much
  std::vector<std::string> sequences;  ///< with a change each, the largest of many; none of one
  std::vector<VerdictGroup> groups;    ///< the first place first; empty for one run
  bool has_places = false;             ///< false: too few runs to show anything
  std::vector<std::string> cautions;   ///< methods that are worse than the baseline somewhere
  std::vector<std::string> cautioned;  ///< sequences that they name: their columns are shown first
  std::string legend;                  ///< what the numbers are, and for what claims hold
  std::string legend_in_paper;         ///< without options of the command line
  double level = 95.0;                 ///< of the intervals [%]

  /// Whether the groups show more than the sentence.
  bool has_table() const { return groups.size() > 1 || !sequences.empty(); }
};

/// `all`: comparisons among which that of the rotation is searched, for cautions.
Verdict verdict_of(const Comparison& comparison, const std::vector<Comparison>& all);

/// The score to show first: dense ATE in translation, or the nearest to it that compares two
/// methods. Null if none does.
const Comparison* headline(const std::vector<Comparison>& all);

/// Some methods as one group, without the change of the baseline beside others, because it is zero.
VerdictGroup group_of(const std::vector<const MethodVerdict*>& members,
                      const std::vector<std::string>& sequences,
                      const std::string& baseline);

/// The groups: the first place, then methods whose changes, over all and on each sequence, differ
/// by at most a point, or more if there would be more than five groups. If no method is worse, each
/// one is a group. Without the baseline, unless it shares the first place with others. Programs and
/// plugins are marked.
std::vector<VerdictGroup> groups_of(const Comparison& comparison,
                                    const std::vector<std::string>& sequences);

/// Sets the cautions and their sequences: methods that are significantly worse than the baseline on
/// a sequence, or in rotation, then those of the first place that are 50 % worse on one without
/// being shown to be. The three worst, one line each, and the number of others.
void add_cautions(Verdict& verdict,
                  const Comparison& comparison,
                  const std::vector<Comparison>& all);

/// The sentence without the score: "dual is best, 14 % below raw (95 %: 11 to 16)".
std::string sentence(const Comparison& comparison);

/// Without what is usual: "ate rotation, dense".
std::string short_title(const Comparison& comparison);

/// "ate rotation rmse, dense, loopbench".
std::string title(const Comparison& comparison);

/// The method, marked if its values are times that it states itself.
std::string shown_name(const MethodVerdict& method);

/// That of the baseline.
std::string baseline_name(const Comparison& comparison);

/// "dual + dm_n3, dm_n4, 8 more": of methods without a label of their own, without the corrector
/// that is also the first one's.
std::string short_names(const std::vector<const MethodVerdict*>& methods,
                        const std::string& last_separator);

/// "44", "5.1", "-0.0012": at least two digits, and `more`.
std::string percent_text(double percent, int more = 0);

/// "+12", or of a range wider than `narrow` points "-37 to -51", the end nearer to zero first.
std::string text(const Change& change, double narrow, int more = 0);

/// How many more digits distinguish the changes of the first place from those of other groups.
int digits_of(const std::vector<VerdictGroup>& groups, double narrow);

/// "12 % below raw (95 %: 8.1 to 15), p = 0.02": the difference of a method to the baseline.
std::string result_text(const Comparison& comparison, const MethodVerdict& method);

/// "5 runs of 1 sequence; a test needs 6".
std::string cannot_show_text(const Comparison& comparison);

/// "8 runs", "20 sequences", "6 groups (30 runs)": the observations of a comparison.
std::string unit_text(const Comparison& comparison);

/// "half covers 53 % of the reference, others up to 100 %": methods that cover clearly less than
/// another one, or those of them that share the first place; empty for none.
std::string coverage_text(const Comparison& comparison, bool of_first);

/// Properties of the data that limit the claims: copies, gaps, coverage, oracles.
std::vector<std::string> limitations(const Comparison& comparison);

/// The limitations, and what the numbers of each method are. `in_paper`: without commands.
std::vector<std::string> remarks(const Comparison& comparison, bool in_paper = false);

}  // namespace loopbench::harness
