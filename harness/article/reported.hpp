/// The article's tables 1 to 4 as printed, with what cannot be true about them.
#pragma once

#include <string>
#include <vector>

namespace loopbench {

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

/// Why a row cannot be true if ATE is the RMSE of the same errors: mean <= RMSE always, and an RPE
/// over the same axis is at most twice the ATE. Empty when nothing contradicts.
std::string contradiction(const ReportedRow& row);

}  // namespace loopbench
