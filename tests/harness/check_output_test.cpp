/// Results of methods are checked before they are evaluated: what breaks a rule fails its own cell.
#include "harness/sweep/run/check_output.hpp"

#include <cmath>
#include <functional>
#include <limits>
#include <map>

#include "tests/support/refusal_of.hpp"
#include "tests/support/tiny_store.hpp"

namespace loopbench::tiny_store::check_output_test {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

using Correct = std::function<void(Trajectory&, Report&)>;

struct Corrected final : Corrector {
  explicit Corrected(Correct function) : change(std::move(function)) {}
  Trajectory correct(const Problem& problem, Report& report) const override {
    Trajectory out = problem.keyframes;
    change(out, report);
    return out;
  }
  Correct change;
};

/// A polyline whose poses, start and end a function changes.
struct Changed final : Curve {
  using Sampled = std::function<void(std::span<const double>, std::span<Pose>)>;
  Changed(Trajectory poses, Sampled function)
      : line(std::move(poses)), change(std::move(function)) {}
  double start() const override { return first.value_or(line.start()); }
  double end() const override { return last.value_or(line.end()); }
  using Curve::sample;
  void sample(std::span<const double> times, std::span<Pose> poses) const override {
    if (fills) line.sample(times, poses);
    change(times, poses);
  }
  Polyline line;
  Sampled change;
  std::optional<double> first, last;
  bool fills = true;
};

using Smooth = std::function<std::unique_ptr<Changed>(const Problem&)>;

struct Smoothed final : Smoother {
  explicit Smoothed(Smooth function) : make(std::move(function)) {}
  std::unique_ptr<const Curve> smooth(const Problem& problem, Report&) const override {
    return make(problem);
  }
  Smooth make;
};

class CheckOutput : public TinyStore {
 protected:
  /// The reason stored for a method that is made by `make`; empty if its cell is ok.
  std::string why_failed(Kind kind, const std::function<Stage()>& make) {
    std::erase_if(known_.methods, [](const MethodEntry& each) { return each.name == "bad"; });
    known_.methods.push_back(
        {"bad", kind, "breaks a rule", {}, [=](const Params&) { return make(); }});
    std::filesystem::remove(file_);
    run("datasets: [line]\nprotocol: {base: loopbench, align: none}\nmethods: [straight, bad]\n"
        "metrics: [ate]\ntiming: 2\n");
    const std::vector<CellRow> cells = read_cells(file_);
    EXPECT_EQ(cells.size(), 2u);
    EXPECT_EQ(cells.at(0).status, Status::ok);
    EXPECT_EQ(cells.at(1).status, cells.at(1).why.empty() ? Status::ok : Status::failed);
    return cells.at(1).why;
  }
  std::string why(const Correct& change) {
    return why_failed(Kind::corrector,
                      [=] { return Stage(std::make_unique<const Corrected>(change)); });
  }
  std::string why_smoothed(const Smooth& make) {
    return why_failed(Kind::smoother,
                      [=] { return Stage(std::make_unique<const Smoothed>(make)); });
  }
};

TEST_F(CheckOutput, BadPosesNotesAndExceptionsOfACorrectorFailTheCell) {
  struct Silent : std::exception {
    const char* what() const noexcept override { return nullptr; }
  };
  const std::pair<Correct, std::string> cases[] = {
      {[](Trajectory& poses, Report&) {
         for (StampedPose& p : poses) p.world_from_body.rotation.coeffs() *= 5.0;
       },
       "corrected keyframe 1 of 4, at 0.0 s: the quaternion has norm 5.0, expected 1 within "
       "1e-6 (4 such poses)"},
      {[](Trajectory& poses, Report&) {  // rounding
         poses[0].world_from_body.rotation.coeffs() *= 1.0 + 9e-7;
       },
       ""},
      {[](Trajectory& poses, Report&) {
         for (StampedPose& p : poses) p.world_from_body.rotation.coeffs().setConstant(kNan);
       },
       "corrected keyframe 1 of 4, at 0.0 s: the rotation is not finite (4 such poses)"},
      {[](Trajectory& poses, Report&) { poses[2].world_from_body.translation.y() = kNan; },
       "corrected keyframe 3 of 4, at 2.0 s: the position is not finite"},
      {[](Trajectory& poses, Report&) { poses[3].world_from_body.translation.x() = -1e200; },
       "corrected keyframe 4 of 4, at 3.0 s: the position is beyond 1e12 m"},
      {[](Trajectory& poses, Report&) { poses.pop_back(); },
       "the corrector returned 3 poses, expected 4, one per keyframe"},
      {[](Trajectory& poses, Report&) { poses[1].stamp = kNan; },
       "the corrector changed the stamp of keyframe 2 from 1.0 to nan s"},
      {[](Trajectory&, Report& report) {
         report.notes = {"größer", "red \x1b[31m"};
       },
       "note 2 has byte 0x1b at position 5, expected UTF-8 without control characters"},
      {[](Trajectory&, Report&) { throw Silent(); }, "threw an exception without a message"},
      {[](Trajectory&, Report&) { throw std::runtime_error(""); },
       "threw an exception without a message"}};
  for (const auto& [change, expected] : cases) EXPECT_EQ(why(change), expected);
}

TEST_F(CheckOutput, BadCurvesOfASmootherFailTheCell) {
  const auto changed = [](auto change) {
    return [=](const Problem& problem) {
      auto out = std::make_unique<Changed>(problem.keyframes, [](auto, auto) {});
      change(*out);
      return out;
    };
  };
  const auto scaled = [&](double factor, int from_call) {
    return changed([=](Changed& curve) {
      const auto calls = std::make_shared<int>(0);
      curve.change = [=](auto, auto poses) {
        if (++*calls < from_call) return;
        for (Pose& p : poses) p.rotation.coeffs() *= factor;
      };
    });
  };
  const std::pair<Smooth, std::string> cases[] = {
      {changed([](Changed& curve) { curve.last = 2.5; }),
       "the curve spans 0.0 to 2.5 s, expected the span of the keyframes, 0.0 to 3.0 s"},
      {changed([](Changed& curve) { curve.first = kNan; }),
       "the curve spans nan to 3.0 s, expected the span of the keyframes, 0.0 to 3.0 s"},
      {changed([](Changed& curve) { curve.fills = false; }),
       "the curve at 0.0 s: the position is not finite"},
      {[](const Problem&) { return nullptr; }, "the method returned no curve"},
      {scaled(5.0, 6),  // every sample is checked
       "the curve at 0.0 s: the quaternion has norm 5.0, expected 1 within 1e-6"}};
  for (const auto& [make, expected] : cases) EXPECT_EQ(why_smoothed(make), expected);
  EXPECT_EQ(why_smoothed(scaled(1.0 + 2e-6, 1)).substr(0, 47),
            "the curve at 0.0 s: the quaternion has norm 1.0");
}

TEST_F(CheckOutput, EveryPartOfAReportIsChecked) {
  const std::string utf8 = ", expected UTF-8 without control characters";
  const auto reason = [](const Report& report) {
    return refusal_of<std::runtime_error>([&] { check_report(report); });
  };
  Report report;
  report.sections = {{"segment", 0.0, 0.0, "cubic"}};
  report.notes = {std::string(kLongestNote, 'x')};
  report.phases = {{"solve", 0.0}};
  report.counts = {{"iterations", -1.0}};
  EXPECT_EQ(reason(report), "");

  report.sections.push_back({"seg\xff", 0.0, 1.0, ""});
  EXPECT_EQ(reason(report), "section 2 ('seg\\xff') has byte 0xff at position 4" + utf8);
  report.sections[1] = {"segment", 0.0, 1.0, std::string(kLongestName + 1, 'x')};
  EXPECT_EQ(reason(report),
            "the text of section 2 ('segment') has 201 bytes, expected at most 200");
  report.sections[1] = {"segment", 1.0, 0.5, ""};
  EXPECT_EQ(reason(report),
            "section 2 ('segment') is from 1.0 to 0.5 s, expected an end after its begin");
  report.sections.resize(kMostSections + 1);
  EXPECT_EQ(reason(report), "the method reports 100001 sections, expected at most 100000");
  report.sections.clear();
  report.notes[0] += 'x';
  EXPECT_EQ(reason(report), "note 1 has 2001 bytes, expected at most 2000");
  report.notes.assign(kMostItems + 1, "");
  EXPECT_EQ(reason(report), "the method reports 1001 notes, expected at most 1000");
  report.notes.clear();
  report.counts[0].value = kNan;
  EXPECT_EQ(reason(report), "count 'iterations' is nan, expected a finite number");
  report.counts[0].name = "a\nb";
  EXPECT_EQ(reason(report), "count 'a\nb' has byte 0x0a at position 2" + utf8);
  report.counts.clear();
  report.phases[0].seconds = -1.0;
  EXPECT_EQ(reason(report), "phase 'solve' takes -1 s, expected a finite time >= 0");
}

TEST_F(CheckOutput, ALongExceptionTextIsCutOnceWhereItEnters) {
  const std::string stored = why([](Trajectory&, Report&) {
    std::string text;
    text.resize(50'000'000, '\xff');
    throw std::runtime_error(text);
  });
  EXPECT_EQ(stored.size(), kLongestNote + std::string(" ... (49998000 more bytes)").size());
  EXPECT_TRUE(stored.starts_with("\\xff\\xff")) << stored.substr(0, 40);
  EXPECT_TRUE(stored.ends_with(" ... (49998000 more bytes)"));
}

struct NoOptions {};
template <class Visit>
void fields(NoOptions&, Visit) {}

TEST_F(CheckOutput, AScoreWithoutADirectionOrTargetFailsAndItsCellIsStored) {
  const auto add_metric = [&](const char* name, const Score& score) {
    known_.metrics.push_back(metric<NoOptions>(
        name, "", [=](const Evaluation&, const NoOptions&) { return std::vector{score}; }));
  };
  Score score = single("x", "", "1", 1.0);
  add_metric("no_target", directed(score, Better::target, kNan));
  add_metric("no_direction", directed(score, static_cast<Better>(77)));
  run("datasets: [line]\nmethods: [straight]\nmetrics: [no_target, no_direction, ate]\n");
  std::map<std::string, std::string> why;
  for (const Record& record : read_records(file_)) why[record.kind->metric] = record.why;
  EXPECT_EQ(why["no_target"], "score 1 has the target nan, expected a finite number");
  EXPECT_EQ(why["no_direction"],
            "score 1 has no direction: better is 77, expected lower, higher, target or neither");
  EXPECT_EQ(why.at("ate"), "");
}

TEST_F(CheckOutput, ACountOrNameThatCannotBeFailsOnce) {
  Score score = single("x", "", "1", 1.0);
  known_.metrics.push_back(metric<NoOptions>("twins", "", [=](const Evaluation&, const NoOptions&) {
    return std::vector{score, score};
  }));
  score.statistics.count = static_cast<std::size_t>(-1);
  known_.metrics.push_back(metric<NoOptions>(
      "negative", "", [=](const Evaluation&, const NoOptions&) { return std::vector{score}; }));
  known_.metrics.push_back(metric<NoOptions>(
      "silent", "", [](const Evaluation&, const NoOptions&) { return std::vector<Score>(); }));
  run("datasets: [line]\nmethods: [straight]\nmetrics: [twins, negative, silent, ate]\ntimes: "
      "dense\n");
  std::map<std::string, std::vector<std::string>> why;
  for (const Record& record : read_records(file_)) why[record.kind->metric].push_back(record.why);
  EXPECT_EQ(why["twins"], std::vector<std::string>{"two scores are named 'x'"});
  EXPECT_EQ(why["negative"],
            std::vector<std::string>{
                "score 1 is over 18446744073709551615 errors, expected at most 1000000000000"});
  EXPECT_EQ(why["silent"],
            std::vector<std::string>{"the metric returned 0 scores, expected 1 to 1000"});
  EXPECT_EQ(why["ate"].front(), "");
}

TEST(StoredReason, IsOneLineAndKeepsWholeCharacters) {
  EXPECT_EQ(stored_reason("two\nlines \x1b"), "two lines \\x1b");
  std::string umlauts;
  while (umlauts.size() < kLongestNote - 1) umlauts += "ü";
  const std::string cut = stored_reason("x" + umlauts + "ü");  // its last 'ü' is cut in two
  EXPECT_LE(cut.size(), kLongestNote + 30);
  EXPECT_EQ(cut.find("\\xc3\xbc"), std::string::npos);
}

TEST(CheckRejected, ClosuresAreAscendingIndices) {
  EXPECT_NO_THROW(check_rejected(std::nullopt, 0));
  EXPECT_NO_THROW(check_rejected({{0, 2}}, 3));
  const auto why = [](const std::vector<std::size_t>& rejected) {
    return refusal_of<std::runtime_error>([&] { check_rejected(rejected, 3); });
  };
  EXPECT_EQ(why({0, 3}), "the method rejects closure 3, expected ascending indices of 3 closures");
  EXPECT_EQ(why({1, 0}), "the method rejects closure 0, expected ascending indices of 3 closures");
  EXPECT_EQ(why({1, 1}), "the method rejects closure 1, expected ascending indices of 3 closures");
}

}  // namespace
}  // namespace loopbench::tiny_store::check_output_test
