/// Validated contents of a config with all grids expanded: plain data.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "datasets/core/params.hpp"
#include "harness/sweep/model/choice.hpp"
#include "harness/sweep/model/method_parts.hpp"
#include "metrics/protocols/protocols.hpp"

namespace loopbench::harness {

struct DatasetChoice {
  std::string label;  ///< name, plus the swept options
  Choice dataset;
  std::string group = {};  ///< name of a group of dependent runs; empty: see source_of()
  std::optional<metrics::Align> align = {};  ///< under every protocol; none: as the protocol states
  std::size_t line = 0;                      ///< of the config; 0: unknown
};

struct MethodChoice {
  std::string label;
  std::vector<Choice> stages;  ///< one method; or corrector, smoother, or both in that order
  MethodParts parts = {};
};

struct MetricChoice {
  std::string label;
  Choice metric;
};

/// Excludes cells whose sequence and method labels both match (each a Pattern of the complete
/// label).
struct Exclusion {
  std::string dataset = ".*";
  std::string method = ".*";
};

/// Layout of the printed table; names are columns of the long table (see model/record).
struct TableSpec {
  std::vector<std::string> rows{"method"};
  std::vector<std::string> columns{"score"};
  std::vector<std::string> split{"sequence", "times"};
  std::string value = "rmse";
  std::vector<std::string> show;   ///< scores to show, by their short names; empty: all
  std::vector<std::string> where;  ///< filters of rows, see model/where; empty: all rows
  bool plus_minus = false;         ///< standard deviations next to means
};

/// Resource limits of one cell, and the size of the sweep. The default memory limit is the same on
/// all machines, so that verdicts are, and several times what the largest cells of this repository
/// need.
struct Limits {
  double seconds = 600.0;  ///< wall time of all timed runs and the evaluation [s]; 0: no limit
  std::int64_t memory = std::int64_t{8} << 30;  ///< resident size [bytes]; 0: no limit
  std::int64_t processes = 64;                  ///< of one cell, apart from threads
  std::int64_t cells = 1'000'000;  ///< of the sweep before exclusions; more are rejected
};

struct Sweep {
  std::string name;              ///< stem of the config file
  std::filesystem::path config;  ///< as given
  std::string text;              ///< the config, byte for byte
  std::vector<DatasetChoice> datasets;
  std::vector<MethodChoice> methods;
  std::vector<MetricChoice> metrics;
  std::vector<metrics::Times> times{metrics::Times::keyframes, metrics::Times::dense};
  std::vector<metrics::NamedProtocol> protocols{
      metrics::NamedProtocol{}};  ///< at least one, with distinct labels
  std::string baseline;           ///< label of the method that gain is relative to; empty: no gain
  double min_coverage = 0.0;      ///< share and span below this are `incomplete`, 0..1
  int repeats = 1;                ///< instances of each seeded dataset
  int timing = 1;                 ///< timed runs of each method; the most if there is a precision
  double precision = 0.0;  ///< relative standard error of the mean CPU time that ends them; 0: none
  bool serial = false;     ///< runs one cell at a time, on one core, for reliable times
  bool traces = true;      ///< stores subsampled trajectories of every cell for reports
  Limits limits;
  std::vector<Exclusion> exclude;
  TableSpec table;
};

/// `why` of an error in a file of a dataset, followed by the place in the config that names it:
/// "... (mine.yaml:4)".
inline std::string with_place(const std::string& why,
                              const DatasetChoice& dataset,
                              const Sweep& sweep) {
  if (dataset.line == 0) return why;
  return why + " (" + sweep.config.string() + ":" + std::to_string(dataset.line) + ")";
}

/// The sweep with the alignment of a dataset in all protocols; none if the dataset states none.
inline std::optional<Sweep> with_alignment_of(std::size_t dataset, const Sweep& sweep) {
  const std::optional<metrics::Align> align = sweep.datasets[dataset].align;
  if (!align) return std::nullopt;
  Sweep out = sweep;
  out.datasets[dataset].align.reset();
  for (metrics::NamedProtocol& protocol : out.protocols) protocol.rules.align = *align;
  return out;
}

}  // namespace loopbench::harness
