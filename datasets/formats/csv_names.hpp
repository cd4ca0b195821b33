/// Meaning of one column name in the header of a table.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

namespace loopbench {

/// Of several columns with the same meaning, the one of the lowest rank is taken.
enum class NameRank { usual, rare, whole_seconds, nanoseconds };

/// One of the columns t, x, y, z, qw, qx, qy, qz, latitude, longitude, height, fix status.
struct PoseColumn {
  std::size_t column = 0;  ///< 0 to 11
  NameRank rank = NameRank::usual;
  std::optional<int> time_exponent = {};  ///< stated unit of time, 10^exponent [s]
  double per_metre = 1.0;                 ///< unit of a position
  std::string wrong_unit = {};            ///< stated, but not supported
};

struct NamedColumn {
  std::string base;  ///< lower case, letters and digits only: "p_x [m]" -> "px"
  std::string unit;  ///< in brackets: "m"
};

/// Lower case, letters and digits only.
std::string plain_name(std::string_view name);

NamedColumn named_column(std::string_view name);

/// The unit 10^exponent [s] of a name such as ms; nothing for other texts.
std::optional<int> time_exponent(std::string_view unit);

/// The time column with this name; nothing for other names.
std::optional<PoseColumn> time_column(const NamedColumn& name);

/// The meaning of a name; nothing for other columns.
std::optional<PoseColumn> pose_column(std::string_view name);

}  // namespace loopbench
