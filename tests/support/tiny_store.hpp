/// A store for sweeps of the tiny catalogue, run on one thread of this process.
#pragma once

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "harness/sweep/catalogue/load_sequence.hpp"
#include "harness/sweep/config/read_sweep.hpp"
#include "harness/sweep/store/store.hpp"
#include "tests/support/refusal_of.hpp"
#include "tests/support/store_text.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tests/support/tiny_catalogue.hpp"

namespace loopbench::tiny_store {

using Labels = std::vector<std::string>;

/// The bias of the tiny line, from a file.
struct FileOptions {
  std::string path;
};
template <class Visit>
void fields(FileOptions& o, Visit visit) {
  visit("path", o.path, "file with the bias");
}
inline Sequence load_file(const FileOptions& options, const DataRoot& root) {
  const std::filesystem::path file = root.find(options.path);
  tiny::LineOptions line;
  std::ifstream(file) >> line.bias;
  Sequence out = tiny::load_line(line, root);
  out.provenance.inputs = {{file, "path"}};
  return out;
}

inline std::string config(const std::string& methods, const std::string& more = "") {
  return "datasets: [{dataset: line, bias: 0.1, label: a}, {dataset: line, bias: 0.2, label: b}]\n"
         "methods: [" +
         methods + "]\nmetrics: [ate]\nbaseline: straight\n" + more;
}
inline const std::string kUsual = config("straight, {method: shift, by: 1, label: shifted}");

class TinyStore : public testing::Test {
 protected:
  struct Ran {
    Labels cells;  ///< "SEQUENCE / METHOD", in order
    Resumed resumed;
  };

  /// Runs the cells of the config that are missing in the store, on one thread.
  Ran run(const std::string& text, Retry retry = Retry::none, const std::string& only = "") {
    const Sweep sweep = parse_sweep(text, folder_.path() / "c.yaml", known_);
    CellKeys keys(sweep, known_, root_, build_);
    const std::vector<bool> with_seed = seeded(sweep, known_);
    Store store(file_, keys, {{"commit", commit_}});
    Ran out;
    out.resumed = store.resume(cells(sweep, with_seed, ""), cells(sweep, with_seed, only), retry);
    run_here(sweep, out.resumed.missing, known_, root_, [&](const CellResult& r) {
      store.write(r);
      out.cells.push_back(sweep.datasets[r.cell.dataset].label + " / " +
                          sweep.methods[r.cell.method].label);
    });
    return out;
  }

  Labels methods_of(const std::string& sequence) const {
    Labels out;
    for (const CellRow& cell : read_cells(file_)) {
      if (cell.sequence == sequence) out.push_back(cell.method);
    }
    return out;
  }

  void expect_refused(const std::string& reason) {
    EXPECT_THAT(refusal_of<InputError>([&] { run(kUsual); }), testing::HasSubstr(reason));
  }

  TemporaryFolder folder_;
  std::filesystem::path file_ = folder_.path() / "results.sqlite";
  DataRoot root_{{folder_.path()}};
  std::string build_ = "build one";
  std::string commit_ = "c0ffee";
  Catalogue known_ = [] {
    Catalogue out = tiny::catalogue();
    out.datasets.push_back(dataset<FileOptions>("file", "bias from a file", load_file));
    return out;
  }();
};

}  // namespace loopbench::tiny_store
