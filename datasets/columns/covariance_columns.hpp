/// Covariances in the columns behind a pose, and their conventions.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <utility>

#include "datasets/columns/columns.hpp"
#include "datasets/columns/text_file.hpp"
#include "datasets/core/se3.hpp"

namespace loopbench {

/// The perturbation xi = [rho; phi] of a mean pose T whose covariance is stated.
enum class TangentConvention {
  right_perturbation,  ///< T exp(xi): axes of the body
  left_perturbation,   ///< exp(xi) T: axes and origin of the world
  fixed_axes,          ///< position + rho, exp(phi) R: axes of the world, as in ROS
};
inline auto choices(TangentConvention) {
  return std::array{std::pair{"right_perturbation", TangentConvention::right_perturbation},
                    std::pair{"left_perturbation", TangentConvention::left_perturbation},
                    std::pair{"fixed_axes", TangentConvention::fixed_axes}};
}

/// How the columns of a covariance are read.
struct CovarianceColumns {
  enum class Part { upper, lower, all };  ///< triangle by rows, or all rows
  Part part = Part::all;
  TangentConvention convention = TangentConvention::fixed_axes;
  bool rotation_first = false;
  int axes = 6;            ///< 3: of a position
  bool is_stated = false;  ///< the file states the convention

  std::size_t count() const {
    return static_cast<std::size_t>(part == Part::all ? axes * axes : axes * (axes + 1) / 2);
  }
};

/// The columns behind the first ones (`before`) of the first row: 21 or 36 more, or of a position,
/// if only the stamp is before them, 6 or 9; otherwise nothing. Lines
/// `#%TANGENT_CONVENTION`, `#%TANGENT_ORDER` and `#%ROTATION_PARAM` state the convention. Without
/// them, 21 columns are a right perturbation (as in smfeval), 36 are in fixed axes (as in ROS),
/// both with the translation first. 21 columns are the lower triangle after `#%FORMAT SQUARE`,
/// otherwise the triangle by which the first row is positive definite. Throws InputError for a
/// convention that is not supported, and if both triangles fit.
std::optional<CovarianceColumns> covariance_columns(const TextFile& file,
                                                    const Line& first,
                                                    std::size_t before);

/// Reads one covariance and converts it to fixed axes (datasets/core/covariance.hpp). Throws
/// InputError if it is not symmetric and positive definite.
Matrix6 read_covariance(const TextFile& file,
                        const Line& line,
                        Columns& columns,
                        const CovarianceColumns& layout,
                        const Pose& pose);

/// Reads rows of a stamp and a covariance, one for each pose in order, with equal stamps to 1e-6 s.
/// `assumed_axes`: the file does not state its convention. Throws InputError.
std::vector<Matrix6> read_covariance_file(const std::filesystem::path& path,
                                          const Trajectory& poses,
                                          bool& assumed_axes);

/// Names of the columns of a csv file with the upper triangle of a covariance, by rows:
/// "cov_x_x", "cov_x_y" to "cov_yaw_yaw", or of a position to "cov_z_z".
std::vector<std::string> covariance_names(bool has_rotation);

/// Adds the covariance of the row after which the file has `poses` poses: StampOrder may have
/// dropped it, or replaced the last one.
void put_covariance(const TextFile& file,
                    const Matrix6& covariance,
                    std::size_t poses,
                    Repeats repeats);

/// Whether a symmetric matrix is positive definite in the axes that are not zero: the first pose
/// can be exact, and planar poses have no errors of z, roll and pitch. Rotations do not count for
/// positions without rotation.
bool is_covariance(const Matrix6& matrix, bool has_rotation);

}  // namespace loopbench
