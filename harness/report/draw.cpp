#include "harness/report/draw.hpp"

#include <fmt/ranges.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <system_error>

#include "datasets/core/error.hpp"
#include "harness/base/printable.hpp"
#include "harness/base/run_filter.hpp"

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

/// Runs render.py, which reads all of its input before it writes.
FilterResult run_python(const std::string& input) {
  try {
    return run_filter({"python3", script().string()}, input);
  } catch (const std::system_error& error) {
    if (error.code() == std::errc::no_such_file_or_directory) {
      throw InputError("python3 is not installed (package python3-matplotlib)");
    }
    throw InputError(std::string("python3 cannot be started: ") + error.what());
  }
}

}  // namespace

void draw(const std::vector<FigureData>& all) {
  nlohmann::json document = nlohmann::json::array();
  for (const FigureData& data : all) document.push_back(json_of(data));
  using nlohmann::json;
  const FilterResult result =
      run_python(document.dump(-1, ' ', false, json::error_handler_t::replace));
  if (result.exit_code == 2 && !result.output.empty()) throw InputError(result.output);
  if (result.exit_code != 0) throw InputError("drawing failed; the messages of Python are above");
}

bool is_figure_name(const std::filesystem::path& file) {
  const std::string extension = file.extension().string();
  return std::ranges::any_of(
      kFigureFormats, [&](const char* format) { return "." + std::string(format) == extension; });
}

std::vector<std::string> take_suffixes(std::filesystem::path& name) {
  if (!is_figure_name(name)) return {".svg", ".pdf", ".png"};
  const std::string own = name.extension().string();
  name.replace_extension();
  return {own};
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

}  // namespace loopbench::harness
