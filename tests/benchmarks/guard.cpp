// Guards against slow-downs: ratios of processor times, which hardly depend on the machine.
//
//   guard LIMITS LOOPBENCH SYNTHETIC_SWEEP FOLDER [ROWS]
//
// LIMITS is a file with a line `LIMIT | ROW | REASON` for each row; ROWS a regular expression of
// names. The least time of both parts counts, and a row above its limit is measured again twice
// before it fails. Prints all rows; exit code 1 if a ratio exceeds its limit or has none.
#include <fmt/format.h>

#include <Eigen/SparseCholesky>
#include <cstdlib>
#include <fstream>
#include <iostream>
#include <limits>
#include <regex>
#include <sstream>

#ifdef LOOPBENCH_CHOLMOD
#include <Eigen/CholmodSupport>
#endif

#include "datasets/core/error.hpp"
#include "datasets/pose_graph_dataset.hpp"
#include "datasets/simulated/simulated.hpp"
#include "methods/correctors/consensus.hpp"
#include "methods/correctors/pose_graph.hpp"
#include "tests/benchmarks/costs.hpp"
#include "tests/benchmarks/guarded_inputs.hpp"
#include "tests/benchmarks/normal_equations.hpp"

namespace loopbench {

using namespace methods;

namespace {

/// Limits by name of the row.
std::map<std::string, double> read_limits(const std::string& file) {
  std::map<std::string, double> out;
  std::ifstream in(file);
  const std::regex pattern(R"(([0-9.]+) +\| (.*?) +\| .+)");
  for (std::string line; std::getline(in, line);) {
    std::smatch found;
    if (line.empty() || line.front() == '#') continue;
    if (!std::regex_match(line, found, pattern)) throw InputError(file + ": " + line);
    out[found[2]] = std::stod(found[1]);
  }
  return out;
}

class Guard {
 public:
  Guard(const std::string& limits, const std::string& rows)
      : limits_(read_limits(limits)), rows_(rows) {
    fmt::print("{:<48} {:>11} {:>11} {:>7} {:>7}\n", "row", "[ms]", "over [ms]", "ratio", "limit");
  }

  bool is_wanted(const std::string& row) const { return std::regex_search(row, rows_); }

  /// Measures the ratio of two processor times [s].
  template <class Above, class Below>
  void add(const std::string& row, Above above, Below below) {
    if (!is_wanted(row)) return;
    const auto limit = limits_.find(row);
    double most = std::numeric_limits<double>::infinity(), least = most, ratio = 0.0;
    for (int run = 0; run < 6; ++run) {
      most = std::min(most, above());
      least = std::min(least, below());
      ratio = most / least;
      if (run >= 1 && limit != limits_.end() && ratio <= limit->second) break;
    }
    const bool fails = limit == limits_.end() || ratio > limit->second;
    failed_ += fails ? 1 : 0;
    const std::string allowed =
        limit == limits_.end() ? "none" : fmt::format("{:g}", limit->second);
    fmt::print("{:<48} {:>11.3f} {:>11.3f} {:>7.2f} {:>7}{}\n",
               row,
               1e3 * most,
               1e3 * least,
               ratio,
               allowed,
               fails ? "  FAILED" : "");
    std::fflush(stdout);
  }

  int failed() const { return failed_; }

