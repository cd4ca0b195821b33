/// Notes as data: their texts, their way through a store, and how they are counted.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "datasets/core/fields.hpp"
#include "harness/answers/notes/counted_notes.hpp"
#include "harness/sweep/model/note_text.hpp"
#include "metrics/doctor/finding.hpp"
#include "tests/support/tiny_store.hpp"

namespace loopbench::tiny_store::notes_test {
namespace {

using testing::ElementsAre;

using StoredNotesTest = TinyStore;

Note ahead(double seconds) {
  return {.kind = NoteKind::time_offset,
          .severity = Severity::decisive,
          .numbers = {{"value", seconds, "s"}, {"confidence", 0.93}},
          .remedy = {"--offset", "-0.05"},
          .detail = "speeds agree"};
}

TEST(NoteText, IsMadeOfTheNumbers) {
  EXPECT_EQ(text(ahead(0.05)),
            "doctor: time_offset: speeds agree; --offset -0.05 (confidence 0.93)");
  EXPECT_EQ(text({.kind = NoteKind::low_coverage,
                  .numbers = {{"span", 12.34, "%"}, {"pairs", 3}, {"possible", 40}}}),
            "low coverage: 3 of 40 poses over 12.3 % of the reference's time");
  EXPECT_EQ(text({.kind = NoteKind::dataset, .subject = "a.txt", .detail = "sorted 3 rows"}),
            "a.txt: sorted 3 rows");
  EXPECT_EQ(
      text({.kind = NoteKind::dropped_rows, .subject = "estimate", .numbers = {{"value", 2}}}),
      "estimate: invalid rows dropped: 2");
  EXPECT_EQ(text({.kind = NoteKind::normalised_rotations, .numbers = {{"value", 0.0125}}}),
            "rotation matrices are normalised, they deviate from orthonormal by up to 0.013");
  EXPECT_EQ(
      text({.kind = NoteKind::nondeterministic, .numbers = {{"runs", 3}, {"trajectories", 2}}}),
      "nondeterministic: 3 runs on the same input gave 2 different trajectories");
}

TEST(NoteText, NoKindIsSilent) {
  for (const auto& [name, kind] : choices(NoteKind{})) {
    EXPECT_FALSE(text({.kind = kind, .numbers = {{"value", 1.0}}, .detail = "d"}).empty()) << name;
    EXPECT_EQ(from_text<NoteKind>(name), kind);
  }
}

TEST(NoteKinds, HaveTheNamesOfAllFaults) {
  using metrics::Fault;
  for (const Fault::Name fault : {Fault::time_offset,
                                  Fault::stamp_unit,
                                  Fault::no_overlap,
                                  Fault::missing_poses,
                                  Fault::wrong_recording,
                                  Fault::row_order,
                                  Fault::relative_poses,
                                  Fault::degrees,
                                  Fault::sheared,
                                  Fault::jumps,
                                  Fault::new_map,
                                  Fault::frozen,
                                  Fault::scale_change,
                                  Fault::constant_rotation,
                                  Fault::quaternion_order,
                                  Fault::inverted_poses,
                                  Fault::axes,
                                  Fault::mirrored,
                                  Fault::other_body,
                                  Fault::scale,
                                  Fault::swapped,
                                  Fault::loop_stamps,
                                  Fault::closure_direction,
                                  Fault::closure_convention,
                                  Fault::placeholders,
                                  Fault::closure_gap,
                                  Fault::odometry_step,
                                  Fault::information}) {
    const auto kind = from_text<NoteKind>(std::string(fault));
    ASSERT_TRUE(kind) << fault;
    EXPECT_TRUE(is_of_doctor(*kind)) << fault;
  }
}

TEST_F(StoredNotesTest, OfADatasetAreRowsOfTheStoreAndCounted) {
  known_.datasets.push_back(dataset<tiny::LineOptions>(
      "talks", "", [](const tiny::LineOptions& options, const DataRoot& root) {
        Sequence out = tiny::load_line(options, root);
        out.provenance.notes = {"skipped 3 rows"};
        return out;
      }));
  run("datasets: [{dataset: talks, bias: 0.1, label: a}, {dataset: talks, bias: 0.2, label: b}, "
      "{dataset: line, bias: 0.3, label: c}]\nmethods: [straight]\nmetrics: [ate]\n");
  const StoredNotes all = read_notes(file_);
  ASSERT_EQ(all.notes.size(), 5u);  // four poses are few
  EXPECT_EQ(all.notes[2].sequence, "b");
  EXPECT_EQ(all.notes[2].note, (Note{.kind = NoteKind::dataset, .detail = "skipped 3 rows"}));
  const std::string few =
      "few pairs: 4 pairs have 8 coordinates, and alignment se3 fits 3 parameters to them, so the "
      "errors are about 21 % too small";
  EXPECT_THAT(
      texts(counted_notes(file_), Severity::info),
      ElementsAre("all 3 runs, for example b: " + few, "2 of 3 runs (a, b): skipped 3 rows"));
  EXPECT_THAT(texts(counted_notes(file_, {"sequence=a,metric=ate"}), Severity::info),
              ElementsAre("a: " + few, "a: skipped 3 rows"));
  EXPECT_TRUE(texts(counted_notes(file_), Severity::decisive).empty());
}

TEST_F(StoredNotesTest, TheStagesOfAMethodAreColumns) {
  run(config("straight, {method: shift, by: 1, label: straight + smooth}"));
  const std::vector<CellRow> cells = read_cells(file_);
  EXPECT_EQ(cells[0].parts, (MethodParts{.smoother = "straight"}));
  EXPECT_EQ(cells[1].method, "straight + smooth");
  EXPECT_EQ(cells[1].parts, (MethodParts{.corrector = "shift"}));
}

}  // namespace
}  // namespace loopbench::tiny_store::notes_test
