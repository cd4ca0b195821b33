/// What identifies the run of a file, for stores and for copies.
#pragma once

#include <memory>
#include <string>

#include "harness/eval/recorded_evaluation.hpp"
#include "harness/model/sequence_metadata.hpp"

namespace loopbench::harness {

/// `option`: of the dataset, by which the gate finds the reference among the inputs. Throws
/// InputError.
InputFile hashed_input(const std::string& name, const std::string& option);

/// Identity of the run, also if the estimate could not be read (null): whether two failures are
/// copies, and whether the file has changed since, is decided as for other runs. Throws InputError.
SequenceMetadata metadata_of(const RecordedRun& run,
                             const SharedReference& reference,
                             const RecordedFile* estimate);

/// The same without an estimate; null if the file cannot be hashed either, or if runs are not
/// compared.
std::shared_ptr<const SequenceMetadata> metadata_of_failure(const RecordedRun& run,
                                                            const SharedReference& reference);

}  // namespace loopbench::harness
