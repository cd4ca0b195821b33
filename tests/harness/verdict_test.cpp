/// The verdict: sentence, groups, cautions.
#include "harness/answers/compare/verdict.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "harness/answers/compare/stated.hpp"
#include "harness/answers/tables/comparison.hpp"
#include "tests/support/compared_sweep.hpp"

namespace loopbench::compared_sweep::verdict_test {
namespace {

std::vector<Comparison> against_raw(const std::vector<Record>& records) {
  return compare(records, {.baseline = "raw"});
}

/// Sixteen seeds of two sequences; errors of each method by sequence.
std::vector<Record> errors(const std::vector<std::pair<std::string, std::array<double, 2>>>& of) {
  std::vector<Record> out;
  for (int seed = 0; seed < 16; ++seed) {
    for (const std::size_t s : {0u, 1u}) {
      for (std::size_t m = 0; m < of.size(); ++m) {
        const double noise = 1.0 + 0.001 * ((seed * (5 + 2 * static_cast<int>(m))) % 16 - 7.5);
        out.push_back(
            score(s == 0 ? "room" : "sparse", seed, of[m].first, noise * of[m].second[s]));
      }
    }
  }
  return out;
}

Record in_rotation(Record r, double error) {
  r.kind.edit().relation = "rotation";
  r.kind.edit().unit = "deg";
  r.statistics.rmse = error;
  return r;
}

/// `dual` with three smoothers that are equal on average, and correctors.
std::vector<Record> smoothers() {
  std::vector<Record> out = errors({{"raw", {1.0, 1.0}},
                                    {"two_pass", {0.7, 0.9}},
                                    {"dual", {0.6, 0.8}},
                                    {"pose_graph", {0.6, 0.803}},
                                    {"dual + dm_n3", {0.6, 0.5}},
                                    {"dual + dm_n4", {0.5995, 0.5004}},
                                    {"dual + dm_robust", {0.6002, 0.4998}}});
  for (Record& r : out) {
    const std::string& method = r.cell->method;
    const bool is_chain = method.size() > 7 && method.starts_with("dual + ");
    r.cell.edit().parts.corrector = is_chain ? "dual" : method;
    if (is_chain) r.cell.edit().parts.smoother = method.substr(7);
  }
  return out;
}

TEST(VerdictSentence, NamesASmootherOnlyIfThereIsOne) {
  std::vector<Record> records = smoothers();
  for (Record& r : records) {  // labels with a plus, and no smoother
    r.cell.edit().parts = {.corrector = r.cell->method};
  }
  const std::vector<Comparison> all = against_raw(records);
  EXPECT_EQ(verdict_of(all[0], all).sentence.find("smoother"), std::string::npos);
}

TEST(VerdictSentence, MarksTimesThatProgramsState) {
  std::vector<Record> records = smoothers();
  for (Record& r : records) {
    r.kind.edit().metric = "time";
    r.cell.edit().stated_times = r.cell->method == "raw" || r.cell->method == "dual + dm_n3";
  }
  const std::vector<Comparison> all = against_raw(records);
  const Verdict v = verdict_of(all[0], all);
  EXPECT_EQ(v.sentence.find("with a smoother"), std::string::npos) << v.sentence;
  for (const char* const name : {"dm_n3 (s)", " % below raw (s) ("}) {
    EXPECT_NE(v.sentence.find(name), std::string::npos) << v.sentence;
  }
  EXPECT_NE(v.legend.find("(s): as the program states it"), std::string::npos) << v.legend;
  for (const Record& r : records) EXPECT_EQ(is_stated(r), r.cell->stated_times);
  for (Record& r : records) r.kind.edit().metric = "ate";
  EXPECT_EQ(verdict_of(against_raw(records)[0], all).sentence.find("(s)"), std::string::npos);
}

TEST(VerdictTable, NamesGroupsByWhatTheyHaveInCommon) {
  const std::vector<Comparison> all = against_raw(smoothers());
  const Verdict v = verdict_of(all[0], all);
  EXPECT_TRUE(
      v.sentence.starts_with("ate, dense: dual with a smoother is best, 45 % below raw (95 %: "))
      << v.sentence;
  EXPECT_LE(std::ranges::count(v.sentence, ' ') + 1, 25) << v.sentence;
  ASSERT_EQ(v.groups.size(), 3u);  // without the baseline
  EXPECT_TRUE(v.groups[0].name.starts_with("dual + ")) << v.groups[0].name;
  EXPECT_EQ(v.groups[0].name.size(), std::string("dual + dm_n3, dm_n4, dm_robust").size());
  const Table table = verdict_table(v);
  const auto line = [&](std::size_t group) {
    std::string out;
    for (const TableCell& cell : table.lines[group]) out += cell.text + "|";
    return out;
  };
  EXPECT_EQ(line(1), "> dual, pose_graph|-31|-30 to -31|-40|-20|");
  EXPECT_EQ(line(2), "> two_pass|-21|-20 to -21|-30|-10|");
  EXPECT_TRUE(
      v.legend.starts_with("change: relative to raw [%], typical over 32 runs of 2 sequences (mean "
                           "of the sequences); 95 %: "))
      << v.legend;
  EXPECT_TRUE(v.cautions.empty());
}

TEST(VerdictTable, ShowsTheRangeOfMembersThatDiffer) {
  const std::vector<Record> records = errors({{"raw", {1.0, 1.0}},
                                              {"a", {0.5, 0.6}},
                                              {"b", {0.5, 0.6001}},
                                              {"far", {0.9, 0.9}},
                                              {"c", {0.4, 0.75}}});
  const Comparison c = against_raw(records)[0];
  ASSERT_FALSE(c.methods[2].is_worse);  // better on one, worse on the other
  const std::string text = terminal(verdict_table(verdict_of(c, {})));
  EXPECT_TRUE(has(text, "  -50 to -60  -25 to -40\n")) << text;
}

TEST(VerdictTable, HasTheSamePartsInEveryFormat) {
  const std::vector<Comparison> all = against_raw(smoothers());
  const Verdict v = verdict_of(all[0], all);
  const std::string text = json(all);
  EXPECT_TRUE(has(text, "\"verdict\": \"" + v.sentence + "\"")) << text;
  EXPECT_TRUE(has(text, "\"name\": \"dual, pose_graph\""));
  EXPECT_TRUE(has(text, "\"legend\": \"" + v.legend + "\""));
  EXPECT_TRUE(markdown(verdict_table(v)).starts_with("### " + v.sentence + "\n\n| group"));
}

TEST(VerdictTable, StatesWhichCommandPrintsSequencesThatDoNotFit) {
  std::vector<Record> records = smoothers();
  for (Record& r : records) r.cell.edit().sequence = std::string(50, r.cell->sequence.text()[0]);
  const Verdict v = verdict_of(against_raw(records)[0], {});
  EXPECT_EQ(verdict_table(v, 0).headings.size(), 5u);
  const Table table = verdict_table(v);
  ASSERT_EQ(table.headings.size(), 4u);
  EXPECT_EQ(table.headings.back(), std::string(50, 's'));  // -50 %, beside -40 % in the room
  EXPECT_EQ(table.notes.back().text, "1 sequence more: compare --format json");
}

TEST(VerdictSentence, OfTwoFilesHasTheirValues) {
  const Comparison c = compared({score("day", 0, "open", 0.064), score("day", 0, "other", 0.1222)},
                                {.baseline = "open"});
  const Verdict v = verdict_of(c, {});
  EXPECT_EQ(v.sentence,
            "ate, dense: open 0.064 m, other 0.122 m (+91 %). One recording; a test needs 6.");
  EXPECT_FALSE(v.has_table());
  EXPECT_EQ(v.legend, "");
}

TEST(VerdictSentence, StatesHowManyRunsWouldDoAndListsAllMethods) {
  // Three methods win 6 of 6: 1 - (31 / 32)^3 = 0.0909.
  std::vector<Record> records;
  for (int run = 0; run < 6; ++run) {
    records.push_back(score("room", run, "raw", 0.3));
    for (const std::string m : {"a", "b", "c"})
      records.push_back(score("room", run, m, 0.1 + 0.002 * ((run * 5 + m[0]) % 6)));
  }
  const Verdict v = verdict_of(compared(records, {.baseline = "raw"}), {});
  EXPECT_EQ(v.sentence.substr(0, v.sentence.find(';')),
            "ate, dense: 6 runs of 1 sequence cannot decide among 4 methods: 7 would");
  EXPECT_TRUE(v.sentence.ends_with(" % below raw on 6 of 6.")) << v.sentence;
  EXPECT_FALSE(v.has_places);
  std::string text;
  for (const VerdictGroup& group : v.groups) text += group.name + "|";
  for (const char* name : {"a", "b", "c"}) EXPECT_TRUE(has(text, name)) << text;
}

TEST(VerdictTable, ListsTheMethodsOfWhichNoneIsShownToBeBetter) {
  std::vector<Record> records;
  for (int run = 0; run < 12; ++run) {
    records.push_back(score("room", run, "raw", 1.0));
    records.push_back(score("room", run, "near", std::exp(0.1 * ((run * 5) % 12 - 5.4))));
    records.push_back(score("room", run, "far", std::exp(0.1 * ((run * 7) % 12 - 4.4))));
  }
  const Verdict v = verdict_of(compared(records, {.baseline = "raw"}), {});
  EXPECT_TRUE(v.sentence.starts_with("ate, dense: nothing is decided: near is ")) << v.sentence;
  EXPECT_EQ(v.groups.size(), 2u);
}

TEST(VerdictTable, ListsEachMethodAloneAndMarksTheUsersOwnWhereNoneIsWorse) {
  std::vector<Record> records;
  for (int run = 0; run < 4; ++run) {
    records.push_back(score("room", run, "raw", 1.0));
    for (const std::string m : {"dual", "uniform", "two_pass", "script", "plugin"}) {
      Record& r = records.emplace_back(score("room", run, m, 0.5 + 0.001 * run));
      r.cell.edit().parts.corrector = m == "plugin" ? "theirs" : "dual";
      if (m == "script")
        r.cell.edit().parts = {.corrector = "command", .program = "./mine {result}"};
    }
  }
  const Verdict v = verdict_of(compared(records, {.baseline = "raw"}), {});
  ASSERT_EQ(v.groups.size(), 5u);  // although all have the same change
  EXPECT_EQ(v.groups[2].name, "two_pass");
  EXPECT_EQ(v.groups[3].name, "script (own)");
  EXPECT_EQ(v.groups[4].name, "plugin (own)");
}

TEST(VerdictTable, NamesTheUsersOwnMethodsOfAGroupFirst) {
  std::vector<Record> records = smoothers();
  for (Record& r : records) {
    if (r.cell->method == "dual + dm_robust") r.cell.edit().parts = {.program = "./mine"};
  }
  const std::vector<Comparison> all = against_raw(records);
  const Verdict v = verdict_of(all[0], all);
  EXPECT_TRUE(v.groups[0].name.starts_with("dual + dm_robust (own), dual + ")) << v.groups[0].name;
  EXPECT_FALSE(has(v.sentence, "(own)")) << v.sentence;
}

TEST(VerdictTable, HasDigitsThatTellPlacesApart) {
  std::vector<Record> records =
      errors({{"raw", {1.0, 1.0}}, {"best", {0.0500, 0.0500}}, {"next", {0.0520, 0.0520}}});
  const Verdict v = verdict_of(against_raw(records)[0], {});
  ASSERT_EQ(v.groups.size(), 2u);
  const Table table = verdict_table(v);
  EXPECT_EQ(table.lines[0][1].text.substr(0, 5), "-95.0");
  EXPECT_EQ(table.lines[1][1].text.substr(0, 5), "-94.8");
}

TEST(Cautions, AreAboutSequencesAndRotation) {
  std::vector<Record> records = smoothers();
  for (const Record& r : smoothers()) {
    const bool is_sparse = r.cell->sequence == "sparse";
    double factor = 1.0;
    if (r.cell->method == "dual + dm_n3") factor = is_sparse ? 1.68 : 0.9;
    if (r.cell->method == "dual + dm_n4") factor = is_sparse ? 0.34 : 0.9;
    records.push_back(in_rotation(
        r,
        r.cell->method == "raw" ? r.statistics.rmse
                                : factor * (1.0 + 0.001 * static_cast<double>(r.cell->repeat))));
  }
  std::erase_if(records, [](const Record& r) { return r.cell->method == "dual + dm_robust"; });
  const std::vector<Comparison> all = against_raw(records);
  ASSERT_EQ(all.size(), 2u);
  const Verdict v = verdict_of(all[0], all);
  ASSERT_FALSE(v.cautions.empty());
  EXPECT_TRUE(has(v.cautions[0], "rotation: dual + dm_n3 is 6")) << v.cautions[0];
  EXPECT_TRUE(has(v.cautions[0], " % worse than raw on sparse, dual + dm_n4 6")) << v.cautions[0];
  EXPECT_TRUE(verdict_of(all[1], all).cautions[0].starts_with("dual + dm_n3 is 6"));
}

TEST(Cautions, OfAHigherScoreHaveTheChangesOfTheTable) {
  std::vector<Record> records = errors({{"raw", {1.0, 1.0}}, {"a", {2.0, 0.5}}, {"b", {2.0, 2.0}}});
  for (Record& r : records) r.kind.edit().better = metrics::Better::higher;
  const std::vector<Comparison> all = against_raw(records);
  const std::vector<std::string> cautions = verdict_of(all[0], all).cautions;
  ASSERT_EQ(cautions.size(), 1u);
  EXPECT_EQ(cautions[0], "a is 50 % worse than raw on sparse, b 100 % better");
}

TEST(Cautions, AreTheThreeWorst) {
  std::vector<std::pair<std::string, std::array<double, 2>>> methods{{"raw", {1.0, 1.0}}};
  for (int m = 0; m < 5; ++m) {
    methods.push_back({"m" + std::to_string(m), {0.3, 1.2 + 0.1 * m}});
  }
  const Verdict v = verdict_of(against_raw(errors(methods))[0], {});
  ASSERT_EQ(v.cautions.size(), 4u);
  EXPECT_TRUE(v.cautions[0].starts_with("m4 is 60 % worse than raw on sparse")) << v.cautions[0];
  EXPECT_EQ(v.cautions[3], "2 more cautions");
}

}  // namespace
}  // namespace loopbench::compared_sweep::verdict_test
