/// Failures are assigned to the affected cell or score.
#include <cmath>
#include <limits>

#include "tests/support/tiny_store.hpp"

namespace loopbench::run_failures_test {

using namespace methods;
using namespace metrics;
using namespace harness;

namespace {

using namespace tiny_store;  // NOLINT: the fixture

/// A polyline that is not finite around `bad` [s].
struct Gappy final : Curve {
  Gappy(Trajectory poses, double when) : line(std::move(poses)), bad(when) {}
  double start() const override { return line.start(); }
  double end() const override { return line.end(); }
  using Curve::sample;
  void sample(std::span<const double> times, std::span<Pose> poses) const override {
    line.sample(times, poses);
    for (std::size_t i = 0; i < times.size(); ++i) {
      if (std::abs(times[i] - bad) < 0.01) poses[i].translation.x() = std::nan("");
    }
  }
  Polyline line;
  double bad;
};

struct GappySmoother final : Smoother {
  struct Options {
    double bad = 1.0;
  };
  explicit GappySmoother(const Options& o) : options(o) {}
  std::unique_ptr<const Curve> smooth(const Problem& problem, Report&) const override {
    return std::make_unique<Gappy>(problem.keyframes, options.bad);
  }
  Options options;
};
template <class Visit>
void fields(GappySmoother::Options& o, Visit visit) {
  visit("bad", o.bad, "time without a finite pose [s]");
}

/// A polyline with a section whose end is not a number.
struct BadSection final : Smoother {
  struct Options {};
  explicit BadSection(const Options&) {}
  std::unique_ptr<const Curve> smooth(const Problem& problem, Report& report) const override {
    report.sections = {{"window", 0.0, 1.0, ""}, {"window", 1.0, std::nan(""), ""}};
    return std::make_unique<Polyline>(problem.keyframes);
  }
};
template <class Visit>
void fields(BadSection::Options&, Visit) {}

class RunFailures : public TinyStore {
 protected:
  RunFailures() {
    known_.methods.push_back(method<BadSection>("bad_section", "reports a section without end"));
    known_.methods.push_back(method<GappySmoother>("gappy", "is not finite at one time"));
    known_.datasets[0].load = [](const Params& given, const DataRoot& root) {
      Sequence out = tiny::load_line(with(tiny::LineOptions{}, given), root);
      out.reference.insert(out.reference.begin() + 1, {0.5, Pose{}});
      return out;
    };
  }
  /// Records of the method beside `straight` on one sequence.
  std::vector<Record> records_of(const std::string& method, const std::string& more = "") {
    run("datasets: [line]\nprotocol: {base: loopbench, align: none}\nmethods: [straight, " +
        method + "]\n" + (more.empty() ? "metrics: [ate]\n" : more));
    std::vector<Record> records = read_records(file_);
    std::erase_if(records, [](const Record& r) { return r.cell->method == "straight"; });
    return records;
  }
};

TEST_F(RunFailures, OutputThatIsNotFiniteFailsItsCellAndNotTheSweep) {
  const std::string between = "{method: gappy, bad: 0.5}";
  for (const auto& [method, why] :
       {std::pair<std::string, std::string>{"{method: gappy, bad: 3.0}",
                                            "the curve at 3.0 s: the position is not finite"},
        {between, "the curve at 0.5 s: the position is not finite"},
        {"bad_section", "section 2 ('window') is from 1.0 to nan s, expected finite stamps"}}) {
    const std::vector<Record> records = records_of(method);
    ASSERT_EQ(records.size(), 1u) << method;
    EXPECT_EQ(records[0].status, Status::failed) << method;
    EXPECT_EQ(records[0].kind->metric, "");
    EXPECT_EQ(records[0].why, why);
  }
  const std::vector<Record> unseen = records_of(between, "metrics: [ate]\ntimes: keyframes\n");
  ASSERT_EQ(unseen.size(), 1u);
  EXPECT_EQ(unseen[0].status, Status::ok) << "nobody looks between";
}

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
}  // namespace loopbench::run_failures_test
