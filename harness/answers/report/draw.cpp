#include "harness/answers/report/draw.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>
#include <system_error>

#include "datasets/core/error.hpp"
#include "harness/sweep/process/child_process.hpp"
#include "harness/sweep/text/printable.hpp"

namespace loopbench::harness {
namespace {

nlohmann::json json_of(const DrawnCurve& curve) {
  nlohmann::json out{{"name", printable(curve.name)}, {"style", curve.style}};
  if (curve.dash > 0) out["dash"] = curve.dash;
  if (curve.rmse) out["rmse"] = *curve.rmse;
  for (const auto& [name, values] : curve.columns) out[name] = values;
  return out;
}

nlohmann::json json_of(const DrawnFigure& figure) {
  std::vector<std::string> files;
  for (const std::filesystem::path& file : figure.files) files.push_back(file.string());
  const FigureOptions& options = figure.options;
  nlohmann::json out{{"files", files},
                     {"panels", figure.panels},
                     {"script", options.script},
                     {"style", options.style}};
  if (!options.plane.empty()) out["plane"] = options.plane;
  if (!options.size.empty() && options.size.size() != 2) {
    throw InputError(
        fmt::format("--size: expected WIDTH,HEIGHT, found {} numbers", options.size.size()));
  }
  if (!options.size.empty()) out["size"] = options.size;
  if (options.columns) out["columns"] = *options.columns;
  if (options.font) out["font"] = *options.font;
  return out;
}

nlohmann::json json_of(const FigureData& data) {
  nlohmann::json out{{"title", printable(data.title)},
                     {"note", printable(data.note)},
                     {"curves", nlohmann::json::array()},
                     {"figures", nlohmann::json::array()}};
  for (const DrawnCurve& curve : data.curves) out["curves"].push_back(json_of(curve));
  if (!data.scores.empty()) out["scores"] = nlohmann::json::parse(data.scores);
  for (const DrawnFigure& figure : data.figures) out["figures"].push_back(json_of(figure));
  return out;
}

/// The script beside the program: in a build folder, or installed.
std::filesystem::path script() {
  namespace fs = std::filesystem;
  const fs::path folder = fs::read_symlink("/proc/self/exe").parent_path();
  for (const char* const place : {"python", "../share/loopbench/python"}) {
    const fs::path file = (folder / place / "loopbench" / "render.py").lexically_normal();
    if (fs::exists(file)) return file;
  }
  throw InputError("figures need the Python files of loopbench, which are not installed in " +
                   (folder.parent_path() / "share/loopbench/python").string());
}

struct Ended {
  int exit_code = 0;
  std::string output;  ///< of its standard output; standard error is ours
};

/// Runs render.py on this standard input.
Ended run_python(const std::string& input) {
  using File = std::unique_ptr<std::FILE, int (*)(std::FILE*)>;
  const File in(std::tmpfile(), std::fclose), out(std::tmpfile(), std::fclose);
  if (!in || !out || std::fwrite(input.data(), 1, input.size(), in.get()) != input.size() ||
      std::fflush(in.get()) != 0) {
    throw InputError(std::string("figures need a temporary file, which cannot be written: ") +
                     std::strerror(errno));
  }
  std::rewind(in.get());
  ProgramCall call;
  call.arguments = {"python3", script().string()};
  call.input = fileno(in.get());
  call.output = fileno(out.get());
  Ended ended;
  try {
    ended.exit_code = ChildProcess(ProcessGroup::shared, call).exit_code();
  } catch (const std::system_error& error) {
    if (error.code() == std::errc::no_such_file_or_directory) {
      throw InputError("python3 is not installed (package python3-matplotlib)");
    }
    throw InputError(std::string("python3 cannot be started: ") + error.what());
  }
  std::rewind(out.get());
  for (int c; (c = std::fgetc(out.get())) != EOF;) ended.output += static_cast<char>(c);
  return ended;
}

Vector3 origin_of(const std::optional<SequenceTrace>& trace) {
  if (!trace) return Vector3::Zero();
  return {trace->origin.x, trace->origin.y, trace->origin.z};
}

DrawnCurve curve_of(const SequenceTrace& trace) {
  DrawnCurve out = reference_curve();
  for (const TracePose& p : trace.reference) {
    add_position(out, origin_of(trace) + Vector3(p.x, p.y, p.z));
  }
  out.is_thin = true;
  return out;
}

/// Distances are along the path of the reference.
DrawnCurve curve_of(const CellTrace& trace, const Vector3& origin) {
  DrawnCurve out;
  for (const TraceSample& s : trace.samples) {
    add_position(out, origin + Vector3(s.estimate.x, s.estimate.y, s.estimate.z));
    out.columns["distance"].push_back(s.estimate.distance);
    out.columns["error_x"].push_back(s.error_x);
    out.columns["error_y"].push_back(s.error_y);
    out.columns["error_z"].push_back(s.error_z);
    out.columns["angle"].push_back(s.error_angle);
  }
  out.is_thin = true;  // has no more poses than its curves need
  return out;
}

}  // namespace

void draw(const std::vector<FigureData>& all) {
  nlohmann::json document = nlohmann::json::array();
  for (FigureData data : all) {
    // Scripts come with all data.
    const auto has_script = [](const DrawnFigure& figure) { return figure.options.script; };
    if (std::ranges::none_of(data.figures, has_script)) {
      for (DrawnCurve& curve : data.curves) thin(curve, curve.peaks);
    }
    document.push_back(json_of(data));
  }
  using nlohmann::json;
  const Ended result = run_python(document.dump(-1, ' ', false, json::error_handler_t::replace));
  if (result.exit_code == 2 && !result.output.empty()) throw InputError(result.output);
  if (result.exit_code != 0) throw InputError("drawing failed; the messages of Python are above");
}

bool is_figure_name(const std::filesystem::path& file) {
  const std::string extension = file.extension().string();
  return std::ranges::any_of(
      kFigureFormats, [&](const char* format) { return "." + std::string(format) == extension; });
}

std::filesystem::path figure_name(std::filesystem::path name) {
  return is_figure_name(name) ? name : name += ".pdf";
}

std::string file_list(const DrawnFigure& figure) {
  std::string out;
  for (const std::filesystem::path& file : figure.files) out += file.string() + "\n";
  if (!figure.options.script || figure.files.empty()) return out;
  return out + std::filesystem::path(figure.files.front()).replace_extension("py").string() + "\n";
}

std::vector<std::string> labels_of(const FigureOptions& options,
                                   const std::vector<std::string>& names) {
  if (options.labels.empty()) return names;
  if (options.labels.size() == names.size()) return options.labels;
  throw InputError(fmt::format("--labels: expected {} for {}, found {}",
                               names.size(),
                               fmt::join(names, ", "),
                               options.labels.size()));
}

const std::vector<std::string>& panel_names() {
  static const std::vector<std::string> names{
      "plane", "xy", "xz", "yz", "xyz", "x", "y", "z", "angle", "ratio", "time", "boxes", "growth"};
  return names;
}

std::vector<std::string> figure_panels(const std::vector<std::string>& names, bool of_errors) {
  std::vector<std::string> out;
  for (const std::string& name : names) {
    if (std::ranges::count(kScorePanels, name) > 0) continue;
    const bool is_error = name.size() == 1 || name == "angle";
    if (is_error != of_errors) continue;
    const std::string error = name == "angle" ? name : "error_" + name;
    out.push_back(is_error ? error + " by distance" : name);
  }
  return out;
}

FigureData sequence_figure_data(const std::vector<CellRow>& cells,
                                Traces& traces,
                                const std::string& sequence,
                                const std::vector<std::string>& methods,
                                const std::vector<std::string>& all_methods) {
  std::set<std::int64_t> repeats;
  for (const CellRow& cell : cells) {
    if (cell.sequence == sequence) repeats.insert(cell.repeat);
  }
  FigureData out;
  out.title = sequence;
  if (repeats.empty()) return out;
  const std::int64_t first = *repeats.begin();
  if (repeats.size() > 1) {
    out.title += fmt::format(", repeat {} (first of {})", first, repeats.size());
  }
  Vector3 origin = Vector3::Zero();
  for (const std::string& method : methods) {
    const auto cell = std::ranges::find_if(cells, [&](const CellRow& c) {
      return c.sequence == sequence && c.repeat == first && c.method == method;
    });
    if (cell == cells.end()) continue;
    const std::optional<CellTrace> trace = traces.cell(cell->position);
    if (!trace || trace->samples.empty()) continue;
    if (out.curves.empty()) {
      const std::optional<SequenceTrace> reference = traces.sequence(cell->position);
      if (reference) out.curves.push_back(curve_of(*reference));
      origin = origin_of(reference);
    }
    DrawnCurve& curve = out.curves.emplace_back(curve_of(*trace, origin));
    const auto index = std::ranges::find(all_methods, method) - all_methods.begin();
    curve.name = method;
    curve.style = static_cast<std::size_t>(index);
  }
  return out;
}

std::string file_stem(const std::string& label) {
  std::string out;
  for (const char c : label) {
    if (std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '-') {
      out += c;
    } else if (!out.empty() && out.back() != '_') {
      out += '_';
    }
  }
  while (!out.empty() && out.back() == '_') out.pop_back();
  return out.substr(0, 80);
}

}  // namespace loopbench::harness
