#include "harness/eval/evo_results.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <set>

#include "datasets/compressed/decompress.hpp"
#include "datasets/compressed/zip.hpp"
#include "datasets/core/error.hpp"
#include "datasets/formats/regular_file.hpp"
#include "harness/eval/recorded_runs.hpp"
#include "metrics/numerics/angle.hpp"

namespace loopbench::harness {
namespace {

using EvoJson = nlohmann::ordered_json;

constexpr std::size_t kLargestEvoResult = std::size_t{1} << 30;  // [bytes]

/// The texts of info.json and stats.json by name; empty if the file is no archive with both.
std::map<std::string, std::string> evo_texts(const std::filesystem::path& file) {
  std::map<std::string, std::string> out;
  const std::string bytes = read_regular_file(file, kLargestEvoResult, "file");
  if (!is_zip(bytes)) return out;
  try {
    for (ZipMember& member : zip_members(bytes, kLargestEvoResult)) {
      const bool is_wanted = member.name == "info.json" || member.name == "stats.json";
      if (is_wanted) out[member.name] = std::move(member.content);
    }
  } catch (const DamagedStream& damage) {
    throw InputError(file.string() + ": cannot be read: " + damage.what());
  }
  if (out.size() < 2) out.clear();
  return out;
}

Record evo_record(const std::string& file) {
  std::map<std::string, std::string> texts = evo_texts(file);
  const EvoJson info = EvoJson::parse(texts["info.json"], nullptr, false);
  const EvoJson stats = EvoJson::parse(texts["stats.json"], nullptr, false);
  if (!info.is_object() || !stats.is_object()) {
    throw InputError(file + ": expected a result of evo with info.json and stats.json");
  }
  const auto text = [&](const char* key) {
    const auto found = info.find(key);
    return found != info.end() && found->is_string() ? found->get<std::string>() : std::string();
  };
  const auto number = [&](const char* key) {
    const auto found = stats.find(key);
    if (found != stats.end() && found->is_number()) return found->get<double>();
    throw InputError(file + ": stats.json has no number '" + key + "'");
  };
  Record out;
  std::string title = text("title");
  for (std::size_t at = 0; (at = title.find('\n', at)) != title.npos;) title.replace(at, 1, " ");
  const std::string unit = text("label");  // "APE (m)"
  const std::size_t open = unit.rfind('(');
  out.label = title;
  out.metric = unit.starts_with("RPE") ? "rpe" : "ape";
  out.unit = open == unit.npos ? "" : unit.substr(open + 1, unit.find(')', open) - open - 1);
  out.relation = out.unit == "m" ? "translation" : "rotation";
  out.axis = "3d";
  out.protocol = "evo";
  out.times = "keyframes";
  out.sequence = text("ref_name");
  out.method = text("est_name");
  metrics::Statistics& s = out.statistics;
  s = {0,
       number("rmse"),
       number("mean"),
       number("median"),
       number("std"),
       number("min"),
       number("max"),
       number("sse"),
       std::nan(""),  // evo writes no percentiles
       std::nan(""),
       std::nan("")};
  if (s.rmse > 0.0) s.count = static_cast<std::size_t>(std::llround(s.sse / (s.rmse * s.rmse)));
  return out;
}

/// A file of numpy with a list of doubles, or a matrix of so many columns.
std::string npy_of(const std::vector<double>& values, std::size_t columns = 1) {
  std::string header = fmt::format("{{'descr': '<f8', 'fortran_order': False, 'shape': ({},{})}}",
                                   values.size() / columns,
                                   columns == 1 ? "" : fmt::format(" {}", columns));
  constexpr std::size_t kAlignment = 64, kPrefix = 10;
  header.append(kAlignment - 1 - (kPrefix + header.size()) % kAlignment, ' ');
  header += '\n';
  const auto size = static_cast<std::uint16_t>(header.size());
  std::string out("\x93NUMPY\x01\x00", 8);
  out.append(reinterpret_cast<const char*>(&size), sizeof(size));
  out += header;
  return out.append(reinterpret_cast<const char*>(values.data()), values.size() * sizeof(double));
}

std::string alignment_title(const EvaluationResult& result) {
  switch (result.alignment.type) {
    case metrics::Align::se3:
      return "(with SE(3) Umeyama alignment)";
    case metrics::Align::sim3:
      return "(with Sim(3) Umeyama alignment)";
    case metrics::Align::scale:
      return "(scale corrected)";
    case metrics::Align::origin:
      return "(with origin alignment)";
    case metrics::Align::none:
      return "(not aligned)";
    default:
      return "(with " + to_text(result.alignment.type) + " alignment)";
  }
}

std::vector<double> alignment_matrix(const metrics::Alignment& alignment) {
  const Matrix3 r = alignment.scale * alignment.reference_from_estimate.rotation.toRotationMatrix();
  const Vector3& t = alignment.reference_from_estimate.translation;
  std::vector<double> out;
  for (int i = 0; i < 3; ++i) out.insert(out.end(), {r(i, 0), r(i, 1), r(i, 2), t[i]});
  out.insert(out.end(), {0.0, 0.0, 0.0, 1.0});
  return out;
}

/// Name of a result file, or its path if another file has that name, without ".zip".
std::string name_of_result(const std::string& file, const std::vector<std::string>& files) {
  const auto stem = [](const std::string& of) { return std::filesystem::path(of).stem(); };
  const bool is_unique = std::ranges::count(files, stem(file), stem) == 1;
  return is_unique ? stem(file).string() : std::filesystem::path(file).replace_extension().string();
}

/// Whether the runs have one method, and some of them the same sequence.
bool are_runs_of_one_method(const std::vector<RecordedRun>& runs) {
  std::set<std::string> methods, sequences;
  for (const RecordedRun& run : runs) {
    methods.insert(run.method);
    sequences.insert(run.sequence);
  }
  return methods.size() == 1 && sequences.size() < runs.size();
}

/// The records of each title, in the order of the first ones.
std::vector<std::vector<Record>> by_title(const std::vector<Record>& records) {
  std::vector<std::vector<Record>> out;
  for (const Record& record : records) {
    auto known = std::ranges::find_if(
        out, [&](const std::vector<Record>& group) { return group.front().label == record.label; });
    if (known == out.end()) known = out.emplace(out.end());
    known->push_back(record);
  }
  return out;
}

}  // namespace

bool is_evo_result(const std::filesystem::path& file) {
  return std::filesystem::is_regular_file(file) && file.extension() == ".zip" &&
         !evo_texts(file).empty();
}

std::vector<Record> read_evo_results(const std::vector<std::string>& files) {
  std::vector<Record> out;
  std::set<std::string> known;
  bool are_different = true;
  for (const std::string& file : files) {
    const Record& record = out.emplace_back(evo_record(file));
    const std::string key = record.label + "\n" + record.sequence + "\n" + record.method;
    are_different &= known.insert(key).second;
  }
  std::map<SharedText, std::vector<std::size_t>> titles;
  for (std::size_t i = 0; i < files.size(); ++i) titles[out[i].label].push_back(i);
  for (const auto& [title, places] : titles) {
    std::vector<FilePair> pairs;
    for (const std::size_t i : places) {
      pairs.push_back({out[i].sequence.text(), are_different ? out[i].method.text() : files[i]});
    }
    std::vector<RecordedRun> runs = labelled_runs(pairs, "");
    if (are_runs_of_one_method(runs)) {
      for (std::size_t k = 0; k < places.size(); ++k) {
        runs[k].method = name_of_result(files[places[k]], files);
      }
    }
    std::map<std::pair<std::string, std::string>, std::int64_t> repeats;
    for (std::size_t k = 0; k < places.size(); ++k) {
      Record& record = out[places[k]];
      record.cell = static_cast<std::int64_t>(places[k]);
      record.sequence = runs[k].sequence;
      record.method = runs[k].method;
      record.repeat = repeats[{runs[k].sequence, runs[k].method}]++;
    }
  }
  return out;
}

std::vector<Table> evo_result_tables(const std::vector<Record>& records,
                                     const std::vector<std::string>& files) {
  std::vector<Table> out;
  for (const std::vector<Record>& group : by_title(records)) {
    Table& table =
        out.emplace_back(Table{group.front().label.text(),
                               {"estimate", "rmse", "mean", "median", "std", "min", "max", "count"},
                               {},
                               {}});
    const auto name = [](const Record& r) { return r.sequence + " / " + r.method; };
    for (const Record& r : group) {
      std::vector<TableCell>& line = table.lines.emplace_back();
      const std::string& file = files[static_cast<std::size_t>(r.cell)];
      const bool is_unique = std::ranges::count(group, name(r), name) == 1;
      line.push_back({is_unique ? name(r) : name(r) + " (" + name_of_result(file, files) + ")"});
      const metrics::Statistics& s = r.statistics;
      for (const double value : {s.rmse, s.mean, s.median, s.std, s.min, s.max}) {
        line.push_back({fixed(value, decimals(s.rmse))});
      }
      line.push_back({std::to_string(s.count)});
    }
  }
  return out;
}

std::string evo_result_zip(const EvaluationResult& result, const std::string& relation) {
  struct Kind {
    const char* words;
    const char* unit;
    double per_radian;  ///< 0: of positions
  };
  static const std::map<std::string, Kind> kKinds{
      {"", {"translation part", "m", 0.0}},
      {"trans_part", {"translation part", "m", 0.0}},
      {"point_distance", {"point distance", "m", 0.0}},
      {"angle_deg", {"rotation angle in degrees", "deg", metrics::kDegrees}},
      {"angle_rad", {"rotation angle in radians", "rad", 1.0}}};
  const auto kind = kKinds.find(relation);
  if (kind == kKinds.end()) {
    throw InputError("--save_results: found relation " + relation +
                     ", expected trans_part, point_distance, angle_deg or angle_rad");
  }
  const auto [words, unit, per_radian] = kind->second;
  std::vector<double> errors, stamps, seconds;
  for (const metrics::PoseError& pose : result.poses) {
    errors.push_back(per_radian == 0.0 ? pose.metres.norm() : per_radian * pose.radians.norm());
    stamps.push_back(pose.estimate_stamp);
    seconds.push_back(pose.estimate_stamp - stamps.front());
  }
  if (errors.empty() || std::ranges::any_of(errors, [](double e) { return !std::isfinite(e); })) {
    throw InputError("--save_results: " + result.estimate + " has no such errors");
  }
  const metrics::Statistics s = metrics::statistics(errors);
  const EvoJson info{
      {"title", fmt::format("APE w.r.t. {} ({})\n{}", words, unit, alignment_title(result))},
      {"label", fmt::format("APE ({})", unit)},
      {"ref_name", result.reference},
      {"est_name", result.estimate}};
  const EvoJson stats{{"rmse", s.rmse},
                      {"mean", s.mean},
                      {"median", s.median},
                      {"std", s.std},
                      {"min", s.min},
                      {"max", s.max},
                      {"sse", s.sse}};
  const auto dumped = [](const EvoJson& json) {
    return json.dump(-1, ' ', false, EvoJson::error_handler_t::replace);
  };
  std::vector<ZipMember> members{{"info.json", dumped(info)},
                                 {"stats.json", dumped(stats)},
                                 {"error_array.npy", npy_of(errors)},
                                 {"seconds_from_start.npy", npy_of(seconds)},
                                 {"timestamps.npy", npy_of(stamps)}};
  if (result.alignment.type != metrics::Align::none) {
    members.push_back(
        {"alignment_transformation_sim3.npy", npy_of(alignment_matrix(result.alignment), 4)});
  }
  return zip_of(members);
}

}  // namespace loopbench::harness
