/// A sweep whose datasets are pairs of files and whose methods return the poses of the file.
#pragma once

#include <string>
#include <vector>

#include "datasets/formats/formats.hpp"
#include "harness/catalogue/catalogue.hpp"
#include "harness/eval/arguments.hpp"
#include "harness/eval/recorded_runs.hpp"
#include "harness/model/cells.hpp"
#include "harness/model/sweep.hpp"

namespace loopbench::harness {

/// Dataset `files`, method `recorded` and all metrics.
Catalogue recorded_catalogue();

/// Poses of a file and the remarks of its reader.
struct RecordedFile {
  Trajectory poses;
  ReadFindings findings = {};
  std::string unstamped = {};  ///< file and format if the stamps were generated, otherwise empty
};

/// Read the files of a dataset of recorded_sweep(); the reference is in the body of the estimate.
/// Throw InputError.
RecordedFile recorded_reference(const Params& options);
RecordedFile recorded_estimate(const Params& options);

/// The sequence of these files.
Sequence recorded_sequence(const Params& options, Trajectory reference, Trajectory estimate);

/// Whether any file has this format, by the arguments or its content.
bool has_poses_of(Format format,
                  const EvalArguments& arguments,
                  const std::vector<RecordedRun>& runs);

/// One dataset per run, with the sequence as label; the methods in the order of their first run.
Sweep recorded_sweep(const std::vector<RecordedRun>& runs, const EvalArguments& arguments);

/// One cell per run, by sequence, run and method. The repeat is the position of the run's name
/// among all runs of the sequence, in natural order, so that runs of equal names are paired.
std::vector<Cell> recorded_cells(const std::vector<RecordedRun>& runs, const Sweep& sweep);

/// The runs as text, for the store, and back. Other texts have no runs. `options`: those that all
/// files share, for recorded_options(). `merge` concatenates such texts: of several runs with the
/// same labels, the first is returned.
std::string manifest(const std::vector<RecordedRun>& runs, const std::string& options = "");
std::vector<RecordedRun> runs_of_manifest(const std::string& text);

}  // namespace loopbench::harness
