// Tests of the complete front end, from images to a problem.
#include "datasets/images/frontend.hpp"

#include "tests/images/recording.hpp"
#include "tests/support/tolerance.hpp"

namespace loopbench::frontend_test {

namespace {

using testing::Contains;
using testing::HasSubstr;

// 0.5 m/s, two seconds forward and two back, at an image width of 160 px: one pixel covers 2 cm.
constexpr double kDrift = 0.1;  // [m]

FrontendOptions quick() {
  FrontendOptions out;
  out.features.count = 300;
  out.track.inliers_min = 15;
  out.loops.inliers_min = 30;
  out.loops.min_gap = 1.0;
  out.refine_depth = false;  // has its own tests and doubles the run time with sanitizers
  return out;
}

/// Rendered room, forward and back: its frames, then the same frames in reverse order, some
/// of them unreadable or black.
class OutAndBack final : public RgbdSource {
 public:
  OutAndBack(std::size_t black_begin, std::size_t black_end)
      : black_begin_(black_begin), black_end_(black_end) {
    for (std::size_t i = 0; i < size(); ++i) {
      reference_.push_back({stamp(i), forward_->reference()[4 * turned(i)].world_from_body});
    }
  }
  Camera camera() const override { return forward_->camera(); }
  std::size_t size() const override { return 2 * forward_->size() - 1; }
  double stamp(std::size_t index) const override { return 0.125 * static_cast<double>(index); }
  std::optional<RgbdFrame> read(std::size_t index, std::string& why) const override {
    std::optional<RgbdFrame> out = forward_->read(turned(index), why);
    if (index >= black_begin_ && index < black_end_) {
      std::ranges::fill(out->grey.pixels, std::uint8_t{0});
    }
    return out;
  }
  const Trajectory& reference() const override { return reference_; }
  Provenance provenance() const override { return {}; }

  Pose truth(const StampedPose& keyframe) const {
    return reference_[static_cast<std::size_t>(std::lround(keyframe.stamp / 0.125))]
        .world_from_body;
  }
  Pose truth(const Problem& problem, const Edge& edge) const {
    return truth(problem.keyframes[edge.from]).inverse() * truth(problem.keyframes[edge.to]);
  }

