/// Failures are assigned to the affected cell or score.
#include <limits>

#include "tests/support/tiny_store.hpp"

namespace loopbench::tiny_store::run_failures_test {
namespace {

class RunFailures : public TinyStore {
 protected:
  /// Records of the method beside `straight` on one sequence.
  std::vector<Record> records_of(const std::string& method, const std::string& more = "") {
    run("datasets: [line]\nprotocol: {base: loopbench, align: none}\nmethods: [straight, " +
        method + "]\n" + (more.empty() ? "metrics: [ate]\n" : more));
    std::vector<Record> records = read_records(file_);
    std::erase_if(records, [](const Record& r) { return r.cell->method == "straight"; });
    return records;
  }
};

TEST_F(RunFailures, AFailedMetricFailsTheScoresThatItGivesElsewhereAndNoOther) {
  known_.metrics[0].score = [](const Evaluation& evaluation, const Params&) {
    if (evaluation.context.estimate->back().world_from_body.translation.z() > 0.0) {
      throw std::runtime_error("lost its way");
    }
    return std::vector<Score>{single("translation", "3d", "m", 1.0),
                              directed(single("share", "x", "%", 2.0), Better::higher)};
  };
  known_.metrics.push_back(
      metric<tiny::LengthOptions>("coverage", "", [](const Evaluation&, const auto&) {
        return std::vector<Score>{single("share", "", "1", 1.0)};
      }));
  const std::vector<Record> records =
      records_of("shift", "metrics: [ate, {metric: coverage, label: other}]\n");
  ASSERT_EQ(records.size(), 6u);  // at keyframes, then densely
  for (std::size_t i = 0; i < records.size(); ++i) {
    const Record& r = records[i];
    EXPECT_EQ(r.status, i % 3 == 2 ? Status::ok : Status::failed) << i;
    EXPECT_EQ(r.kind->label, i % 3 == 2 ? "other" : "ate");
    EXPECT_EQ(r.kind->times, i < 3 ? "keyframes" : "dense");
    if (i % 3 == 2) continue;
    EXPECT_EQ(r.why, "lost its way");
    EXPECT_EQ(field(r, "score"), i % 3 == 0 ? "ate" : "ate share x");
    EXPECT_EQ(r.kind->unit, i % 3 == 0 ? "m" : "%");
    EXPECT_EQ(r.kind->better, i % 3 == 0 ? Better::lower : Better::higher);
  }
}

TEST_F(RunFailures, AScoreThatIsNotFiniteFailsAlone) {
  known_.metrics[0].score = [](const Evaluation&, const Params&) {
    Score infinite = single("translation", "3d", "m", 1.0);
    infinite.statistics.max = std::numeric_limits<double>::infinity();
    return std::vector<Score>{infinite, single("rotation", "3d", "deg", 2.0)};
  };
  for (const Record& r : records_of("shift")) {
    EXPECT_EQ(r.status, r.kind->relation == "translation" ? Status::failed : Status::ok);
    EXPECT_EQ(r.why, r.kind->relation == "translation" ? "is not finite" : "");
  }
}

TEST_F(RunFailures, WithoutAReferenceAFailedScoreKeepsItsOwnReason) {
  known_.datasets[0].load = [](const Params& given, const DataRoot& root) {
    Sequence out = tiny::load_line(with(tiny::LineOptions{}, given), root);
    out.reference.clear();
    return out;
  };
  known_.metrics.push_back(metric_without_reference<tiny::LengthOptions>(
      "cost", "", [](const Evaluation&, const auto&) -> std::vector<Score> {
        throw Undefined("an edge changes the scale");
      }));
  const std::vector<Record> records = records_of("shift", "metrics: [cost]\n");
  ASSERT_FALSE(records.empty());
  EXPECT_NE(records[0].status, Status::ok);
  EXPECT_EQ(records[0].why, "an edge changes the scale");
}

TEST_F(RunFailures, ACellKnowsHowManyOfItsScoresFailedInAnyWay) {
  known_.metrics[0].score = [](const Evaluation&, const Params&) -> std::vector<Score> {
    throw std::bad_alloc();
  };
  records_of("shift");
  EXPECT_EQ(run("datasets: [line]\nprotocol: {base: loopbench, align: none}\nmethods: [straight, "
                "shift]\nmetrics: [ate]\n")
                .resumed.failed,
            2u);
}

}  // namespace
}  // namespace loopbench::tiny_store::run_failures_test
