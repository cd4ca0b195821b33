#include "harness/python/arrays.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "datasets/core/pose_rule.hpp"

namespace loopbench::python {
namespace {

namespace py = pybind11;

constexpr py::ssize_t kPoseColumns = 8;
constexpr py::ssize_t kEdgeColumns = 46;

/// Throws InputError unless the array has that many columns.
std::size_t rows_in(const Array& rows, py::ssize_t columns, const std::string& name) {
  if (rows.ndim() == 2 && rows.shape(1) == columns) return static_cast<std::size_t>(rows.shape(0));
  std::string shape;
  for (py::ssize_t i = 0; i < rows.ndim(); ++i) {
    shape += (i == 0 ? "" : ", ") + std::to_string(rows.shape(i));
  }
  throw InputError(name + ": found an array of shape (" + shape + "), expected " +
                   std::to_string(columns) + " columns");
}

/// Zeros are no rotation. Throws std::runtime_error for another quaternion that is not unit.
Pose pose_at(const double* row, double& off_unit) {
  const bool is_position = std::all_of(row + 3, row + 7, [](double x) { return x == 0.0; });
  if (is_position) return {no_rotation(), {row[0], row[1], row[2]}};
  return {unit_rotation({row[6], row[3], row[4], row[5]}, "pose", off_unit),
          {row[0], row[1], row[2]}};
}

/// Calls `read_row(i)` for each row; its std::runtime_error becomes an InputError with the row.
template <class ReadRow>
void for_each_row(std::size_t rows, const std::string& name, ReadRow read_row) {
  std::size_t i = 0;
  try {
    for (; i < rows; ++i) read_row(i);
  } catch (const std::runtime_error& error) {
    throw InputError(name + ": row " + std::to_string(i) + ": " + error.what());
  }
}

double* write_pose(double* at, const Pose& pose) {
  at = std::copy_n(pose.translation.data(), 3, at);
  if (!has_rotation(pose)) return std::fill_n(at, 4, 0.0);
  return std::copy_n(pose.rotation.coeffs().data(), 4, at);
}

std::size_t index_at(double value) {
  constexpr double kMost = 1e9;
  if (!(value >= 0.0 && value <= kMost) || value != std::floor(value)) {
    throw std::runtime_error("found " + std::to_string(value) +
                             ", expected the index of a keyframe");
  }
  return static_cast<std::size_t>(value);
}

}  // namespace

ReadRows read_rows(const Array& rows, const std::string& name) {
  ReadRows out;
  out.poses.resize(rows_in(rows, kPoseColumns, name));
  const double* row = rows.data();
  for_each_row(out.poses.size(), name, [&](std::size_t i) {
    if (!std::all_of(row, row + kPoseColumns, [](double x) { return std::isfinite(x); })) {
      throw std::runtime_error("is not finite");
    }
    out.poses[i] = {row[0], pose_at(row + 1, out.off_unit)};
    row += kPoseColumns;
  });
  return out;
}

Array rows_of(const Trajectory& poses) {
  Array out({static_cast<py::ssize_t>(poses.size()), kPoseColumns});
  double* at = out.mutable_data();
  for (const auto& [stamp, pose] : poses) {
    *at++ = stamp;
    at = write_pose(at, pose);
  }
  return out;
}

std::vector<Edge> read_edges(const Array& rows, const std::string& name) {
  std::vector<Edge> out(rows_in(rows, kEdgeColumns, name));
  const double* row = rows.data();
  for_each_row(out.size(), name, [&](std::size_t i) {
    double off_unit = 0.0;
    out[i].from = index_at(row[0]);
    out[i].to = index_at(row[1]);
    out[i].from_from_to = pose_at(row + 2, off_unit);
    out[i].scale = row[9];
    std::copy(row + 10, row + kEdgeColumns, out[i].information.data());  // symmetric
    row += kEdgeColumns;
  });
  return out;
}

Array edge_rows(const std::vector<Edge>& edges) {
  Array out({static_cast<py::ssize_t>(edges.size()), kEdgeColumns});
  double* at = out.mutable_data();
  for (const Edge& edge : edges) {
    *at++ = static_cast<double>(edge.from);
    *at++ = static_cast<double>(edge.to);
    at = write_pose(at, edge.from_from_to);
    *at++ = edge.scale;
    at = std::copy_n(edge.information.data(), edge.information.size(), at);
  }
  return out;
}

}  // namespace loopbench::python
