// Files of matrices that are no rows of text: JSON, NumPy, .log, one file for each frame.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstring>

#include "datasets/formats/trajectory_file.hpp"
#include "tests/datasets/scratch.hpp"

namespace loopbench::matrix_files_test {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

constexpr const char* kFirst = "[[0,-1,0,1],[1,0,0,2],[0,0,1,3],[0,0,0,1]]";
constexpr const char* kSecond = "[[1,0,0,4],[0,1,0,5],[0,0,1,6],[0,0,0,1]]";

std::string nerf(const std::string& first, const std::string& second) {
  return R"({"camera_angle_x": 1.0, "frames": [{"file_path": ")" + first +
         R"(", "transform_matrix": )" + kFirst + R"(}, {"file_path": ")" + second +
         R"(", "transform_matrix": )" + kSecond + "}]}";
}

TEST(Json, OfNerfHasTheAxesOfOpenGl) {
  const TemporaryFolder scratch;
  const auto file = scratch.file("transforms.json", nerf("a/r_9.png", "a/r_10.png"));
  ReadFindings findings;
  EXPECT_EQ(detect_format(file), Format::json);
  const Trajectory poses = read_trajectory(file, {.findings = &findings});
  EXPECT_THAT(stamps(poses), ElementsAre(0.0, 0.1));
  EXPECT_TRUE(findings.opengl_axes);
  EXPECT_EQ(findings.unsorted, 0u);
  EXPECT_EQ(poses[0].world_from_body.translation, Vector3(1, 2, 3));
  Matrix3 expected;  // x as it is, y and z in the opposite direction
  expected << 0, 1, 0, 1, 0, 0, 0, 0, -1;
  EXPECT_TRUE(poses[0].world_from_body.rotation.toRotationMatrix().isApprox(expected, 1e-12));
  // Frames are in the order of the numbers of their images.
  const auto reversed = scratch.file("b.json", nerf("a/r_10.png", "a/r_9.png"));
  EXPECT_EQ(read_trajectory(reversed, {.findings = &findings})[0].world_from_body.translation,
            Vector3(4, 5, 6));
  EXPECT_EQ(findings.unsorted, 1u);
}

TEST(Json, ListsOfMatricesTakeTimesOrStateThem) {
  const TemporaryFolder scratch;
  const auto list = scratch.file("a.json", std::string("[") + kFirst + ", " + kSecond + "]");
  const auto times = scratch.file("times.txt", "5.0\n5.5\n");
  EXPECT_TRUE(takes_times(list, Format::json));
  EXPECT_THAT(stamps(read_trajectory(list, {.times = times})), ElementsAre(5.0, 5.5));
  const auto stamped = scratch.file("b.json",
                                    std::string(R"([{"timestamp": 7.5, "pose": )") + kFirst +
                                        R"(}, {"timestamp": 7.0, "pose": )" + kSecond + "}]");
  EXPECT_THAT(stamps(read_trajectory(stamped)), ElementsAre(7.0, 7.5));
  EXPECT_FALSE(takes_times(stamped, Format::json));
  const auto flat = scratch.file("c.json", R"([{"t": 1.0, "x": 0}])");
  EXPECT_THAT(refusal([&] { read_trajectory(flat); }), HasSubstr("jq -r"));
  const auto broken = scratch.file("d.json", "[[1, 2");
  EXPECT_THAT(refusal([&] { read_trajectory(broken); }), HasSubstr("is not valid JSON"));
}

std::string npy(const std::string& shape, const std::vector<double>& values) {
  std::string header = "{'descr': '<f8', 'fortran_order': False, 'shape': " + shape + ", }";
  header.resize(117, ' ');
  header += '\n';
  std::string out = std::string("\x93NUMPY\x01\x00", 8) + static_cast<char>(header.size()) + '\0';
  out += header;
  const std::size_t begin = out.size();
  out.resize(begin + 8 * values.size());
  std::memcpy(out.data() + begin, values.data(), 8 * values.size());
  return out;
}

