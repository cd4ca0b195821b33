/// The module loopbench._core: evaluation and methods on numpy arrays. It releases the global
/// interpreter lock while it computes.
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "datasets/core/fields.hpp"
#include "datasets/derive/reference_body.hpp"
#include "datasets/formats/formats.hpp"
#include "harness/commands/eval/evaluate_files.hpp"
#include "harness/commands/eval/evaluated_file.hpp"
#include "harness/python/problems.hpp"
#include "harness/sweep/catalogue/catalogue.hpp"
#include "harness/sweep/store/open.hpp"
#include "harness/sweep/store/stored_cells.hpp"
#include "metrics/alignment/alignment.hpp"
#include "metrics/pairing/association.hpp"
#include "metrics/trajectory/tracking_gaps.hpp"

namespace py = pybind11;

namespace loopbench::python {
namespace {

/// JSON of `eval --json`, the columns of harness::pose_csv() from the stamp on, and the names of
/// those that metrics state.
py::tuple to_python(const std::vector<harness::EvaluationResult>& results) {
  const std::vector<metrics::PoseError>& poses = results.front().poses;
  const std::vector<harness::PoseValues>& stated = results.front().pose_values;
  const std::size_t columns = 10 + stated.size();
  Array errors({static_cast<py::ssize_t>(poses.size()), static_cast<py::ssize_t>(columns)});
  double* at = errors.mutable_data();
  for (std::size_t i = 0; i < poses.size(); ++i) {
    const metrics::PoseError& pose = poses[i];
    *at++ = pose.stamp;
    *at++ = pose.estimate_stamp;
    for (const Vector3& part : {pose.metres, pose.radians}) {
      at = std::copy_n(part.data(), 3, at);
      *at++ = part.norm();
    }
    for (const harness::PoseValues& each : stated) *at++ = each.values[i];
  }
  std::vector<std::string> names;
  for (const harness::PoseValues& each : stated) names.push_back(harness::column_name(each));
  return py::make_tuple(harness::json(results), errors, names);
}

py::tuple evaluate_files(harness::EvalArguments arguments,
                         const std::string& reference,
                         const std::string& estimate) {
  arguments.reference = reference;
  arguments.estimates = {estimate};
  std::vector<harness::EvaluationResult> results;
  {
    const py::gil_scoped_release unlocked;
    results = harness::evaluate_files(arguments).results;
  }
  return to_python(results);
}

/// `setting`: FIELD=VALUE of the protocol, stated by this argument.
void set(harness::EvalArguments& arguments, const std::string& setting, const std::string& by) {
  arguments.settings.push_back({setting, by});
}

/// Sets a member of EvalArguments to a word of its enum, unless the word is empty.
template <class Enum>
auto word_setter(const char* name, auto member) {
  return [=](harness::EvalArguments& arguments, const std::string& word) {
    Enum value{};
    if (word.empty()) return;
    FieldType<Enum>::assign(name, value, word);
    arguments.*member = value;
  };
}

/// check(), which accepts equal stamps where `eval` keeps those of files.
void check_array(Trajectory poses,
                 const std::string& name,
                 const harness::EvalArguments& arguments) {
  if (harness::repeats_of(arguments) == Repeats::keep_all) {
    double last = NAN;
    for (std::size_t i = 0; i < poses.size(); ++i) {
      const double stamp = std::exchange(last, poses[i].stamp);
      if (poses[i].stamp == stamp) poses[i].stamp = std::nextafter(poses[i - 1].stamp, HUGE_VAL);
    }
  }
  check(poses, name, Rotations::optional);
}

py::tuple evaluate_arrays(const harness::EvalArguments& arguments,
                          const Array& reference_rows,
                          const Array& estimate_rows) {
  ReadRows reference = read_rows(reference_rows, "reference");
  ReadRows estimate = read_rows(estimate_rows, "estimate");
  std::vector<harness::EvaluationResult> results;
  {
    const py::gil_scoped_release unlocked;
    check_array(reference.poses, "reference", arguments);
    check_array(estimate.poses, "estimate", arguments);
    const ReferenceBody body = harness::reference_body(arguments);
    if (has_offset(body) && lacks_rotations(reference.poses)) {
      throw InputError("reference_body: found a reference without rotations, expected files");
    }
    Trajectory in_body = to_estimate_body(std::move(reference.poses), body);
    results = harness::evaluate_in_memory(
                  arguments,
                  {.poses = std::move(in_body), .findings = {.off_unit = reference.off_unit}},
                  {.poses = std::move(estimate.poses), .findings = {.off_unit = estimate.off_unit}})
                  .results;
  }
  return to_python(results);
}

Array read(const std::string& file,
           const std::string& format,
           const std::string& times,
           std::optional<double> period,
           const std::string& repeats) {
  ReadOptions options{.positions = true};
  FieldType<Format>::assign("format", options.format, format);
  FieldType<Repeats>::assign("repeats", options.repeats, repeats);
  if (!times.empty()) options.times = times;
  options.period = period.value_or(options.period);
  Trajectory out;
  {
    const py::gil_scoped_release unlocked;
    out = read_trajectory(file, options);
  }
  return rows_of(out);
}

py::tuple associate(const harness::EvalArguments& arguments,
                    const Array& reference_rows,
                    const Array& estimate_rows) {
  const Trajectory reference = checked(reference_rows, "reference");
  const Trajectory estimate = checked(estimate_rows, "estimate");
  metrics::Paired paired;
  {
    const py::gil_scoped_release unlocked;
    paired = metrics::associate(reference, estimate, harness::protocols(arguments).front().rules);
  }
  return py::make_tuple(rows_of(paired.reference), rows_of(paired.estimate));
}

py::tuple align(const Array& reference_rows,
                const Array& estimate_rows,
                const std::string& how,
                std::size_t first) {
  metrics::Align type = metrics::Align::none;
  FieldType<metrics::Align>::assign("align", type, how);
  const Trajectory reference = read_rows(reference_rows, "reference").poses;
  Trajectory estimate = read_rows(estimate_rows, "estimate").poses;
  metrics::Alignment found;
  {
    const py::gil_scoped_release unlocked;
    found = metrics::align(reference, estimate, type, first);
    estimate = metrics::moved(found, std::move(estimate));
  }
  const Pose& transform = found.reference_from_estimate;
  return py::make_tuple(
      rows_of(estimate), found.scale, found.rank, found.condition, rows_of({{0.0, transform}}));
}

std::vector<std::pair<double, double>> tracking_gaps(const Array& reference,
                                                     const std::vector<double>& stamps,
                                                     double longest_pause) {
  std::vector<std::pair<double, double>> out;
  const Trajectory path = checked(reference, "reference");
  for (const metrics::TrackingGap& gap : metrics::tracking_gaps(path, stamps, 0.0, longest_pause)) {
    out.emplace_back(gap.begin, gap.end);
  }
  return out;
}

std::vector<std::pair<std::string, std::string>> method_list() {
  std::vector<std::pair<std::string, std::string>> out;
  for (const methods::MethodEntry& entry : harness::catalogue({}).methods) {
    out.emplace_back(entry.name, entry.summary);
  }
  return out;
}

/// Throws InputError if a store is damaged: Python reads it by SQL.
void check_store(const std::string& file) {
  const py::gil_scoped_release unlocked;
  harness::Database database = harness::open_store(file);
  harness::read_intact_cells(database);
}

}  // namespace
}  // namespace loopbench::python

