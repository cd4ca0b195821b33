
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <set>

#include "harness/sweep/catalogue/catalogue.hpp"
#include "harness/sweep/catalogue/load_sequence.hpp"
#include "harness/sweep/config/read_sweep.hpp"
#include "harness/sweep/run/cell_keys.hpp"
#include "harness/sweep/run/summarise_sequence.hpp"
#include "tests/support/temporary_folder.hpp"

namespace loopbench::sequence_identity_test {

using namespace harness;

namespace {

using testing::HasSubstr;
using testing::Not;
using testing::StartsWith;

/// The sequences of a sweep over these datasets, with files of the folder.
class Identity : public testing::Test {
 protected:
  void read(const std::string& datasets) {
    sweep_ = parse_sweep("datasets:\n" + datasets + "methods: [raw]\nmetrics: [ate]\nrepeats: 3\n",
                         folder_.path() / "c.yaml",
                         known_);
  }
  SequenceMetadata metadata(std::size_t dataset, int repeat = 0) const {
    const Cell cell{0, dataset, 0, repeat};
    return metadata_of(load_sequence(cell, sweep_, known_, {{folder_.path()}}), cell, sweep_);
  }
  std::string group(std::size_t dataset, int repeat = 0) const {
    return metadata(dataset, repeat).group;
  }

