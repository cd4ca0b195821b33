/// Estimates of cells at full length, written as TUM files while a sweep runs.
#pragma once

#include <filesystem>

#include "datasets/core/curve.hpp"
#include "datasets/core/sequence.hpp"
#include "harness/model/cells.hpp"
#include "harness/model/sweep.hpp"

namespace loopbench::harness {

/// Sets the folder for this process and its workers; empty: estimates are not written. Call before
/// cells run.
void set_estimate_folder(const std::filesystem::path& folder);

/// Writes the reference of the sequence, see reference_file(), and the estimate of a cell in its
/// own world frame: at the keyframes and, if the sweep evaluates densely, at the reference's stamps
/// (minus the offset of the first protocol) inside its span. Every digit is written. Does nothing
/// without a folder. Throws InputError.
void save_estimate(const Cell& cell,
                   const Sweep& sweep,
                   const Sequence& sequence,
                   const Curve& curve);

/// FOLDER/reference-CONTENT.txt, for sequences with this content_of().
std::filesystem::path reference_file(const std::filesystem::path& folder,
                                     const std::string& content);

/// Gives the files of a cell their final names, see estimate_file(). Does nothing if there are
/// none.
void keep_estimate(const Cell& cell, const std::string& key);

/// FOLDER/KEY-TIMES.txt, for the cell with this key.
std::filesystem::path estimate_file(const std::filesystem::path& folder,
                                    const std::string& key,
                                    metrics::Times times);

}  // namespace loopbench::harness
