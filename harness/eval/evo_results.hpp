/// Result files of evo (zip), read and written.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "harness/eval/evaluation_result.hpp"
#include "harness/model/record.hpp"
#include "harness/tables/table.hpp"

namespace loopbench::harness {

/// Whether the file is a zip archive with evo's info.json and stats.json.
bool is_evo_result(const std::filesystem::path& file);

/// The statistics of each file as a record: the title is the label, the protocol `evo`, sequence
/// and method are named after the trajectories, or after the files if trajectories occur twice.
/// Runs of one method alone (est_1.txt, est_2.txt) are methods that are named after the files, too.
/// The cell of a record is the position of its file. Throws InputError for a file that is none, or
/// without a statistic of evo.
std::vector<Record> read_evo_results(const std::vector<std::string>& files);

/// For each title a table of statistics, one row for each of the files that were read. Rows of
/// equal sequence and method also have the name of the file.
std::vector<Table> evo_result_tables(const std::vector<Record>& records,
                                     const std::vector<std::string>& files);

/// APE of one evaluation with its errors by pose, as evo's --save_results writes it. `relation`:
/// trans_part (or empty), point_distance, angle_deg or angle_rad. Needs result.poses. Throws
/// InputError.
std::string evo_result_zip(const EvaluationResult& result, const std::string& relation);

}  // namespace loopbench::harness