  TemporaryFolder folder_;
  Catalogue known_ = catalogue({});
  Sweep sweep_;
};
using SequenceContent = Identity;
using Group = Identity;
using OracleClosures = Identity;

std::string walk(double scale) {
  std::string out;
  for (int i = 0; i <= 20; ++i) {
    out += std::to_string(i) + " " + std::to_string(scale * std::abs(i - 10)) + " " +
           std::to_string(0.1 * i) + (i == 0 ? " 0 0 0 0.6 0.8\n" : " 0 0 0 0 1\n");
  }
  return out;
}

TEST_F(SequenceContent, IsEqualWhereNothingRandomActs) {
  read(
      "  - {dataset: simulated, label: silent, noise.gain: 0, closures.sigma_t: 0, "
      "closures.sigma_r: 0}\n"
      "  - {dataset: simulated, label: noisy}\n");
  const auto content = [&](std::size_t dataset, int repeat) {
    return metadata(dataset, repeat).content;
  };
  EXPECT_EQ(content(0, 0), content(0, 1));
  EXPECT_EQ(content(1, 0), content(1, 0));
  EXPECT_NE(content(1, 0), content(1, 1));
  EXPECT_NE(content(0, 0), content(1, 0));
  EXPECT_EQ(content(0, 0).size(), 32u);
}

TEST_F(SequenceContent, DependsOnEveryPart) {
  Sequence base;
  for (int i = 0; i < 3; ++i) base.problem.keyframes.push_back({double(i), {}});
  base.problem.odometry = {{0, 1, {}}, {1, 2, {}}};
  base.problem.closures = {{0, 2, {}}};
  base.problem.frames = {{0.5, {}}};
  base.reference = base.problem.keyframes;
  std::vector<Sequence> all(12, base);
  all[1].problem.keyframes[1].world_from_body.translation.x() = 1e-300;
  all[2].problem.odometry[0].information(5, 5) = 2.0;
  all[3].problem.closures[0].from_from_to.rotation = Rotation(0.0, 1.0, 0.0, 0.0);
  all[4].problem.closures[0].scale = 1.1;
  all[5].problem.frames.clear();
  all[6].problem.planar = true;
  all[7].problem.shared_landmarks = {3, 3};
  all[8].reference[2].stamp = 2.5;
  std::swap(all[9].problem.odometry, all[9].problem.closures);
  all[10].problem.anchors = {{1, Vector3::Zero()}};
  all[11].problem.anchors = {{1, Vector3::UnitX()}};
  std::set<std::string> contents;
  for (const Sequence& sequence : all) contents.insert(content_of(sequence));
  EXPECT_EQ(contents.size(), all.size());
  base.name = base.provenance.licence = "free text";
  EXPECT_EQ(content_of(base), content_of(all[0]));
}

TEST_F(SequenceContent, OfALongSequenceIsStable) {
  Sequence sequence;
  for (int i = 0; i < 40000; ++i) sequence.reference.push_back({double(i), {}});
  const std::string first = content_of(sequence);
  EXPECT_EQ(content_of(sequence), first);
  sequence.reference.front().stamp = -1.0;
  EXPECT_NE(content_of(sequence), first);
}

// Baselines of 1.0 do not know options of views.
TEST_F(Identity, HasOptionsOfViewsWhereTheyHaveAnEffect) {
  const std::string common =
      "  - {dataset: trajectory, estimate: est.txt, reference: gt.txt, label: ";
  read(common + "a, closures: {source: reference}}\n" + common +
       "b, closures: {source: reference, rule: view}}\n" + common +
       "c, closures: {source: reference, rule: view, view: {farthest: 9}}}\n");
  CellKeys keys(sweep_, known_, {}, "build");
  const auto text = [&](std::size_t dataset) { return keys.dataset_text({0, dataset, 0, 0}); };
  EXPECT_THAT(text(0), HasSubstr("closures.radius=0.5, closures.scale=same"));
  EXPECT_THAT(text(0), Not(HasSubstr("closures.rule")));
  EXPECT_THAT(text(1), HasSubstr("closures.rule=view"));
  EXPECT_THAT(text(1), HasSubstr("closures.view.farthest=4.0"));
  std::set<std::string> hashes;
  for (const std::size_t dataset : {0u, 1u, 2u}) {
    hashes.insert(keys.configuration_hash({0, dataset, 0, 0}));
  }
  EXPECT_EQ(hashes.size(), 3u);
}

TEST_F(Group, IsTheShapeOfTheReferenceInAnyFile) {
  std::string kitti;
  for (int i = 0; i <= 20; ++i) {
    const std::string x = std::to_string(1.0 / 3.0 * std::abs(i - 10));
    const std::string z = std::to_string(0.1 * i);
    kitti += "1 0 0 " + x + " 0 1 0 " + z + " 0 0 1 0\n";
  }
  folder_.file("est.txt", walk(1.01));
  folder_.file("gt.txt", walk(1.0 / 3.0));
  folder_.file("remark.txt", "# another line\n" + walk(1.0 / 3.0));
  folder_.file("gt.kitti", kitti);
  const std::string common = "  - {dataset: trajectory, estimate: est.txt, ";
  read(common + "label: tum, reference: gt.txt}\n" + common +
       "label: remark, reference: remark.txt}\n" + common +
       "label: turned, reference: gt.txt, reference_body.y: 0.7, "
       "reference_body.qz: 0.6, reference_body.qw: 0.8}\n" +
       "  - {dataset: trajectory, label: kitti, estimate: gt.kitti, "
       "reference: gt.kitti}\n");
  EXPECT_THAT(group(0), StartsWith("reference:"));
  for (const std::size_t other : {1u, 2u, 3u}) EXPECT_EQ(group(0), group(other)) << other;
}

TEST_F(Group, IsTheReferenceOfMeasuredData) {
  folder_.file("a.txt", walk(1.01));
  folder_.file("b.txt", walk(1.02));
  folder_.file("gt.txt", walk(1.0));
  folder_.file("copy/gt.txt", walk(1.0));
  folder_.file("other.txt", walk(1.1));
  read(
      "  - {dataset: trajectory, label: a, estimate: a.txt, reference: gt.txt}\n"
      "  - {dataset: trajectory, label: b, estimate: b.txt, reference: copy/gt.txt, "
      "reference_body.x: 0.3, closures: {source: reference}}\n"
      "  - {dataset: trajectory, label: other, estimate: a.txt, reference: other.txt}\n"
      "  - {dataset: trajectory, label: none, estimate: a.txt}\n"
      "  - {dataset: trajectory, label: named, estimate: a.txt, reference: other.txt, group: x}\n");
  EXPECT_THAT(group(0), StartsWith("reference:"));
  EXPECT_EQ(group(0), group(1));     // another odometer on the same recording
  EXPECT_EQ(group(1), group(1, 2));  // other noise on its closures
  EXPECT_NE(group(0), group(2));
  EXPECT_THAT(group(3), StartsWith("estimate:"));
  EXPECT_EQ(group(4), "group:x");
  EXPECT_EQ(metadata(4).source, group(2));
}

TEST_F(Group, IsTheNoiseOfSimulatedData) {
  read(
      "  - {dataset: simulated, label: room}\n"
      "  - {dataset: simulated, label: loud, noise.gain: 2}\n"
      "  - {dataset: simulated, label: s1, stream: s}\n"
      "  - {dataset: simulated, label: s2, stream: s, noise.gain: 2}\n"
      "  - {dataset: simulated, label: named, group: room}\n");
  EXPECT_THAT(group(0), StartsWith("noise:"));
  EXPECT_NE(group(0), group(0, 1));  // every seed is a separate observation
  EXPECT_NE(group(0), group(1));
  EXPECT_EQ(group(2, 1), group(3, 1));  // common random numbers: one paired observation
  EXPECT_NE(group(2, 0), group(2, 1));
  EXPECT_EQ(group(4, 0), group(4, 1));
}

TEST_F(OracleClosures, AreThoseThatTheDatasetDeclares) {
  folder_.file("est.txt", walk(1.01));
  folder_.file("gt.txt", walk(1.0));
  folder_.file("copy.txt", "# a copy\n" + walk(1.0));
  folder_.file("exact.txt", "1 19 0 1.8 0 0 0 0 1\n");
  const std::string common =
      "  - {dataset: trajectory, estimate: est.txt, reference: gt.txt, reference_body.x: 0.5, ";
  read(common + "label: file, closures: {source: file, file: exact.txt}}\n" + common +
       "label: run, closures: {source: estimate, file: copy.txt}}\n" + common +
       "label: reference, closures: {source: reference}}\n" + common +
       "label: other, closures: {source: estimate, file: est.txt}}\n");
  EXPECT_FALSE(metadata(0).oracle_closures);
  EXPECT_TRUE(metadata(1).oracle_closures);
  EXPECT_THAT(metadata(1).closures, HasSubstr("which is the reference"));
  EXPECT_FALSE(metadata(3).oracle_closures);
  EXPECT_TRUE(metadata(2).oracle_closures);
}

}  // namespace
}  // namespace loopbench::sequence_identity_test
