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

/// Coverage below which a run in a store is a failure unless --min-coverage is given, 0..1.
inline constexpr double kDefaultMinCoverage = 0.5;

/// Dataset `files`, method `recorded` and all metrics, with those of plugins. Throws InputError.
Catalogue recorded_catalogue(const std::vector<std::filesystem::path>& plugins = {});

/// Poses of a file and the remarks of its reader.
struct RecordedFile {
  Trajectory poses;
  std::vector<PoseMatrix> matrices = {};  ///< as printed; only of KITTI files, and if needed
  ReadFindings findings = {};
  std::string unstamped = {};  ///< file and format if the stamps were generated, otherwise empty
};

/// The options of a run's dataset in recorded_sweep(). Throws InputError.
Params recorded_file_options(const RecordedRun& run, const EvalArguments& arguments);

/// Read the files of a dataset of recorded_sweep(); the reference is in the body of the estimate.
/// `with_matrices`: also the digits of KITTI files. Throw InputError.
RecordedFile recorded_reference(const Params& options, bool with_matrices);
RecordedFile recorded_estimate(const Params& options, bool with_matrices);

/// Whether a protocol computes with the digits of KITTI files instead of rotations.
bool uses_digits(const Sweep& sweep, const EvalArguments& arguments);

/// Throws InputError for a times file or a period that no file uses.
void check_stamp_options(const EvalArguments& arguments, const std::vector<RecordedRun>& runs);

/// One dataset per run, with the sequence as label; the methods in the order of their first run.
/// Throws InputError, OptionError for invalid protocols and metrics.
Sweep recorded_sweep(const std::vector<RecordedRun>& runs,
                     const EvalArguments& arguments,
                     const Catalogue& catalogue);

/// One cell per run, by sequence, run and method. The repeat is the position of the run's name
/// among all runs of the sequence, in natural order, so that runs of equal names are paired.
std::vector<Cell> recorded_cells(const std::vector<RecordedRun>& runs, const Sweep& sweep);

/// The runs as text, for the store, and back. Other texts have no runs. `options`: those that all
/// files share, for recorded_options(). `merge` concatenates such texts: of several runs with the
/// same labels, the first is returned.
std::string manifest(const std::vector<RecordedRun>& runs, const std::string& options = "");
std::vector<RecordedRun> runs_of_manifest(const std::string& text);

}  // namespace loopbench::harness
