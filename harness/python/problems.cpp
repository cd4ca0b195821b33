#include "harness/python/problems.hpp"

#include <pybind11/stl.h>

#include <numeric>

#include "datasets/derive/odometry.hpp"
#include "datasets/derive/planar.hpp"
#include "harness/commands/correct/correct.hpp"
#include "harness/commands/loops/loops.hpp"
#include "harness/sweep/config/choices.hpp"

namespace loopbench::python {
namespace {

namespace py = pybind11;

Problem problem_of(const Array& keyframes,
                   const Array& frames,
                   const Array& odometry,
                   const Array& closures,
                   bool planar) {
  Problem out{checked(keyframes, "keyframes"),
              read_edges(odometry, "odometry"),
              read_edges(closures, "closures"),
              checked(frames, "frames"),
              planar};
  check(out, "problem");
  return out;
}

py::tuple correct(const Problem& problem, const std::string& method, std::vector<double> at) {
  harness::Correction done;
  {
    const py::gil_scoped_release unlocked;
    const harness::Catalogue known = harness::catalogue({});
    if (at.empty()) at = stamps(problem.keyframes);
    done = harness::correct(
        problem, "problem", harness::method_without_reference(method, known), at, known);
  }
  return py::make_tuple(rows_of(done.output), harness::json(done));
}

/// JSON of `loops --json`; keyframes are named by their indices.
std::string loops(Problem problem) {
  const py::gil_scoped_release unlocked;
  problem.ids.resize(problem.keyframes.size());
  std::iota(problem.ids.begin(), problem.ids.end(), 0);
  return harness::json(harness::loops(std::move(problem), "problem"));
}

/// Edges between consecutive keyframes, with the default noise of measured odometry.
Array odometry(const Array& keyframes) {
  return edge_rows(odometry_edges(checked(keyframes, "keyframes"), {}));
}

/// Whether poses and closures are in one plane with the normal z of the body, within rounding.
bool is_planar(const Array& keyframes, const Array& frames, const Array& closures) {
  Trajectory poses = checked(keyframes, "keyframes"), between = checked(frames, "frames");
  std::vector<Edge> edges = read_edges(closures, "closures");
  PlanarParts parts{{{"keyframes", &poses}, {"frames", &between}}, {}};
  for (Edge& edge : edges) parts.measurements.push_back(&edge.from_from_to);
  const PlanarChoice choice = choose_planar(Planar::automatic, parts);
  return choice.planar && choice.normal == Vector3::UnitZ();
}

/// The data of one sequence; `entry` is the text of one entry of a config's `datasets`.
py::tuple load(const std::string& entry, const std::vector<std::string>& folders) {
  Sequence loaded;
  {
    const py::gil_scoped_release unlocked;
    const harness::Catalogue known = harness::catalogue({});
    const harness::Folders roots(folders.begin(), folders.end());
    const std::vector<harness::DatasetChoice> choices =
        harness::read_datasets(harness::parse_yaml(entry, "dataset"), known, roots);
    if (choices.size() != 1) {
      throw InputError("dataset: found " + std::to_string(choices.size()) +
                       " sequences, expected one: no lists, and no pattern of several files");
    }
    const harness::Choice& chosen = choices.front().dataset;
    loaded = harness::find_dataset(known, chosen.name).load(chosen.options, DataRoot{roots});
    check(loaded.problem, choices.front().label);
    check(loaded.reference, choices.front().label + ": reference");
  }
  const Problem& problem = loaded.problem;
  return py::make_tuple(rows_of(problem.keyframes),
                        rows_of(problem.frames),
                        edge_rows(problem.odometry),
                        edge_rows(problem.closures),
                        problem.planar,
                        rows_of(loaded.reference));
}

}  // namespace

Trajectory checked(const Array& rows, const std::string& name) {
  Trajectory out = read_rows(rows, name).poses;
  check(out, name);
  return out;
}

void add_problems(py::module_& module) {
  py::class_<Problem>(module, "Problem").def(py::init(&problem_of));
  module.def("correct", &correct, "rows, and the JSON of `correct --json`");
  module.def("loops", &loops, "the JSON of `loops --json`");
  module.def("odometry", &odometry, "edges between consecutive keyframes");
  module.def("is_planar", &is_planar, "whether keyframes, frames and closures are planar");
  module.def("load", &load, "keyframes, frames, odometry, closures, planar, reference");
}

}  // namespace loopbench::python
