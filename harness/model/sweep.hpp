/// What a config asks for, every grid already spread out: plain data, validated, ready to run.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "datasets/core/params.hpp"
#include "metrics/protocols/protocols.hpp"

namespace loopbench {

/// A catalogue name and the options that differ from its defaults.
struct Choice {
  std::string name;
  Params options;
};

struct DatasetChoice {
  std::string label;  ///< name, plus the swept options
  Choice dataset;
  std::string group = {};  ///< runs that are not independent, by name; empty: see source_of()
};

/// What a calibration file was learnt from; empty without one.
struct TrainingData {
  std::string calibration;           ///< the file
  std::vector<std::string> labels;   ///< of the datasets
  std::vector<std::string> sources;  ///< of their references or noise, see source_of()
};

struct MethodChoice {
  std::string label;
  std::vector<Choice> stages;  ///< one method; or corrector, smoother, or both in that order
  TrainingData trained_on = {};
};

struct MetricChoice {
  std::string label;
  Choice metric;
};

/// Cells whose sequence and method labels both match are left out (each a Pattern, of the whole
/// label).
struct Exclusion {
  std::string dataset = ".*";
  std::string method = ".*";
};

/// How the table at the end is laid out; names are columns of the long table (see model/record).
struct TableSpec {
  std::vector<std::string> rows{"method"};
  std::vector<std::string> columns{"score"};
  std::vector<std::string> split{"sequence", "times"};
  std::string value = "rmse";
  std::vector<std::string> show;   ///< only these scores, by their short names; empty: all
  std::vector<std::string> where;  ///< only rows these rules keep, see model/where; empty: all
};

/// What one cell may use before it is ended.
struct Limits {
  double seconds = 600.0;   ///< wall time, all timed runs and judging together [s]; 0: any
  std::int64_t memory = 0;  ///< resident size of the process [bytes]; 0: any
};

struct Sweep {
  std::string name;              ///< stem of the config file
  std::filesystem::path config;  ///< as given
  std::string text;              ///< the config, byte for byte
  std::vector<DatasetChoice> datasets;
  std::vector<MethodChoice> methods;
  std::vector<MetricChoice> metrics;
  std::vector<Times> times{Times::keyframes, Times::dense};
  std::vector<NamedProtocol> protocols{NamedProtocol{}};  ///< at least one; labels differ
  std::string baseline;       ///< method label that gain is measured from; empty: no gain
  double min_coverage = 0.0;  ///< share and span below this make numbers `incomplete`, 0..1
  int repeats = 1;            ///< instances of each seeded dataset
  int timing = 1;             ///< runs of each method's verb
  bool serial = false;        ///< one cell at a time, on one core, for the sake of its times
  bool traces = true;         ///< keep thinned trajectories of every cell for reports
  Limits limits;
  std::vector<Exclusion> exclude;
  TableSpec table;
};

}  // namespace loopbench