TEST(Npy, MatricesAndRowsWithQuaternions) {
  const TemporaryFolder scratch;
  const auto matrices =
      scratch.file("a.npy", npy("(1, 4, 4)", {0, -1, 0, 1, 1, 0, 0, 2, 0, 0, 1, 3, 0, 0, 0, 1}));
  EXPECT_EQ(detect_format(matrices), Format::npy);
  const Trajectory poses = read_trajectory(matrices);
  EXPECT_EQ(poses[0].world_from_body.translation, Vector3(1, 2, 3));
  EXPECT_NEAR(poses[0].world_from_body.rotation.z(), std::sqrt(0.5), 1e-12);
  const auto stamped = scratch.file(
      "b.npy", npy("(2, 8)", {0.5, 1, 2, 3, 0, 0, 0.6, 0.8, 0.7, 1, 2, 3, 0, 0, 0, 1}));
  EXPECT_THAT(stamps(read_trajectory(stamped)), ElementsAre(0.5, 0.7));
  const auto rows = scratch.file("c.npy", npy("(1, 7)", {1, 2, 3, 0, 0, 0.6, 0.8}));
  EXPECT_NEAR(read_trajectory(rows)[0].world_from_body.rotation.z(), 0.6, 1e-12);
}

TEST(Npy, OthersAreRejectedWithWhatIsAccepted) {
  const TemporaryFolder scratch;
  const auto why = [&](const std::string& content) {
    return refusal([&] { read_trajectory(scratch.file("a.npy", content)); });
  };
  EXPECT_THAT(why(npy("(1, 5)", {1, 2, 3, 4, 5})),
              HasSubstr("has shape 1 x 5, expected N x 4 x 4"));
  EXPECT_THAT(why(npy("(2, 7)", {1, 2, 3, 4, 5, 6, 7})), HasSubstr("has not the numbers"));
  std::string objects = npy("(1, 7)", {1, 2, 3, 0, 0, 0.6, 0.8});
  objects.replace(objects.find("<f8"), 3, "|O8");
  EXPECT_THAT(why(objects), HasSubstr("no objects"));
  std::string columns = npy("(1, 7)", {1, 2, 3, 0, 0, 0.6, 0.8});
  columns.replace(columns.find("False"), 5, "True ");
  EXPECT_THAT(why(columns), HasSubstr("Fortran order"));
  EXPECT_THAT(why(columns.substr(0, 40)), HasSubstr("ends in its header"));
}

constexpr const char* kLines = "0 -1 0 1\n1 0 0 2\n0 0 1 3\n0 0 0 1\n";

TEST(Log, HasMatricesOverFourLines) {
  const TemporaryFolder scratch;
  const std::string text = std::string("0 0 1\n") + kLines + "1 1 2\n" + kLines;
  const auto file = scratch.file("a.log", text);
  EXPECT_EQ(detect_format(file), Format::log);
  EXPECT_THAT(stamps(read_trajectory(file)), ElementsAre(0.0, 0.1));
  EXPECT_EQ(read_trajectory(scratch.file("b.txt", std::string(kLines) + kLines)).size(), 2u);
  EXPECT_THAT(refusal([&] { read_trajectory(scratch.file("c.log", text + "2 2 3\n0 -1 0 1\n")); }),
              HasSubstr(":12: has a matrix of 1 lines, expected 4"));
}

TEST(Frames, AreReadInTheOrderOfTheirNumbers) {
  const TemporaryFolder scratch;
  const auto folder = scratch.path() / "pose";
  std::filesystem::create_directories(folder);
  const auto write = [&](const std::string& name, const std::string& text) {
    std::filesystem::rename(scratch.file("x", text), folder / name);
  };
  write("2.txt", kLines);
  write("10.txt", "1 0 0 7\n0 1 0 8\n0 0 1 9\n0 0 0 1\n");
  write("3.txt",
        "-inf -inf -inf -inf\n-inf -inf -inf -inf\n-inf -inf -inf -inf\n-inf -inf -inf -inf\n");
  EXPECT_EQ(detect_format(folder), Format::frames);
  EXPECT_THAT(refusal([&] { read_trajectory(folder); }),
              HasSubstr("3.txt:1: has no pose, expected finite numbers and a rotation (--drop"));
  ReadFindings findings;
  const Trajectory poses = read_trajectory(folder, {.drop_invalid = true, .findings = &findings});
  EXPECT_THAT(stamps(poses), ElementsAre(0.2, 1.0));
  EXPECT_EQ(poses[1].world_from_body.translation, Vector3(7, 8, 9));
  EXPECT_THAT(findings.dropped, ElementsAre(1u));
}

}  // namespace
}  // namespace loopbench::matrix_files_test
