/// Merging of stores, and stores that cannot be merged.
#include "harness/sweep/store/merge.hpp"

#include "harness/sweep/catalogue/load_sequence.hpp"
#include "tests/support/tiny_store.hpp"

namespace loopbench::tiny_store::merge_test {
namespace {

using MergeTest = TinyStore;

TEST_F(MergeTest, PrefersWhatDidNotFail) {
  const auto fails = [&] {
    const Sweep sweep = parse_sweep(kUsual, "c.yaml", known_);
    CellKeys keys(sweep, known_, root_, build_);
    Store store(file_, keys, {});
    CellResult r;
    r.cell = cells(sweep, seeded(sweep, known_), "").at(1);
    r.status = Status::failed;
    r.why = "not now";
    store.write(r);
  };
  file_ = folder_.path() / "1.sqlite";
  fails();
  file_ = folder_.path() / "2.sqlite";
  run(kUsual, Retry::none, "a / ");
  const std::filesystem::path out = folder_.path() / "3.sqlite";
  merge_stores({folder_.path() / "1.sqlite", file_}, out);
  for (const CellRow& cell : read_cells(out)) EXPECT_EQ(cell.status, Status::ok);
  EXPECT_EQ(read_cells(out).size(), 2u);
}

TEST_F(MergeTest, KeepsTheOptionsOfAllSweeps) {
  file_ = folder_.path() / "1.sqlite";
  run(config("straight"));
  file_ = folder_.path() / "2.sqlite";
  run(config("straight, {method: shift, by: 3, label: far}"), Retry::none, " / far");
  const std::filesystem::path out = folder_.path() / "3.sqlite";
  merge_stores({folder_.path() / "1.sqlite", file_}, out);
  for (const CellRow& cell : read_cells(out)) {
    ASSERT_EQ(cell.stages->size(), 1U) << cell.method;
    const std::string by = to_text(cell.stages->front().options.at("by"));
    EXPECT_EQ(by.starts_with("3"), cell.method == "far") << by;
  }
}

TEST_F(MergeTest, RefusesWhatDoesNotBelongTogether) {
  const std::filesystem::path one = file_ = folder_.path() / "1.sqlite";
  run(kUsual);
  const std::filesystem::path other_options = file_ = folder_.path() / "2.sqlite";
  run(config("straight, {method: shift, by: 2, label: shifted}"));
  const std::filesystem::path other_build = file_ = folder_.path() / "3.sqlite";
  build_ = "build two";
  run(kUsual);
  const std::filesystem::path out = folder_.path() / "out.sqlite";
  EXPECT_THROW(merge_stores({one, other_options}, out), InputError);
  EXPECT_THROW(merge_stores({one, other_build}, out), InputError);
  EXPECT_FALSE(std::filesystem::exists(out));
  const MergeOptions mixed{.mixed_builds = true, .add = false};
  EXPECT_THROW(merge_stores({one, other_build}, out, mixed), InputError) << "the same cells";
  const std::filesystem::path half = file_ = folder_.path() / "4.sqlite";
  run(kUsual, Retry::none, "b / ");
  const std::filesystem::path other_half = file_ = folder_.path() / "5.sqlite";
  build_ = "build one";
  run(kUsual, Retry::none, "a / ");
  EXPECT_EQ(merge_stores({half, other_half}, out, mixed).cells, 4u);
}

}  // namespace
}  // namespace loopbench::tiny_store::merge_test
