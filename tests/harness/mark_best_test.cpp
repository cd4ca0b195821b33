/// Tables mark methods that `compare` calls best, and no others.

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "harness/answers/tables/pivot.hpp"
#include "tests/studies/synthetic_records.hpp"
#include "tests/support/compared_sweep.hpp"

namespace loopbench::compared_sweep::mark_best_test {
namespace {

using Names = std::set<std::string>;

/// By `compare` with any baseline that has values.
Names called_best(const std::vector<Record>& records) {
  const auto scored =
      std::ranges::find_if(records, [](const Record& r) { return r.kind->metric == "ate"; });
  if (scored == records.end()) return {};
  const Comparison c = compare(records, {.baseline = scored->cell->method}).at(0);
  Names out;
  for (const MethodVerdict& m : c.methods) {
    if (c.is_best && !m.is_worse) out.insert(m.method);
  }
  return out;
}

Names marked_in_column(const Table& table, std::size_t column) {
  Names out;
  for (const auto& line : table.lines) {
    if (line[column].is_best) out.insert(line[0].text);
  }
  return out;
}

Names marked_in_row(const Table& table, std::size_t row) {
  Names out;
  for (std::size_t c = 1; c < table.headings.size(); ++c) {
    const std::string& heading = table.headings[c];
    if (table.lines[row][c].is_best) out.insert(heading.substr(0, heading.rfind(" [")));
  }
  return out;
}

Table table_of(const std::vector<Record>& records,
               const std::vector<std::string>& rows,
               const std::vector<std::string>& columns) {
  return pivot(records, {.rows = rows, .columns = columns, .split = {"times"}}).at(0);
}

std::vector<Record> of_sequence(std::vector<Record> records, const std::string& sequence) {
  std::erase_if(records, [&](const Record& r) { return r.cell->sequence != sequence; });
  return records;
}

/// The marks are corrected for the columns, and need the smallest mean: either those of compare or
/// none.
void expect_marks(const Names& marked, const Names& best) {
  EXPECT_TRUE(marked.empty() || marked == best);
}

/// Returns the number of marks.
std::size_t expect_marks_of_compare(const std::vector<Record>& records) {
  const Names best = called_best(records);
  const Names marked = marked_in_column(table_of(records, {"method"}, {"score"}), 1);
  expect_marks(marked, best);
  EXPECT_EQ(marked_in_row(table_of(records, {"score"}, {"method"}), 0), marked);
  std::size_t marks = marked.size();
  const Table by_sequence = table_of(records, {"method"}, {"sequence"});
  for (std::size_t c = 1; c < by_sequence.headings.size(); ++c) {
    const std::string& heading = by_sequence.headings[c];
    const Names own = called_best(of_sequence(records, heading.substr(0, heading.rfind(" ["))));
    expect_marks(marked_in_column(by_sequence, c), own);
    marks += marked_in_column(by_sequence, c).size();
  }
  const Table sequences = table_of(records, {"sequence"}, {"method"});
  for (std::size_t row = 0; row < sequences.lines.size(); ++row) {
    const std::string& name = sequences.lines[row][0].text;
    expect_marks(marked_in_row(sequences, row), called_best(of_sequence(records, name)));
  }
  return marks;
}

TEST(Marks, AreThoseOfCompareWhateverTheRecords) {
  std::mt19937_64 bits(5);
  std::size_t marks = 0, declined = 0;
  for (const synthetic::Shape& shape : synthetic::shapes()) {
    for (int i = 0; i < 9; ++i) {
      synthetic::Truth truth{.effects = {0.0, -0.1 * i, -0.05, 0.2}, .groups = 40};
      if (i % 2 == 1) truth.failures = {0.0, 0.05, 0.1, 0.3};
      if (i % 4 > 1) truth.sequences.assign(3, {0.0, -0.1, 0.1, 0.0});
      if (i % 8 > 3) truth.copies = 0.3;
      if (i % 3 == 1) truth.runs_in_group = 3;
      truth.is_independent = i % 5 == 4;
      std::vector<Record> records = synthetic::records(truth, shape, bits);
      marks += expect_marks_of_compare(records);
      for (Record& r : records) {
        r.possible = 100;
        r.pairs = r.cell->method == "m1" ? 60 : 100;
        r.cell.edit().oracle = i % 7 == 6 && r.cell->method == "m2";
      }
      if (called_best(records).empty()) ++declined;
      expect_marks_of_compare(records);
    }
  }
  EXPECT_GT(marks, 50u);  // fewer than compare calls best: corrected for the columns
  EXPECT_GT(declined, 20u);
}

/// The errors of `second` are twice as large.
std::vector<Record> two_methods(int runs) {
  std::vector<Record> out;
  for (int repeat = 0; repeat < runs; ++repeat) {
    for (const std::string method : {"first", "second"}) {
      out.push_back(ate(method, (method == "first" ? 1.0 : 2.0) + 0.01 * repeat, repeat));
    }
  }
  return out;
}

TEST(Marks, AreNotGivenForLowCoverage) {
  std::vector<Record> records = two_methods(8);
  EXPECT_EQ(table_of(records, {"method"}, {"score"}).notes.front(),
            "marked: shown to be better than each other method of the column");
  for (Record& r : records) {
    r.possible = 100;
    r.pairs = r.cell->method == "first" ? 60 : 100;
  }
  const Table table = table_of(records, {"method"}, {"score"});
  EXPECT_EQ(marked_in_column(table, 1), Names{});
  EXPECT_EQ(table.notes.back(),
            "no best value is marked: first covers 60 % of the reference, others up to 100 %");
}

TEST(Marks, AreExplainedWhereNothingCanBeShown) {
  EXPECT_EQ(table_of(two_methods(5), {"method"}, {"score"}).notes.back(),
            "no best value is marked: 5 runs of 1 sequence; a test needs 6");
}

TEST(Marks, AreOfOneScoreAndOneEntryOfAMethod) {
  std::vector<Record> records = two_methods(8);
  const Table several = table_of(records, {"method", "repeat"}, {"score"});
  EXPECT_EQ(marked_in_column(several, 1), Names{});
  EXPECT_EQ(note_texts(several), std::vector<std::string>{});
  for (Record& r : records) {
    if (r.cell->method == "second") r.kind.edit().relation = "rotation";
  }
  EXPECT_EQ(marked_in_column(table_of(records, {"method"}, {"metric"}), 1), Names{});
}

TEST(Marks, AreNotGivenAmongSequencesOrDescriptions) {
  std::vector<Record> records = two_methods(8);
  for (Record& r : records) r.kind.edit().better = metrics::Better::neither;
  EXPECT_EQ(marked_in_column(table_of(records, {"method"}, {"score"}), 1), Names{});
  for (Record& r : records) {
    r.kind.edit().better = metrics::Better::lower;
    r.cell.edit().sequence = r.cell->method;
    r.cell.edit().method = "raw";
  }
  EXPECT_EQ(marked_in_column(table_of(records, {"sequence"}, {"score"}), 1), Names{});
}

}  // namespace
}  // namespace loopbench::compared_sweep::mark_best_test
