/// Files large enough to be read by several threads give the same results and errors as small ones.
#include "datasets/columns/parts.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "datasets/formats/formats.hpp"
#include "datasets/formats/g2o.hpp"
#include "tests/datasets/scratch.hpp"

namespace loopbench::parts_test {
namespace {

constexpr int kRows = 100'000;

/// `kRows` rows, 1 s apart, with row `special` replaced; 5 MB, split at arbitrary positions.
std::string tum(int special = -1, const std::string& replacement = "") {
  std::string out = "# stamp tx ty tz qx qy qz qw\n\n";
  for (int i = 0; i < kRows; ++i) {
    out += i == special ? replacement
                        : fmt::format("{}.5 {} 0.12345678901 -{} 0 0 0.6 0.8\n", i, i * 3, i % 77);
  }
  return out;
}

TEST(Parts, ThreadsDoNotMatter) {
  const TemporaryFolder scratch;
  const std::string text = tum();
  ASSERT_GT(text.size(), 3u << 20);
  const Trajectory poses = read_trajectory(scratch.file("a.txt", text));
  ASSERT_EQ(poses.size(), std::size_t{kRows});
  for (int i = 0; i < kRows; ++i) {
    const StampedPose& pose = poses[static_cast<std::size_t>(i)];
    ASSERT_EQ(pose.stamp, i + 0.5);
    ASSERT_EQ(pose.world_from_body.translation, Vector3(i * 3, 0.12345678901, -(i % 77)));
  }
}

TEST(Parts, CutsAreAtLineEndsAndLoseNothing) {
  const TemporaryFolder scratch;
  const std::string text = "# comment\n1\n\n 22\r\n333\n#\n4444\n55555";
  const TextFile file(scratch.file("a.txt", text));
  for (std::size_t count = 1; count <= 40; ++count) {
    std::string lines;
    std::size_t number = 0;
    for (TextFile& part : file.cut(count)) {
      for (Line line; part.next(line);) lines += std::string(line.text) + ";";
      number += part.lines();
    }
    EXPECT_EQ(lines, "1;22;333;4444;55555;") << count;
    EXPECT_EQ(number, 8u) << count;
  }
}

TEST(Parts, ErrorsNameTheLineOfTheWholeFile) {
  const TemporaryFolder scratch;
  for (const int row : {0, 49'999, 60'000, kRows - 1}) {
    const auto file = scratch.file("a.txt", tum(row, "1 2 3\n"));
    EXPECT_EQ(refusal([&] { read_trajectory(file, {.format = Format::tum}); }),
              fmt::format("{}:{}: has 3 columns, expected 8: stamp tx ty tz qx qy qz qw",
                          file.string(),
                          row + 3));
  }
}

TEST(Parts, TheFirstErrorIsTheOneSaid) {
  const TemporaryFolder scratch;
  std::string text = tum(40'000, "x\n");
  text += "y\n";
  const auto file = scratch.file("a.txt", text);
  EXPECT_EQ(refusal([&] { read_trajectory(file); }),
            file.string() + ":40003: column 1 (stamp): 'x' is not a number");
}

TEST(Parts, StampsAreInOrderAcrossACut) {
  const TemporaryFolder scratch;
  const std::string half = tum();
  const auto file = scratch.file("a.txt", half + half);
  EXPECT_EQ(
      refusal([&] { read_trajectory(file); }),
      fmt::format("{}:{}: stamp 0.5 is smaller than stamp {}.5 on line {}, expected increasing "
                  "stamps (--sort, or sort: true in a config)",
                  file.string(),
                  kRows + 5,
                  kRows - 1,
                  kRows + 2));
}

TEST(Parts, ANulByteIsFoundWhereverItIs) {
  const TemporaryFolder scratch;
  std::string text = tum();
  const std::size_t at = text.size() - 100;
  text[at] = '\0';
  const auto file = scratch.file("a.txt", text);
  EXPECT_EQ(refusal([&] { read_trajectory(file); }),
            fmt::format("{}: is binary (NUL at byte {}), expected a text file", file.string(), at));
}

TEST(Parts, ALineMayBeLongerThanTheWindow) {
  const TemporaryFolder scratch;
  const std::string comment = "# " + std::string(1'000'000, 'x') + "\n";
  const std::string blanks(700'000, ' ');
  const auto file = scratch.file(
      "a.txt",
      comment + "1 1 2 3 0 0" + blanks + "0 1\n" + comment + "2 1 2 3 0 0 0 1\n" + comment);
  const Trajectory poses = read_trajectory(file);
  ASSERT_EQ(poses.size(), 2u);
  EXPECT_EQ(poses[0].world_from_body.translation, Vector3(1, 2, 3));
  EXPECT_EQ(poses[1].stamp, 2.0);
}

TEST(Parts, ALineOfMoreThanAMebibyteIsRefused) {
  const TemporaryFolder scratch;
  const std::string line(3'000'000, '1');
  const auto alone = scratch.file("a.txt", line);
  EXPECT_EQ(refusal([&] { read_trajectory(alone); }),
            alone.string() + ":1: has a line of more than 1 MiB, expected poses");
  const auto last = scratch.file("b.txt", "1 1 2 3 0 0 0 1\n" + line);
  EXPECT_EQ(refusal([&] { read_trajectory(last); }),
            last.string() + ":2: has a line of more than 1 MiB, expected poses");
  const auto in_part = scratch.file("c.txt", tum() + line);
  EXPECT_NE(refusal([&] { read_trajectory(in_part); }).find("has a line of more than 1 MiB"),
            std::string::npos);
}

TEST(Parts, PoseGraphsKeepTheirLines) {
  const TemporaryFolder scratch;
  std::string text;
  for (int i = 0; i < kRows; ++i) text += fmt::format("VERTEX_SE2 {} {} 0 0\n", i, i);
  for (int i = 1; i < kRows; ++i)
    text += fmt::format("EDGE_SE2 {} {} 1 0 0 1 0 0 1 0 1\n", i - 1, i);
  const PoseGraph graph = read_g2o(scratch.file("a.g2o", text));
  ASSERT_EQ(graph.vertices.size(), std::size_t{kRows});
  ASSERT_EQ(graph.edges.size(), std::size_t{kRows - 1});
  for (std::size_t i = 0; i < graph.edges.size(); ++i) {
    ASSERT_EQ(graph.edges[i].from, i);
    ASSERT_EQ(graph.edges[i].to, i + 1);
    ASSERT_EQ(graph.lines[i], kRows + i + 1);
    ASSERT_EQ(graph.vertices[i].translation.x(), static_cast<double>(i));
  }
  const auto twice = scratch.file("b.g2o", text + "VERTEX_SE2 7 0 0 0\n");
  EXPECT_EQ(refusal([&] { read_g2o(twice); }),
            fmt::format("{}:{}: vertex 7 is already defined on line 8", twice.string(), 2 * kRows));
}

}  // namespace
}  // namespace loopbench::parts_test
