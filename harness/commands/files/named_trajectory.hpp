/// Trajectory files as arguments of a command.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "datasets/formats/trajectory_file.hpp"

namespace loopbench::harness {

/// How all files of a command are read.
struct ReadArguments {
  Format format = Format::automatic;
  std::string times = {};               ///< of KITTI poses; empty: none
  std::optional<double> period = {};    ///< [s]; none: default of ReadOptions
  std::optional<Repeats> repeats = {};  ///< none: refuse in a file, keep_first across merged files
  std::string tf = {};                  ///< PARENT.CHILD for bags without a topic; empty: none
  bool all_topics = false;              ///< every trajectory of bags named without a topic
  bool sort = false;                    ///< accept rows in any order of time
  bool drop_invalid = false;            ///< drop rows that are no poses
  StampUnit stamp_unit = StampUnit::automatic;
};

/// The arguments as options, without times.
ReadOptions read_options(const ReadArguments& arguments);

struct NamedTrajectory {
  std::string name;  ///< as given, with the topic of a bag
  TrajectoryFile file;
  ReadFindings findings;
};

/// The names with `tf` and `all_topics` applied to bags without a topic. Throws InputError.
std::vector<std::string> expanded_names(const std::vector<std::string>& names,
                                        const ReadArguments& arguments);

/// Reads one file. Damage of a bag is printed to standard error, too. Throws InputError.
NamedTrajectory read_named(const std::string& name, const ReadArguments& arguments);

/// Throws InputError, too, for a period if all files and the reference (if any) have stamps.
std::vector<NamedTrajectory> read_all_named(const std::vector<std::string>& names,
                                            const ReadArguments& arguments,
                                            const NamedTrajectory* reference = nullptr);

/// Adds `offset` [s] to all stamps; exact ones are shifted by whole nanoseconds.
void shift_stamps(TrajectoryFile& file, double offset);

/// Throws InputError if two trajectories have no common clock: only one of them has stamps, and
/// `arguments` state no period for the other one, or both have none and different numbers of rows.
void reject_two_clocks(const NamedTrajectory& a,
                       const NamedTrajectory& b,
                       const ReadArguments& arguments);

/// "assumed 0.1 s between poses" for a file without stamps and a period that is not stated;
/// otherwise empty.
std::string assumed_period(const TrajectoryFile& file, const ReadArguments& arguments);

/// A file name without folder and extensions, or a topic: "a/0.txt.gz" -> "0", "bag:a.bag#/a/odom"
/// -> "a/odom".
std::string plain_stem(const std::string& name);

/// The same as the name of a file: "a_odom".
std::string output_stem(const std::string& name);

/// The file for each name: `out` itself for a single name unless it is a folder or ends in '/';
/// otherwise OUT/STEM.EXTENSION. Creates the folder. Throws InputError if two names have the same
/// file, or several names would be printed.
std::vector<std::string> output_files(const std::vector<std::string>& names,
                                      const std::string& out,
                                      Format format);

}  // namespace loopbench::harness
