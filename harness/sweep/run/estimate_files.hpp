/// Estimates of cells at full length, written as TUM files while a sweep runs.
///
/// The process of a cell does not know the cell's key. It writes a file whose name contains the
/// process of the sweep; when the cell is stored, the sweep writes the key into the file and into
/// its name. So a file is of the cell whose key it contains, whatever was killed before.
#pragma once

#include <filesystem>
#include <string>

#include "datasets/core/curve.hpp"
#include "datasets/core/sequence.hpp"
#include "harness/sweep/model/cells.hpp"
#include "harness/sweep/model/sweep.hpp"

namespace loopbench::harness {

inline constexpr metrics::Times kAllTimes[] = {metrics::Times::keyframes, metrics::Times::dense};

/// Sets the folder for this process and its workers, and removes what a killed sweep has left
/// there; empty: estimates are not written. Call before cells run, while the store's folder is
/// locked.
void set_estimate_folder(const std::filesystem::path& folder);

/// Writes the reference of the sequence and the estimate of a cell in its own world frame: at the
/// keyframes and, if the sweep evaluates densely, at the reference's stamps (minus the offset of
/// the first protocol) inside its span. Every digit is written. Does nothing without a folder.
/// Throws InputError.
void save_estimate(const Cell& cell,
                   const Sweep& sweep,
                   const Sequence& sequence,
                   const Curve& curve);

/// Removes what an earlier attempt at the cell has written.
void forget_estimate(const Cell& cell);

/// Gives the files of a cell their final names and content: FOLDER/KEY-TIMES.txt, whose first line
/// is
/// "# cell: KEY". Does nothing if there are none.
void keep_estimate(const Cell& cell, const std::string& key);

/// The TUM lines of the estimate of the cell with this key, or of the reference of sequences with
/// this content_of(); empty unless the file is there and contains the key.
std::string saved_estimate(const std::filesystem::path& folder,
                           const std::string& key,
                           metrics::Times times);
std::string saved_reference(const std::filesystem::path& folder, const std::string& content);

/// Copies saved files of a cell from one folder to another that lacks them. Throws InputError.
void copy_estimates(const std::filesystem::path& from,
                    const std::filesystem::path& to,
                    const std::string& key,
                    const std::string& content);

}  // namespace loopbench::harness