 private:
  std::map<std::string, double> limits_;
  std::regex rows_;
  int failed_ = 0;
};

struct Programs {
  std::string loopbench, synthetic_sweep;
  std::filesystem::path folder;
};

void guard_eval(Guard& guard, const Programs& programs) {
  const std::string reference = programs.folder / "reference.txt";
  const std::string estimate = programs.folder / "estimate.txt";
  for (const auto& [size, poses] :
       {std::pair<const char*, std::size_t>{"1e4", 10'000}, {"1e5", 100'000}}) {
    for (const auto& [name, motion] : test::motions()) {
      const std::string row = fmt::format("eval over reading, {}, {} poses", name, size);
      if (!guard.is_wanted(row)) continue;
      test::write_pair(programs.folder, name, motion, poses);
      guard.add(
          row,
          [&] {
            return test::cpu_of({programs.loopbench, "eval", reference, estimate}, 2);
          },
          [&] {
            return test::cpu_of({programs.loopbench, "traj", "info", reference, estimate});
          });
    }
  }
}

/// A further cell of the method that does nothing, with its process, scores and rows of the store,
/// on the same sequence or on one of its own, over the start of the program, which is as steady.
void guard_cells(Guard& guard, const Programs& programs) {
  const auto sweep = [&](int methods, int repeats) {
    const std::filesystem::path config = programs.folder / "cells.yaml";
    std::ofstream text(config);
    text << "datasets: [{dataset: simulated, path: room, keyframes: 20}]\nmetrics: [ate]\n"
         << "repeats: " << repeats << "\nmethods:\n";
    for (int i = 0; i < methods; ++i) text << "  - {method: raw, label: m" << i << "}\n";
    text.close();
    const std::filesystem::path out = programs.folder / "cells";
    std::filesystem::remove_all(out);
    return test::cpu_of({programs.loopbench, "run", config, "--out", out});
  };
  const auto start = [&] {
    double sum = 0.0;
    for (int i = 0; i < 20; ++i) sum += test::cpu_of({programs.loopbench, "list"});
    return sum / 20.0;
  };
  guard.add(
      "a cell of raw over a start", [&] { return (sweep(220, 1) - sweep(20, 1)) / 200.0; }, start);
  guard.add(
      "a cell of raw and its sequence over a start",
      [&] { return (sweep(1, 220) - sweep(1, 20)) / 200.0; },
      start);
}

#ifdef LOOPBENCH_CHOLMOD
using Factor = Eigen::CholmodDecomposition<test::Sparse, Eigen::Lower>;
#else
using Factor = Eigen::SimplicialLDLT<test::Sparse, Eigen::Lower>;
#endif

void guard_graph(Guard& guard, const std::string& name, const Problem& problem) {
  const test::Sparse H = test::normal_equations(problem);
  const PoseGraphOptimizer solver({.start = PoseGraphOptimizer::Start::chordal});
  guard.add(
      "pose_graph over a factorisation, " + name,
      [&] {
        return test::cpu_of([&] {
          Report report;
          solver.correct(problem, report);
        });
      },
      [&] { return test::cpu_of([&] { Factor factor(H); }); });
}

void guard_graphs(Guard& guard) {
  if (guard.is_wanted("pose_graph")) guard_graph(guard, "simulated", test::manhattan(3500));
  const char* root = std::getenv("LOOPBENCH_DATA");
  for (const auto& [name, file] : {std::pair{"intel", "intel"}, {"M3500", "M3500_with_vertices"}}) {
    if (root == nullptr || !guard.is_wanted("pose_graph")) continue;
    PoseGraphOptions options;
    options.path = fmt::format("pose_graphs/{}.g2o", file);
    options.rules.indefinite = IndefiniteInformation::repair;
    try {
      guard_graph(guard, name, load_pose_graph(options, {{root}}).problem);
    } catch (const DataMissing& missing) {
      fmt::print("{}\n", missing.what());
    }
  }
}

/// The judgement of all closures, true ones, over one solution with them.
void guard_consensus(Guard& guard) {
  struct Row {
    const char* size;
    std::int64_t keyframes, closures, laps;
  };
  for (const auto& [size, keyframes, closures, laps] :
       {Row{"1e3", 1'000, 100, 5}, Row{"1e4", 10'000, 1'000, 10}}) {
    for (const bool planar : {true, false}) {
      const std::string row = fmt::format(
          "consensus over pose_graph, {}, {} poses", planar ? "planar" : "spatial", size);
      if (!guard.is_wanted(row)) continue;
      SimulatedOptions options{.path = SimulatedPath::driving, .planar = planar};
      options.keyframes = keyframes;
      options.laps = laps;
      options.closures.max = closures;
      const Problem problem = load_simulated(options).problem;
      const auto cost = [&](const Corrector& corrector) {
        return test::cpu_of([&] {
          Report report;
          corrector.correct(problem, report);
        });
      };
      const Consensus consensus({});
      const PoseGraphOptimizer alone({.start = PoseGraphOptimizer::Start::chordal});
      guard.add(
          row, [&] { return cost(consensus); }, [&] { return cost(alone); });
    }
  }
}

/// Fitting a curve to keyframes over sampling it as often.
void guard_smoothers(Guard& guard) {
  constexpr std::size_t kKeyframes = 2'000;
  const std::vector<MethodEntry> known = methods::methods();
  const Problem problem{.keyframes = test::manhattan(kKeyframes).keyframes};
  const std::vector<double> times = stamps(problem.keyframes);
  std::vector<Pose> poses(times.size());
  for (const char* name : {"cubic_spline", "smoothing_spline", "dm_n4", "dm_robust"}) {
    const auto entry = std::ranges::find(known, name, &MethodEntry::name);
    const auto smoother = std::get<std::unique_ptr<const Smoother>>(entry->make({}));
    Report report;
    const auto curve = smoother->smooth(problem, report);
    guard.add(
        fmt::format("smoothing over evaluating, {}", name),
        [&] {
          return test::cpu_of([&] {
            Report own;
            smoother->smooth(problem, own);
          });
        },
        [&] { return test::cpu_of([&] { curve->sample(times, poses); }); });
  }
}

/// Growth: the time per cell of a large store over that of one with a tenth of the cells. A
/// sequence has many repeats if there is one method.
void guard_stores(Guard& guard, const Programs& programs) {
  struct Row {
    const char *command, *methods;
    int cells;
  };
  for (const auto& [command, methods, cells] :
       {Row{"compare", "40", 40'000}, {"table", "40", 40'000}, {"report", "1", 20'000}}) {
    const auto cost = [&, command = command, methods = methods](int size) {
      const auto store = programs.folder / fmt::format("{}-{}", methods, size);
      if (!std::filesystem::exists(store))
        test::cpu_of({programs.synthetic_sweep, store, std::to_string(size), "one", methods});
      std::vector<std::string> words{programs.loopbench,
                                     command,
                                     store,
                                     "-o",
                                     programs.folder / (std::string(command) + "_output")};
      if (words[1] == "report") words.insert(words.end(), {"--size", "100"});
      return test::cpu_of(words) / size;
    };
    guard.add(
        fmt::format("growth of {} per cell", command),
        [&, cells = cells] { return cost(cells); },
        [&, cells = cells] { return cost(cells / 10); });
  }
}

}  // namespace
}  // namespace loopbench

int main(int count, char** words) try {
  using namespace loopbench;
  if (count < 5) {
    std::cerr << "usage: guard LIMITS LOOPBENCH SYNTHETIC_SWEEP FOLDER [ROWS]\n";
    return 2;
  }
  const Programs programs{words[2], words[3], words[4]};
  std::filesystem::remove_all(programs.folder);
  std::filesystem::create_directories(programs.folder);
  Guard guard(words[1], count > 5 ? words[5] : "");
  guard_cells(guard, programs);
  guard_eval(guard, programs);
  guard_stores(guard, programs);
  guard_graphs(guard);
  guard_consensus(guard);
  guard_smoothers(guard);
  std::filesystem::remove_all(programs.folder);
  if (guard.failed() > 0)
    fmt::print("{} ratios exceed their limit in {}\n", guard.failed(), words[1]);
  return guard.failed() > 0 ? 1 : 0;
} catch (const std::exception& error) {
  std::cerr << "guard: " << error.what() << '\n';
  return 2;
}
