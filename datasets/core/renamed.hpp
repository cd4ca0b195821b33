/// Names of options, their values and metrics that were replaced. An old name is rejected and the
/// new one named.
#pragma once

#include <array>
#include <string>
#include <string_view>

namespace loopbench {

/// `before` became `now`. `owner` is the dataset, method or metric that has the option; empty for
/// the name of a metric.
struct RenamedName {
  std::string_view owner;
  std::string_view before;
  std::string_view now;
};

inline constexpr std::array kRenamedNames{
    RenamedName{"", "body_offset", "extrinsic_offset"},
    RenamedName{"extrinsic_offset", "turn", "rotation"},
    RenamedName{"diagnostics", "loss", "tracking_gap"},
    RenamedName{"diagnostics", "standing", "rest_speed"},
    RenamedName{"along_cross", "standing", "rest_speed"},
    RenamedName{"simulated", "shake.sigma_t", "white_noise.sigma_t"},
    RenamedName{"simulated", "shake.sigma_r", "white_noise.sigma_r"},
    RenamedName{"motion_drift", "prior.scale_spread", "prior.common_dispersion"},
    RenamedName{"motion_drift", "prior.steady_spread", "prior.drift_dispersion"},
    RenamedName{"motion_drift", "prior.axis_spread", "prior.axis_dispersion"},
    RenamedName{"motion_drift", "prior.share_spread", "prior.term_dispersion"},
    RenamedName{"motion_drift", "prior.stated_spread", "prior.stated_dispersion"},
    RenamedName{"motion_drift", "prior.closures_spread", "prior.closures_dispersion"},
    RenamedName{"motion_drift", "prior.noise_part", "prior.noise_ratio"},
    RenamedName{"motion_drift", "prior.stated_part", "prior.stated_fraction"},
    RenamedName{"motion_drift", "prior.steady_after", "prior.drift_after"},
    RenamedName{"motion_drift", "prior.scale_dispersion", "prior.common_dispersion"},
    RenamedName{"motion_drift", "prior.steady_dispersion", "prior.drift_dispersion"},
    RenamedName{"motion_drift", "prior.share_dispersion", "prior.term_dispersion"},
    RenamedName{"motion_drift", "prior.as_stated_chance", "prior.as_stated_probability"},
    RenamedName{"motion_drift", "prior.scaled_chance", "prior.scaled_probability"},
    RenamedName{"motion_drift", "prior.steady_chance", "prior.drift_probability"},
    RenamedName{"motion_drift", "draw_steps", "thinning"},
    RenamedName{"motion_drift", "warm_up", "burn_in"},
};

/// Value `before` of the option became `now`, for every owner of the option.
struct RenamedValue {
  std::string_view option;
  std::string_view before;
  std::string_view now;
};

inline constexpr std::array kRenamedValues{
    RenamedValue{"overlap", "whole", "all"},
};

/// The value that replaced `value` of the option, or nothing. O(values).
constexpr std::string_view replaced_value(std::string_view option, std::string_view value) {
  for (const RenamedValue& renamed : kRenamedValues) {
    if (renamed.option == option && renamed.before == value) return renamed.now;
  }
  return {};
}

/// The name in `known` that replaced `name`, or nothing. O(names).
template <class Names>
std::string_view replacement(std::string_view name, const Names& known) {
  for (const RenamedName& renamed : kRenamedNames) {
    if (renamed.before != name) continue;
    for (const auto& each : known) {
      if (each == renamed.now) return renamed.now;
    }
  }
  return {};
}

/// The first name of option `now` of `owner`. Texts that seed random numbers use it, so that a new
/// name draws the same numbers. O(names).
constexpr std::string_view first_name(std::string_view owner, std::string_view now) {
  for (const RenamedName& renamed : kRenamedNames) {
    if (renamed.owner == owner && renamed.now == now) return renamed.before;
  }
  return now;
}

/// "was renamed to 'x'".
inline std::string renamed_to(std::string_view now) {
  return "was renamed to '" + std::string(now) + "'";
}

}  // namespace loopbench
