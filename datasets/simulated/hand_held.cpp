// Hand-held loops: each coordinate is a sum of sine waves of a phase that advances unevenly in
// time.
#include <array>
#include <numbers>

#include "datasets/simulated/path.hpp"

namespace loopbench {
namespace {

/// amplitude * sin(cycles * angle + phase)
struct Wave {
  double amplitude;
  double cycles;  // per lap
  double phase;   // [rad]
};
using Waves = std::array<Wave, 3>;

double sum(const Waves& waves, double angle) {
  double out = 0.0;
  for (const auto& [amplitude, cycles, phase] : waves) {
    out += amplitude * std::sin(cycles * angle + phase);
  }
  return out;
}

struct HandHeld {
  double duration;         // [s]
  double facing;           // 0: outwards, pi: inwards [rad]
  Waves phase_offset;      // offset of the phase from uniform motion, over time [rad]
  Waves x, y, z;           // over the phase [m]
  Waves yaw, pitch, roll;  // over the phase [rad]

  Pose at(double time) const {
    const double uniform_phase = 2.0 * std::numbers::pi * time / duration;
    const double angle = uniform_phase + sum(phase_offset, uniform_phase);
    return {rotation_from_yaw_pitch_roll(
                angle + facing + sum(yaw, angle), sum(pitch, angle), sum(roll, angle)),
            {sum(x, angle), sum(y, angle), sum(z, angle)}};
  }
};

// Irrational number of cycles per lap, so that laps do not repeat exactly.
constexpr double kAperiodic = std::numbers::sqrt2 - 1.0;

// Amplitudes were fitted to the keyframe statistics in tests/datasets/simulated_path_test.cpp.
constexpr HandHeld kRoom{.duration = 48.9,
                         .facing = 0.0,
                         .phase_offset = {{{0.075, 2, -0.152}, {0.106, 5, -0.122}}},
                         .x = {{{0.999, 1, std::numbers::pi / 2},
                                {0.279, 8, std::numbers::pi / 2 + 2.309},
                                {0.02, kAperiodic, 0}}},
                         .y = {{{0.792, 1, 0}, {0.317, 8, -0.957}, {0.02, kAperiodic, 2}}},
                         .z = {{{0.088, 2, 0.5}, {-0.174, 5, 1}, {0.02, kAperiodic, 4}}},
                         .yaw = {{{0.4, 3, 1}, {0.3, 11, 0.3}, {0.03, kAperiodic, 1}}},
                         .pitch = {{{0.2, 4, 2}, {0.25, 13, 1}, {0.02, kAperiodic, 3}}},
                         .roll = {{{0.1, 5, 0}, {0.2, 17, 2}, {0.02, kAperiodic, 5}}}};

constexpr HandHeld kOffice{.duration = 87.09,
                           .facing = std::numbers::pi,
                           .phase_offset = {{{-0.042, 2, 4.547}, {0.033, 5, -3.754}}},
                           .x = {{{2.297, 1, std::numbers::pi / 2},
                                  {0.431, 7, std::numbers::pi / 2 + 2.887},
                                  {0.02, kAperiodic, 0}}},
                           .y = {{{2.022, 1, 0}, {0.424, 7, 2.546}, {0.02, kAperiodic, 2}}},
                           .z = {{{0.21, 2, 0.5}, {-0.076, 5, 1}, {0.02, kAperiodic, 4}}},
                           .yaw = {{{0.2, 3, 2}, {0.15, 13, 0.7}, {0.03, kAperiodic, 2}}},
                           .pitch = {{{0.12, 4, 1}, {0.13, 16, 2}, {0.02, kAperiodic, 4}}},
                           .roll = {{{0.06, 5, 1}, {0.09, 21, 0}, {0.02, kAperiodic, 0}}}};

Path path(const HandHeld& walk, std::int64_t keyframes) {
  return {walk.duration, keyframes, 30.0, 0.3, [&walk](double time) { return walk.at(time); }};
}

}  // namespace

Path room_path() { return path(kRoom, 180); }
Path office_path() { return path(kOffice, 204); }

}  // namespace loopbench
