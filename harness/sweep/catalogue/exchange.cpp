#include "harness/sweep/catalogue/exchange.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <set>
#include <stdexcept>
#include <utility>

#include "datasets/core/fields.hpp"
#include "datasets/derive/problem_graph.hpp"
#include "datasets/files/replace_file.hpp"
#include "datasets/formats/formats.hpp"
#include "harness/sweep/process/write_file.hpp"
#include "metrics/evaluation/evaluation.hpp"

namespace loopbench::harness {
namespace {

constexpr double kSameStamp = 1e-4;                               // [s]
constexpr std::uintmax_t kMostBytes = std::uintmax_t{256} << 20;  // of a result
constexpr std::uintmax_t kMostBytesPerPose = 4096;                // of a result

Trajectory read_poses(const std::filesystem::path& file, const Problem& problem) {
  const Format format = detect_format(file);
  if (format == Format::tum) return read_trajectory(file);
  if (format != Format::g2o) {
    throw InputError("result: has format " + to_text(format) + ", expected tum or g2o");
  }
  // Only its vertices are used: programs write information with six digits.
  const PoseGraph graph = read_g2o(file, {.indefinite = IndefiniteInformation::project});
  if (graph.vertices.empty()) throw InputError("result: has no VERTEX lines");
  if (graph.ids.size() != problem.keyframes.size()) {
    throw InputError(fmt::format("result: has {} vertices, expected {}, one per keyframe",
                                 graph.ids.size(),
                                 problem.keyframes.size()));
  }
  Trajectory out;
  for (std::size_t i = 0; i < graph.ids.size(); ++i) {
    if (graph.ids[i] != static_cast<std::int64_t>(i)) {
      throw InputError(fmt::format("result: has vertex {}, expected {}", graph.ids[i], i));
    }
    out.push_back({problem.keyframes[i].stamp, graph.vertices[i]});
  }
  return out;
}

void require_cover(Trajectory& poses, const Problem& problem, const std::string& name) {
  const double begin = problem.keyframes.front().stamp;
  const double end = problem.keyframes.back().stamp;
  if (poses.size() < 2 || poses.front().stamp > begin + kSameStamp ||
      poses.back().stamp < end - kSameStamp) {
    throw std::runtime_error(
        fmt::format("{}: covers {} to {} s, expected the keyframes, {} to {} s",
                    name,
                    poses.empty() ? 0.0 : poses.front().stamp,
                    poses.empty() ? 0.0 : poses.back().stamp,
                    begin,
                    end));
  }
  poses.front().stamp = std::min(poses.front().stamp, begin);
  poses.back().stamp = std::max(poses.back().stamp, end);
}

}  // namespace

ProgramCosts& program_costs() {
  static thread_local ProgramCosts costs;
  return costs;
}

void add_costs(double cpu_seconds, std::int64_t peak_memory) {
  ProgramCosts& costs = program_costs();
  costs.is_measured = true;
  costs.cpu_seconds += cpu_seconds;
  costs.peak_memory = std::max(costs.peak_memory, peak_memory);
}

void settle_costs(methods::Report& report) {
  std::set<std::string> removed;
  const auto remove = [&](auto& items, const std::set<std::string>& reserved) {
    std::erase_if(items, [&](const auto& item) {
      const bool is_reserved = reserved.contains(item.name);
      if (is_reserved) removed.insert(item.name);
      return is_reserved;
    });
  };
  remove(report.counts, {kProgramTime, kProgramMemory});
  remove(report.phases, {kExchangePhase, kWallPhase});
  for (const std::string& name : removed) {
    report.notes.push_back("'" + name +
                           "' is measured by loopbench: what the method states is ignored");
  }
  const ProgramCosts costs = std::exchange(program_costs(), {});
  if (!costs.is_measured) return;
  report.count(kProgramTime, costs.cpu_seconds);
  report.count(kProgramMemory, static_cast<double>(costs.peak_memory));
  report.phases.insert(report.phases.begin(),
                       methods::Phase{kExchangePhase, costs.exchange_seconds});
  if (costs.stated_run) {
    report.phases.insert(report.phases.begin(), methods::Phase{kWallPhase, *costs.stated_run});
  }
}

void write_problem(const std::filesystem::path& folder, const Problem& problem) {
  const WithoutSync of_exchange;
  PoseGraph graph = problem_graph(problem, problem.keyframes);
  for (Edge& edge : graph.edges) edge.scale_information = 0.0;  // version 1 has 21 numbers
  write_g2o(folder / "graph.g2o", graph);
  write_tum(folder / "keyframes.txt", problem.keyframes);
  write_tum(folder / "frames.txt", problem.frames);
  nlohmann::json closures = nlohmann::json::array();
  for (const Edge& edge : problem.closures) closures.push_back({edge.from, edge.to});
  const nlohmann::json out = {
      {"exchange", kExchangeVersion},
      {"keyframes", problem.keyframes.size()},
      {"frames", problem.frames.size()},
      {"odometry", problem.odometry.size()},
      {"planar", problem.planar},
      {"similarity", graph.similarity},
      {"ids", graph.ids},
      {"stamps", stamps(problem.keyframes)},
      {"closures", closures},
      {"units",
       {{"stamps", "s"},
        {"translation", "m"},
        {"information", "1/m^2, 1/m, 1 (g2o: vector part of quaternion)"}}}};
  write_file(folder / "problem.json", out.dump() + "\n");
}

Trajectory checked_result(Trajectory poses,
                          const Problem& problem,
                          ResultPoses expected,
                          const std::string& name) {
  const Trajectory& keyframes = problem.keyframes;
  if (expected == ResultPoses::dense) {
    check(poses, name);
    require_cover(poses, problem, name);
    return poses;
  }
  if (poses.size() != keyframes.size()) {
    throw std::runtime_error(fmt::format(
        "{}: has {} poses, expected {}, one per keyframe", name, poses.size(), keyframes.size()));
  }
  for (std::size_t i = 0; i < poses.size(); ++i) {
    if (!(std::abs(poses[i].stamp - keyframes[i].stamp) <= kSameStamp)) {
      throw std::runtime_error(fmt::format("{}: pose {} has stamp {}, expected {} of the keyframe",
                                           name,
                                           i,
                                           to_text(poses[i].stamp),
                                           to_text(keyframes[i].stamp)));
    }
    poses[i].stamp = keyframes[i].stamp;
  }
  check(poses, name);
  return poses;
}

Trajectory read_result(const std::filesystem::path& file,
                       const Problem& problem,
                       ResultPoses poses) {
  std::error_code none;
  if (!std::filesystem::exists(std::filesystem::symlink_status(file, none))) {
    throw std::runtime_error("the program wrote no result");
  }
  if (!std::filesystem::is_regular_file(std::filesystem::symlink_status(file, none))) {
    throw std::runtime_error("result: is not a regular file");
  }
  const std::uintmax_t most = kMostBytes + kMostBytesPerPose * problem.keyframes.size();
  if (const std::uintmax_t bytes = std::filesystem::file_size(file, none); bytes > most) {
    throw std::runtime_error(fmt::format("result: has {} bytes, expected at most {}", bytes, most));
  }
  try {
    return checked_result(read_poses(file, problem), problem, poses, "result");
  } catch (const InputError& error) {
    std::string why = error.what();
    const std::string path = file.string();
    for (std::size_t at = 0; (at = why.find(path, at)) != std::string::npos;) {
      why.replace(at, path.size(), "result");
    }
    throw std::runtime_error(why);
  }
}

void require_keys(const nlohmann::json& object,
                  const std::vector<std::string>& known,
                  const std::string& where) {
  if (!object.is_object()) throw std::runtime_error(where + ": expected a JSON object");
  for (const auto& [key, value] : object.items()) {
    if (std::ranges::count(known, key) > 0) continue;
    throw std::runtime_error(
        fmt::format("{}: found key '{}', expected {}", where, key, fmt::join(known, ", ")));
  }
}

ResultMetadata parse_metadata(const std::string& text) {
  static const std::vector<std::string> kKeys{
      "status", "why", "seconds", "iterations", "counts", "phases", "notes", "poses", "scores"};
  ResultMetadata out;
  try {
    const nlohmann::json json = nlohmann::json::parse(text);
    require_keys(json, kKeys, "result.json");
    out.status = json.value("status", out.status);
    out.why = json.value("why", out.why);
    out.seconds = json.value("seconds", out.seconds);
    if (json.contains("iterations")) {
      out.report.count("iterations", json["iterations"].get<double>());
    }
    const nlohmann::json none = nlohmann::json::object();
    const nlohmann::json counts = json.value("counts", none);  // items() refers to it
    for (const auto& [name, value] : counts.items()) out.report.count(name, value.get<double>());
    const nlohmann::json phases = json.value("phases", none);
    for (const auto& [name, value] : phases.items()) {
      out.report.phases.push_back({name, value.get<double>()});
    }
    for (const auto& note : json.value("notes", nlohmann::json::array())) {
      out.report.notes.push_back(note.get<std::string>());
    }
  } catch (const nlohmann::json::exception& error) {
    throw std::runtime_error(std::string("result.json: ") + error.what());
  }
  return out;
}

void require_ok(const ResultMetadata& metadata) {
  if (metadata.status == "ok") return;
  const std::string why = metadata.why.empty() ? "the program gave no reason" : metadata.why;
  if (metadata.status == "declined") throw metrics::Undefined(why);
  if (metadata.status == "failed") throw std::runtime_error(why);
  throw std::runtime_error("result.json: status is '" + metadata.status +
                           "', expected ok, declined or failed");
}

void add_statements(methods::Report& report, const ResultMetadata& metadata) {
  const auto append = [](auto& to, const auto& from) {
    to.insert(to.end(), from.begin(), from.end());
  };
  append(report.counts, metadata.report.counts);
  append(report.phases, metadata.report.phases);
  append(report.notes, metadata.report.notes);
}

double time_of_run(methods::Report& report, const ResultMetadata& metadata, double wall) {
  if (metadata.seconds > wall) {
    report.notes.push_back(fmt::format(
        "result.json states {} s, but the program ran for {:.3g} s", metadata.seconds, wall));
  }
  const bool is_stated = metadata.seconds >= 0.0 && metadata.seconds <= wall;
  report.notes.push_back(std::string("time: ") +
                         (is_stated ? "as stated by the program" : kWallPhase));
  if (!is_stated) return wall;
  program_costs().stated_run = program_costs().stated_run.value_or(0.0) + wall;
  return metadata.seconds;
}

}  // namespace loopbench::harness