PYBIND11_MODULE(_core, module) {
  using namespace loopbench;
  using Arguments = harness::EvalArguments;
  module.doc() = "Compiled part of loopbench";
  py::register_exception<InputError>(module, "InputError", PyExc_ValueError);
  py::class_<Arguments>(module, "EvalArguments")
      .def(py::init<>())
      .def_readwrite("protocols", &Arguments::protocols)
      .def("set", &python::set)
      .def_readwrite("diagnose", &Arguments::diagnose)
      .def_readwrite("correct_scale", &Arguments::correct_scale)
      .def_readwrite("metrics", &Arguments::metrics)
      .def_readwrite("pose_errors", &Arguments::pose_errors)
      .def_readwrite("relation", &Arguments::relation)
      .def_readwrite("delta", &Arguments::delta)
      .def_readwrite("delta_unit", &Arguments::delta_unit)
      .def_readwrite("min_coverage", &Arguments::min_coverage)
      .def_readwrite("reference_body", &Arguments::reference_body)
      .def_property("format", nullptr, python::word_setter<Format>("format", &Arguments::format))
      .def_property("reference_format",
                    nullptr,
                    python::word_setter<Format>("ref-format", &Arguments::reference_format))
      .def_property(
          "repeats", nullptr, python::word_setter<Repeats>("repeats", &Arguments::repeats))
      .def_readwrite("times", &Arguments::times)
      .def_readwrite("period", &Arguments::period);
  python::add_problems(module);
  module.def("read_trajectory", &python::read, "rows of a file");
  module.def(
      "evaluate_files", &python::evaluate_files, "JSON of `eval --json`, errors of poses, names");
  module.def(
      "evaluate_arrays", &python::evaluate_arrays, "JSON of `eval --json`, errors of poses, names");
  module.def("associate", &python::associate, "paired rows of reference and estimate");
  module.def("align", &python::align, "aligned rows, scale, rank, condition, transform");
  module.def("tracking_gaps", &python::tracking_gaps, "begin and end of each gap");
  module.def("check_store", &python::check_store, "raises InputError if it is damaged");
  module.def("methods", &python::method_list, "name and summary of every method");
}
