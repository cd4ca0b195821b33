/// Identity of cells: labels, files and machines.
#include <gtest/gtest.h>

#include "harness/sweep/store/merge.hpp"
#include "tests/support/tiny_store.hpp"

namespace loopbench::tiny_store::cell_identity_test {
namespace {

/// Two files, one of whose paths is a suffix of the other's.
struct PairOptions {
  std::string estimate;
  std::string reference;
};
template <class Visit>
void fields(PairOptions& o, Visit visit) {
  visit("estimate", o.estimate, "file with the bias");
  visit("reference", o.reference, "file that is read too");
}
Sequence load_pair(const PairOptions& options, const DataRoot& root) {
  Sequence out = load_file({options.estimate}, root);
  out.provenance.inputs = {{root.find(options.estimate), "estimate"},
                           {root.find(options.reference), "reference"}};
  return out;
}

class CellIdentity : public TinyStore {
 protected:
  CellIdentity() {
    known_.datasets.push_back(dataset<PairOptions>("pair", "two files", load_pair));
  }
  std::vector<std::string> hashes() const {
    const std::vector<InputFile> inputs = read_inputs(file_).at("f");
    std::vector<std::string> out;
    for (const InputFile& input : inputs) out.push_back(input.hash);
    return out;
  }
  double rmse() const { return read_records(file_).at(0).statistics.rmse; }
};

const std::string kFile =
    "datasets: [{dataset: file, path: bias, label: f}]\nmethods: [straight]\nmetrics: [ate]\n";

TEST_F(CellIdentity, TwoLabelsOfEqualOptionsSurviveAMerge) {
  const std::string twins =
      config("straight, {method: shift, label: one}, {method: shift, label: two}");
  run(twins);
  const std::filesystem::path out = folder_.path() / "merged.sqlite";
  EXPECT_EQ(merge_stores({file_}, out).cells, 6u);
  const Merged again = merge_stores({file_, out}, folder_.path() / "again.sqlite");
  EXPECT_EQ(again.cells, 6u);
  EXPECT_EQ(again.duplicates, 6u);
  file_ = folder_.path() / "again.sqlite";
  EXPECT_EQ(methods_of("a"), (Labels{"straight", "one", "two"}));
  EXPECT_EQ(run(twins).cells, Labels{});
}

TEST_F(CellIdentity, AnOptionIsHeldAgainstTheFileThatItNames) {
  folder_.file("run1/traj.txt", "0.1");
  folder_.file("traj.txt", "0.2");
  const std::string text =
      "datasets: [{dataset: pair, estimate: run1/traj.txt, reference: traj.txt, label: f}]\n"
      "methods: [straight]\nmetrics: [ate]\n";
  EXPECT_EQ(run(text).cells.size(), 1u);
  EXPECT_NE(hashes().at(0), hashes().at(1));
  EXPECT_EQ(run(text).cells, Labels{}) << "neither has changed";
  folder_.file("run1/traj.txt", "0.3");
  EXPECT_EQ(run(text).cells.size(), 1u);
}

TEST_F(CellIdentity, AFileThatComesBackBringsItsOwnFactsAndTheProvenanceOfItsCells) {
  folder_.file("bias", "0.1");
  run(kFile);
  const std::vector<std::string> first = hashes();
  const double first_rmse = rmse();
  commit_ = "decaf";
  folder_.file("bias", "0.25");
  run(kFile);
  EXPECT_NE(hashes(), first);
  EXPECT_EQ(read_provenance(file_).at("commit"), "decaf");
  folder_.file("bias", "0.1");
  EXPECT_EQ(run(kFile).cells, Labels{}) << "its scores are still there";
  EXPECT_EQ(rmse(), first_rmse);
  EXPECT_EQ(hashes(), first);
  EXPECT_EQ(read_inputs(file_).at("f").at(0).bytes, 3u);
  EXPECT_EQ(read_provenance(file_).at("commit"), "c0ffee");
}

TEST_F(CellIdentity, ARetryIsRecordedWithItsMachine) {
  const std::string text = config("straight, {method: shift, fail: true, label: fails}");
  run(text);
  commit_ = "on another machine";
  run(text, Retry::failed);
  EXPECT_EQ(read_provenance(file_).at("commit"), "c0ffee\non another machine");
  run(text, Retry::all);
  EXPECT_EQ(read_provenance(file_).at("commit"), "on another machine");
}

TEST_F(CellIdentity, AChangedGroupReachesTheRecords) {
  for (const std::string group : {"one", "two", "one"}) {
    run("datasets: [{dataset: line, label: f, group: " + group +
        "}, {dataset: line, label: g, group: other}]\nmethods: [straight]\nmetrics: [ate]\n");
    const std::vector<Record> records = read_records(file_);
    EXPECT_EQ(records.front().cell->group, "group:" + group);
    EXPECT_EQ(records.back().cell->group, "group:other");
  }
}

}  // namespace
}  // namespace loopbench::tiny_store::cell_identity_test
