/// The article's tables 1 to 4 as printed, with their inconsistencies.
#pragma once

#include <string>
#include <vector>

namespace loopbench::harness {

/// One printed row; all errors in metres, at one axis.
struct ReportedRow {
  int table;             ///< 1..4
  std::string sequence;  ///< fr1_room | fr3_office
  std::string axis;      ///< y | z
  std::string variant;   ///< ORB_SLAM2, or N3..N5, M6..M8
  double max;
  double min;
  double mean;
  double ate;
  double rpe;
};

const std::vector<ReportedRow>& reported_rows();

/// The reason why a row is inconsistent if ATE is the RMSE of the same errors: mean <= RMSE, and an
/// RPE over the same axis is at most twice the ATE. Empty if it is consistent.
std::string contradiction(const ReportedRow& row);

}  // namespace loopbench::harness
