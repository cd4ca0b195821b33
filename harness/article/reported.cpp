#include "harness/article/reported.hpp"

#include <fmt/format.h>

namespace loopbench::harness {

const std::vector<ReportedRow>& reported_rows() {
  // The OCR scrambled the rows of table 3; they are assigned by the printed N.
  static const std::vector<ReportedRow> rows{
      {1, "fr1_room", "y", "ORB_SLAM2", 0.0900, 0.0008, 0.0670, 0.0557, 0.0125},
      {1, "fr1_room", "y", "N3", 0.0888, 0.0003, 0.0296, 0.0365, 0.1045},
      {1, "fr1_room", "y", "N4", 0.1417, 0.0001, 0.0329, 0.0410, 0.0089},
      {1, "fr1_room", "y", "N5", 0.1332, 0.0001, 0.0335, 0.0423, 0.1184},
      {2, "fr1_room", "z", "ORB_SLAM2", 0.0773, 0.0001, 0.0144, 0.0193, 0.0135},
      {2, "fr1_room", "z", "M6", 0.0720, 0.0001, 0.0130, 0.0173, 0.0106},
      {2, "fr1_room", "z", "M7", 0.2073, 0.0002, 0.0198, 0.0341, 0.0232},
      {2, "fr1_room", "z", "M8", 0.0697, 0.0001, 0.0153, 0.0215, 0.0113},
      {3, "fr3_office", "y", "ORB_SLAM2", 0.1466, 0.0001, 0.0203, 0.0234, 0.0183},
      {3, "fr3_office", "y", "N3", 0.1401, 0.0002, 0.0178, 0.0231, 0.0196},
      {3, "fr3_office", "y", "N4", 0.1063, 0.0001, 0.0174, 0.0238, 0.0185},
      {3, "fr3_office", "y", "N5", 0.1675, 0.0005, 0.0272, 0.03997, 0.0186},
      {4, "fr3_office", "z", "ORB_SLAM2", 0.1466, 0.0001, 0.0622, 0.0780, 0.1068},
      {4, "fr3_office", "z", "M6", 0.1727, 0.0001, 0.0364, 0.0262, 0.1691},
      {4, "fr3_office", "z", "M7", 0.1490, 0.0001, 0.0154, 0.0332, 0.0141},
      {4, "fr3_office", "z", "M8", 0.1564, 0.0002, 0.0146, 0.0314, 0.0133},
  };
  return rows;
}

std::string contradiction(const ReportedRow& row) {
  std::string out;
  if (row.mean > row.ate) out += fmt::format("mean {} exceeds ATE {}", row.mean, row.ate);
  if (row.rpe > 2.0 * row.ate) {
    out += fmt::format(
        "{}RPE is {:.2f} times the ATE, at most 2 is possible for errors of the same axis",
        out.empty() ? "" : "; ",
        row.rpe / row.ate);
  }
  return out;
}

}  // namespace loopbench::harness
