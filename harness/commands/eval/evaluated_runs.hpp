/// Estimate files as runs of methods on sequences.
#pragma once

#include <string>
#include <vector>

namespace loopbench::harness {

/// One output of a system on one sequence.
struct EvaluatedRun {
  std::string sequence;
  std::string method;
  std::string run;          ///< "0", "7", or "0" if the file name has no number
  std::string reference;    ///< absolute
  std::string estimate;     ///< absolute
  std::string group = {};   ///< name of the recording; empty: by the geometry of the reference
  std::string common = {};  ///< times to evaluate, see set_common_times(); empty: all
  friend bool operator==(const EvaluatedRun&, const EvaluatedRun&) = default;
};

/// Labels from the file names:
/// - METHOD/SEQUENCE/RUN.txt with SEQUENCE.txt as reference: these names; with any other reference
///   of the sequence if RUN is a number;
/// - METHOD/RUN.txt where RUN is a number: these;
/// - NAME_3.txt, NAME_run3.txt, NAME-3.txt: method NAME, run 3;
/// - any other name: the method, run 0. A method that occurs in several folders gets their names.
/// The sequence is the name of the reference file, or of its folder for names such as
/// groundtruth.txt, or `sequence` if not empty. Topics of bags are names, too. Throws InputError if
/// two files have the same labels. Files of equal content are not detected here.
std::vector<EvaluatedRun> evaluated_runs(const std::string& reference,
                                         const std::vector<std::string>& estimates,
                                         const std::string& sequence);

/// Labels for estimates: those of evaluated_runs(), or the names as given if evaluated_runs()
/// rejects them.
std::vector<EvaluatedRun> labelled_runs(const std::string& reference,
                                        const std::vector<std::string>& estimates,
                                        const std::string& sequence);

}  // namespace loopbench::harness
