#include "datasets/derive/closure_file.hpp"

#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <fstream>
#include <sstream>
#include <string>

#include "datasets/derive/odometry.hpp"

namespace loopbench {
namespace {

constexpr const char* kColumns = "stamp_from stamp_to tx ty tz qx qy qz qw [sigma_t sigma_r]";

std::vector<double> numbers(const std::string& line, const InputError& refusal) {
  std::istringstream words(line);
  std::vector<double> out;
  for (std::string word; words >> word;) {
    double value = 0.0;
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
    if (error != std::errc() || end != word.data() + word.size() || !std::isfinite(value)) {
      throw InputError(fmt::format("{}found '{}', expected a number", refusal.what(), word));
    }
    out.push_back(value);
  }
  return out;
}

TimedClosure parse(const std::vector<double>& v, const ClosureNoise& noise, const char* where) {
  const auto refuse = [&](const std::string& what) { return InputError(where + what); };
  if (v.size() != 9 && v.size() != 11) {
    throw refuse(fmt::format("found {} numbers, expected 9 or 11: {}", v.size(), kColumns));
  }
  TimedClosure closure{v[0], v[1], {Rotation(v[8], v[5], v[6], v[7]), {v[2], v[3], v[4]}}, noise};
  const double norm = closure.from_from_to.rotation.norm();
  if (std::abs(norm - 1.0) > 0.01) {
    throw refuse(fmt::format("found a quaternion of norm {}, expected 1", norm));
  }
  closure.from_from_to.rotation.normalize();
  if (v.size() == 11) closure.noise = {v[9], v[10]};
  if (!(closure.noise.sigma_t > 0.0 && closure.noise.sigma_r > 0.0)) {
    throw refuse("found a sigma of 0 or less, expected more than 0");
  }
  return closure;
}

}  // namespace

std::vector<TimedClosure> read_closure_file(const std::filesystem::path& file,
                                            const ClosureNoise& noise) {
  std::ifstream in(file);
  if (!in) throw input_error(file.string(), 0, "cannot be opened");
  std::vector<TimedClosure> out;
  std::size_t number = 0;
  for (std::string line; std::getline(in, line);) {
    ++number;
    const InputError where = input_error(file.string(), number, "");
    const std::vector<double> values = numbers(line.substr(0, line.find('#')), where);
    if (values.empty()) continue;
    out.push_back(parse(values, noise, where.what()));
    out.back().line = number;
  }
  return out;
}

std::vector<Edge> as_edges(const std::vector<TimedClosure>& closures,
                           const Trajectory& poses,
                           double max_diff,
                           const std::filesystem::path& file) {
  std::vector<Edge> edges;
  for (const TimedClosure& closure : closures) {
    const auto pose_at = [&](double stamp) {
      const auto index = nearest_pose(poses, stamp, max_diff);
      if (index) return *index;
      throw input_error(
          file.string(),
          closure.line,
          fmt::format("found stamp {:.6f}, expected one within {} s of a pose of the estimate",
                      stamp,
                      max_diff));
    };
    const auto& [sigma_t, sigma_r] = closure.noise;
    Edge edge{pose_at(closure.stamp_from),
              pose_at(closure.stamp_to),
              closure.from_from_to,
              isotropic_information(sigma_t * sigma_t, sigma_r * sigma_r)};
    if (edge.from == edge.to) {
      throw input_error(file.string(), closure.line, "both stamps are the same pose");
    }
    if (edge.from > edge.to) {
      std::swap(edge.from, edge.to);
      edge.from_from_to = edge.from_from_to.inverse();
      const Matrix6 carry = adjoint(closure.from_from_to.inverse());
      edge.information = carry.transpose() * edge.information * carry;
    }
    edges.push_back(edge);
  }
  sort_closures(edges);
  return edges;
}

}  // namespace loopbench
