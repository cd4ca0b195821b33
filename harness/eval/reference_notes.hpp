/// Notes of `eval` on the frame and the accuracy of the reference.
#pragma once

#include <string>

#include "metrics/evaluation/evaluation.hpp"

namespace loopbench::harness {

/// The error without alignment, if the files are in one datum: as stated (converted from WGS 84
/// about one origin), or frames that differ by less than a tenth of the reference's size, of which
/// the alignment hides at least half; otherwise empty. O(n).
std::string shared_datum(const metrics::Evaluation& evaluation, bool is_one_datum);

/// Whether the ATE exceeds the reference's own error of `sigma` [m] per axis; empty for 0. O(n).
std::string reference_error(const metrics::Evaluation& evaluation, double sigma);

}  // namespace loopbench::harness