 private:
  std::size_t turned(std::size_t i) const {
    const std::size_t last = forward_->size() - 1;
    return i <= last ? i : 2 * last - i;
  }
  std::unique_ptr<const RgbdSource> forward_ = rendered_room(small_room(0.04));
  std::size_t black_begin_;
  std::size_t black_end_;
  Trajectory reference_;
};

double largest_error(const Sequence& sequence, const OutAndBack& source) {
  double out = 0.0;
  const Pose reference_from_world = source.reference().front().world_from_body *
                                    sequence.problem.keyframes.front().world_from_body.inverse();
  for (const StampedPose& keyframe : sequence.problem.keyframes) {
    const Pose placed = reference_from_world * keyframe.world_from_body;
    out = std::max(out, (placed.translation - source.truth(keyframe).translation).norm());
  }
  return out;
}

TEST(Frontend, TracksAndClosesTheLoopOfARoomWalkedOutAndBack) {
  const OutAndBack source(0, 0);
  const Sequence sequence = run_frontend(source, "room", quick(), {});
  check(sequence.problem, "room");
  EXPECT_LT(largest_error(sequence, source), kDrift);
  EXPECT_EQ(sequence.problem.keyframes.size() + sequence.problem.frames.size(), source.size());
  EXPECT_EQ(sequence.problem.odometry.size() + 1, sequence.problem.keyframes.size());
  EXPECT_EQ(sequence.problem.shared_landmarks.size(), sequence.problem.odometry.size());
  ASSERT_FALSE(sequence.problem.closures.empty());
  for (const Edge& loop : sequence.problem.closures) {
    EXPECT_POSE_NEAR(loop.from_from_to, source.truth(sequence.problem, loop), 0.1, 0.1);
  }
}

void expect_same(const Sequence& a, const Sequence& b) {
  ASSERT_EQ(a.problem.keyframes.size(), b.problem.keyframes.size());
  for (std::size_t i = 0; i < a.problem.keyframes.size(); ++i) {
    const Pose& p = a.problem.keyframes[i].world_from_body;
    const Pose& q = b.problem.keyframes[i].world_from_body;
    EXPECT_EQ(p.translation, q.translation);
    EXPECT_EQ(p.rotation.coeffs(), q.rotation.coeffs());
  }
  ASSERT_EQ(a.problem.closures.size(), b.problem.closures.size());
  for (std::size_t i = 0; i < a.problem.closures.size(); ++i) {
    EXPECT_EQ(a.problem.closures[i].information, b.problem.closures[i].information);
    EXPECT_EQ(a.problem.closures[i].from_from_to.translation,
              b.problem.closures[i].from_from_to.translation);
  }
  ASSERT_EQ(a.problem.odometry.size(), b.problem.odometry.size());
  for (std::size_t i = 0; i < a.problem.odometry.size(); ++i) {
    EXPECT_EQ(a.problem.odometry[i].information, b.problem.odometry[i].information);
  }
  EXPECT_EQ(a.problem.shared_landmarks, b.problem.shared_landmarks);
  EXPECT_EQ(a.problem.frames.size(), b.problem.frames.size());
  EXPECT_EQ(a.loop_candidates.size(), b.loop_candidates.size());
}

TEST(Frontend, TwoRunsGiveTheSameBits) {
  const OutAndBack source(0, 0);
  FrontendOptions options = quick();
  options.refine_depth = true;
  const Sequence first = run_frontend(source, "room", options, {});
  expect_same(first, run_frontend(source, "room", options, {}));
}

double mean_step_error(const Sequence& sequence, const OutAndBack& source) {
  double out = 0.0;
  for (const Edge& edge : sequence.problem.odometry) {
    const Pose step = source.truth(sequence.problem, edge);
    out += (edge.from_from_to.translation - step.translation).norm();
  }
  return out / static_cast<double>(sequence.problem.odometry.size());
}

TEST(Frontend, DepthMakesStepsBetter) {
  const OutAndBack source(0, 0);
  FrontendOptions options = quick();
  options.loops.enabled = false;
  const Sequence before = run_frontend(source, "room", options, {});
  options.refine_depth = true;
  const Sequence after = run_frontend(source, "room", options, {});
  check(after.problem, "room");
  ASSERT_EQ(after.problem.keyframes.size(), before.problem.keyframes.size());
  EXPECT_LT(mean_step_error(after, source), 0.8 * mean_step_error(before, source));
  EXPECT_THAT(after.provenance.notes, Contains(HasSubstr("measured again by depth: ")));
}

TEST(Frontend, SaysWhereTrackingWasLostAndRecovered) {
  const OutAndBack source(14, 17);  // dark at the turning point: frame 17 shows the same as 13
  const Sequence sequence = run_frontend(source, "room", quick(), {});
  EXPECT_THAT(
      sequence.provenance.notes,
      Contains(HasSubstr("tracking lost at 1.750 s, recovered at 2.125 s: 3 frames have no pose")));
  EXPECT_EQ(sequence.problem.keyframes.size() + sequence.problem.frames.size() + 3, source.size());
  EXPECT_LT(largest_error(sequence, source), kDrift);
}

TEST(Frontend, BeginsAnewWhenLostForLongAndSaysSo) {
  FrontendOptions options = quick();
  options.track.restart_after = 0.3;
  const OutAndBack source(6, 12);
  const Sequence sequence = run_frontend(source, "room", options, {});
  check(sequence.problem, "room");
  EXPECT_THAT(sequence.provenance.notes, Contains(HasSubstr("the motion in between is assumed")));
}

TEST(Frontend, AsksForAboutSoManyKeyframes) {
  const OutAndBack source(0, 0);
  for (const std::int64_t target : {8, 20}) {
    FrontendOptions options = quick();
    options.loops.enabled = false;
    options.track.keyframes_target = target;
    const Sequence sequence = run_frontend(source, "room", options, {});
    EXPECT_NEAR(static_cast<double>(sequence.problem.keyframes.size()),
                static_cast<double>(target),
                0.35 * static_cast<double>(target));
    EXPECT_TRUE(sequence.problem.closures.empty());
  }
}

TEST(Frontend, SkipsUnreadableFramesAndRefusesTooMany) {
  const auto room = rendered_room(small_room(0.02));
  TemporaryFolder folder;
  write_recording(folder, *room);
  std::filesystem::remove(folder.path() / "depth/0003.png");
  const auto source = open_rgbd_folder(folder.path(), {});
  const Sequence sequence = run_frontend(*source, "folder", quick(), {});
  ASSERT_GE(sequence.provenance.notes.size(), 2u);
  EXPECT_THAT(sequence.provenance.notes[0], HasSubstr("depth/0003.png: no such image"));
  EXPECT_EQ(sequence.provenance.notes[1], fmt::format("1 of {} frames skipped", room->size()));
  std::filesystem::remove_all(folder.path() / "rgb");
  EXPECT_THAT(refusal_of([&] { run_frontend(*source, "folder", quick(), {}); }),
              HasSubstr("cannot be read, expected at most skipped_max = 0.5"));
}

TEST(Frontend, RefusesWhatCannotBeTracked) {
  const OutAndBack source(0, 1000);  // all frames black
  EXPECT_THAT(refusal_of([&] { run_frontend(source, "night", quick(), {}); }),
              HasSubstr("night: tracked fewer than 2 keyframes"));
}

TEST(Frontend, OtherFeaturesTrackToo) {
  const OutAndBack source(0, 0);
  for (const FeatureKind kind : {FeatureKind::akaze, FeatureKind::sift}) {
    FrontendOptions options = quick();
    options.features.kind = kind;
    options.loops.enabled = false;
    const Sequence sequence = run_frontend(source, "room", options, {});
    EXPECT_LT(largest_error(sequence, source), kDrift) << to_text(kind);
  }
}

}  // namespace
}  // namespace loopbench::frontend_test
