#include "datasets/formats/csv_row.hpp"

#include <fmt/format.h>

#include <cmath>
#include <numbers>

#include "datasets/columns/columns.hpp"
#include "datasets/columns/covariance_columns.hpp"
#include "datasets/columns/stamps.hpp"
#include "datasets/core/so3.hpp"

namespace loopbench {

void split_row(const TextFile& file, const Line& line, const CsvColumns& columns, CsvRow& row) {
  split_columns(line.text, row);
  if (row.size() + 1 == columns.width && line.text.ends_with(',')) row.emplace_back();
  if (row.size() == columns.width || (columns.has_more && row.size() > columns.width)) return;
  throw file.error(line.number,
                   "has " + columns_text(row.size()) + ", expected " +
                       std::to_string(columns.width) + " as in the header" +
                       (line.unterminated ? " (the file ends in the middle of this line)" : ""));
}

double csv_number(const TextFile& file,
                  const Line& line,
                  const CsvColumns& columns,
                  const CsvRow& row,
                  std::size_t index) {
  const std::string& name = columns.names[index];
  Line column = line;
  column.text = index == columns.index[0] ? stamp_word(row[index]) : row[index];
  Columns parsed(file, column, index);
  const double out = parsed.number(name.c_str());
  if (parsed.done()) return out;
  throw file.error(line.number,
                   "column " + name + ": '" + std::string(row[index]) + "' is not a number");
}

Matrix6 covariance_of_row(const TextFile& file,
                          const Line& line,
                          const CsvColumns& columns,
                          const CsvRow& row) {
  const Eigen::Index axes = columns.has_rotation ? 6 : 3;
  Matrix6 out = Matrix6::Zero();
  std::size_t k = 0;
  for (Eigen::Index i = 0; i < axes; ++i) {
    for (Eigen::Index j = i; j < axes; ++j) {
      out(i, j) = out(j, i) = csv_number(file, line, columns, row, columns.covariance[k++]);
    }
  }
  if (is_covariance(out, columns.has_rotation)) return out;
  throw file.error(line.number, "covariance is not positive definite");
}

Rotation rotation_of_angles(const TextFile& file,
                            const Line& line,
                            const CsvColumns& columns,
                            const CsvRow& row) {
  constexpr double kMost = 2.0 * std::numbers::pi + 1e-6;
  Vector3 angles = Vector3::Zero();
  const bool is_heading = columns.angles.size() == 1;
  for (std::size_t i = 0; i < columns.angles.size(); ++i) {
    const std::size_t index = columns.angles[i];
    const double angle = csv_number(file, line, columns, row, index) / columns.per_radian;
    if (columns.per_radian == 1.0 && !(std::abs(angle) <= kMost)) {
      throw file.error(line.number,
                       fmt::format("{} is {:.6g}, expected radians (in degrees, its name ends in "
                                   "[deg])",
                                   columns.names[index],
                                   angle));
    }
    angles[is_heading ? 2 : static_cast<Eigen::Index>(i)] = angle;
  }
  if (columns.is_vector) return exp_so3(angles).normalized();
  Rotation out = Rotation::Identity();
  for (const char axis : columns.order.empty() ? std::string("zyx") : columns.order) {
    const Eigen::Index i = axis - 'x';
    out = out * exp_so3(angles[i] * Vector3::Unit(i));
  }
  return out.normalized();
}

}  // namespace loopbench
