/// Options of `traj` and its verbs.
#pragma once

#include <functional>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "harness/commands/eval/eval_figures.hpp"
#include "harness/commands/files/named_trajectory.hpp"
#include "harness/commands/files/transformation.hpp"
#include "metrics/protocols/protocol.hpp"

namespace CLI {
class App;
}

namespace loopbench::harness {

inline constexpr double kForever = std::numeric_limits<double>::infinity();

struct TrajArguments {
  std::vector<std::string> files;
  ReadArguments reading;
  std::string reference;
  std::string out = "-";
  std::string to;         ///< empty: of the extension of `out`
  std::string times_out;  ///< stamps of a KITTI file; empty: none
  bool json = false;
  double start = -kForever;               ///< [s]
  double end = kForever;                  ///< [s]
  bool relative = false;                  ///< start and end count from the first stamp
  std::optional<std::size_t> downsample;  ///< most poses of each file
  std::vector<double> motion_filter;      ///< thresholds [m, deg] between poses; empty: none
  std::string left;                       ///< transform; empty: none
  std::string right;
  bool invert = false;
  bool propagate = false;
  std::string parts = "auto";  ///< of `split`
  Conventions conventions;
  std::string association = "evo";
  double max_diff = 0.01;  ///< [s]
  double offset = 0.0;     ///< added to the stamps of the files [s]
  metrics::Align align = metrics::Align::se3;
  std::size_t align_first = 0;
  metrics::ProjectionPlane plane = metrics::ProjectionPlane::none;  ///< of `convert`
  std::vector<std::string> panels = default_trajectory_panels();    ///< of `plot`
  FigureOptions figures;
};

using TrajVerb = std::function<int(const TrajArguments&)>;

/// Names of the formats that write_trajectory() writes.
std::vector<std::string> written_formats();

/// The format of `to`, or of the ending of `out`, or tum for folders and standard output. Throws
/// OptionError, and InputError for another ending.
Format written_format(const std::string& out, const std::string& to);

/// Adds one subcommand for each verb.
void declare_traj(CLI::App& traj, const std::map<std::string, TrajVerb>& verbs, int& exit_code);

}  // namespace loopbench::harness
