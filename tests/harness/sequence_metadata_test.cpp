#include <gtest/gtest.h>

#include <fstream>

#include "datasets/core/se3.hpp"
#include "harness/sweep/model/note_text.hpp"
#include "harness/sweep/run/summarise_sequence.hpp"
#include "tests/support/temporary_folder.hpp"

namespace loopbench::sequence_metadata_test {

using namespace harness;

namespace {

TEST(HashedInputs, OneThatASequenceDidWithoutIsKnownWhenItComes) {
  const TemporaryFolder folder;
  const auto image = folder.path() / "depth/0002.png";
  const InputFile missing = hashed_inputs({{image}}).front();
  EXPECT_EQ(missing.path, image.string());
  EXPECT_EQ(missing.bytes, 0u);
  EXPECT_EQ(missing.hash, "missing");
  std::filesystem::create_directories(image.parent_path());
  { std::ofstream empty(image); }
  EXPECT_NE(hashed_inputs({{image}}).front().hash, missing.hash);
  std::ofstream(image) << "pixels";
  const InputFile come = hashed_inputs({{image}}).front();
  EXPECT_EQ(come.bytes, 6u);
  EXPECT_NE(come.hash, missing.hash);
}

TEST(SequenceMetadata, TellOfAReferenceThatFollowsAnotherBody) {
  Sequence sequence;
  Pose pose;
  for (int i = 0; i < 100; ++i) {
    sequence.problem.keyframes.push_back({0.5 * i, pose});
    sequence.reference.push_back({0.5 * i, pose * Pose{Rotation::Identity(), {0.0, 0.5, 0.0}}});
    pose = normalized(
        pose * exp_se3(twist({1.0, 0.3 * (i % 5), 0.0}, {0.1 * (i % 2), 0.1 * (i % 3), 0.2})));
  }
  const std::string found =
      "the reference seems to track another body, with the offset 0.0,0.5,0.0 in the estimate's "
      "body frame (+- "
      "0.0,0.0,0.0 "
      "m): over rotations, the lever arm explains 100 % of the squared differences";
  const auto notes = [&] { return texts(sequence_metadata(sequence, false).notes); };
  EXPECT_EQ(notes(), std::vector<std::string>{found});
  sequence.provenance.body_from_reference = Pose{};  // the dataset supports the option
  EXPECT_EQ(notes(), std::vector<std::string>{found + "; see reference_body of the dataset"});
  sequence.reference = sequence.problem.keyframes;
  EXPECT_EQ(notes(), std::vector<std::string>{"oracle: the estimate equals the reference"});
}

TEST(SequenceMetadata, NotesAnEstimateThatIsTheReference) {
  Sequence sequence;
  for (int i = 0; i < 9; ++i) {  // with ten, equal orientations would count as placeholders
    const Vector3 position(i, 0.1 * i * i, 0.0);
    sequence.problem.keyframes.push_back({0.1 * i, {Rotation::Identity(), 1.001 * position}});
    sequence.reference.push_back({0.1 * i, {Rotation::Identity(), position}});
  }
  const auto notes = [&] { return texts(sequence_metadata(sequence, false).notes); };
  sequence.problem.frames = {sequence.reference.begin() + 2, sequence.reference.end()};
  EXPECT_EQ(notes(), std::vector<std::string>{"oracle: the frames equal the reference"});
  sequence.problem.frames.clear();
  EXPECT_TRUE(notes().empty());
  sequence.problem.keyframes = {sequence.reference[0], sequence.reference[4]};
  EXPECT_EQ(notes(), std::vector<std::string>{"oracle: the estimate equals the reference"});
  sequence.problem.keyframes[1].world_from_body.translation.x() += 1e-9;
  EXPECT_TRUE(notes().empty());
  sequence.problem.keyframes[1] = sequence.reference[4];
  sequence.provenance.noise = "room 1";  // simulated without noise
  EXPECT_TRUE(notes().empty());
}

}  // namespace
}  // namespace loopbench::sequence_metadata_test
