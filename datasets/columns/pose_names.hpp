/// Choice of the columns of a pose among those that a header names.
#pragma once

#include <algorithm>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "datasets/columns/csv_names.hpp"

namespace loopbench {

inline std::string shortened(const std::string& name) {
  constexpr std::size_t kMost = 40;
  return name.size() > kMost ? name.substr(0, kMost) + "..." : name;
}

/// The names of a header, and which of them are columns of a pose.
struct PoseNames {
  std::vector<std::string> names;
  std::vector<std::optional<PoseColumn>> meanings;

  const PoseColumn& meaning(std::size_t i) const { return *meanings[i]; }

  /// Columns of the header with this role and rank.
  std::vector<std::size_t> with(Role role, NameRank rank) const {
    std::vector<std::size_t> out;
    for (std::size_t i = 0; i < meanings.size(); ++i) {
      if (meanings[i] && meanings[i]->role == role && meanings[i]->rank == rank) out.push_back(i);
    }
    return out;
  }

  /// Columns of the lowest rank with this role.
  std::vector<std::size_t> best(Role role) const {
    for (const NameRank rank :
         {NameRank::usual, NameRank::rare, NameRank::whole_seconds, NameRank::nanoseconds}) {
      if (auto out = with(role, rank); !out.empty()) return out;
    }
    return {};
  }

  bool has(Role role) const { return !best(role).empty(); }

  bool has_any(Role first, std::size_t count) const {
    for (std::size_t i = 0; i < count; ++i) {
      if (has(after(first, i))) return true;
    }
    return false;
  }

  /// Whether the header has latitude, longitude and height instead of x, y and z.
  bool is_geodetic() const { return !has_any(Role::x, 3) && has(Role::latitude); }

  /// The roles of angles in place of a quaternion, or of a rotation vector; empty: none.
  std::vector<Role> angles() const {
    if (has_any(Role::qw, 4)) return {};
    if (has_any(Role::vector_x, 3)) return {Role::vector_x, Role::vector_y, Role::vector_z};
    if (!has(Role::yaw)) return {};
    if (has(Role::roll) && has(Role::pitch)) return {Role::roll, Role::pitch, Role::yaw};
    const bool is_planar = has(Role::x) && has(Role::y) && !has(Role::z);
    return is_planar ? std::vector{Role::yaw} : std::vector<Role>{};
  }

  /// Roles of a pose: time, position, and a quaternion in the order of kPoseColumns, or angles.
  std::vector<Role> roles(bool with_rotation) const {
    std::vector<Role> out{Role::time};
    const Role first = is_geodetic() ? Role::latitude : Role::x;
    const std::vector<Role> rotation = angles();
    const std::size_t axes = rotation.size() == 1 ? 2 : 3;
    for (std::size_t i = 0; i < axes; ++i) {
      const bool is_height = i == 2 && first == Role::x && !has(Role::z) && has(Role::height);
      out.push_back(is_height ? Role::height : after(first, i));  // easting, northing, altitude
    }
    if (!rotation.empty()) {
      out.insert(out.end(), rotation.begin(), rotation.end());
    } else {
      for (std::size_t i = 0; with_rotation && i < 4; ++i) out.push_back(after(Role::qw, i));
    }
    return out;
  }

  /// Names of columns that have no meaning; `used` are the indices of others.
  std::string unknown(const std::vector<std::size_t>& used = {}) const {
    constexpr std::size_t kMost = 6;
    std::string out;
    std::size_t count = 0;
    for (std::size_t i = 0; i < names.size(); ++i) {
      const bool is_used = used.empty() ? meanings[i].has_value() : std::ranges::count(used, i) > 0;
      if (is_used || names[i].empty()) continue;
      if (++count <= kMost) out += (count == 1 ? "" : ", ") + shortened(names[i]);
    }
    return out + (count > kMost ? ", ..." : "");
  }
};

}  // namespace loopbench
