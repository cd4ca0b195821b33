#include <cstdio>
#include <loopbench/loopbench.hpp>

int main(int, char** argv) {
  using namespace loopbench;
  const Trajectory reference = read_trajectory(argv[1]);
  const auto ate = [&](const Trajectory& estimate) {
    return metrics::ate(evaluate(reference, estimate)).front().statistics.rmse;  // [m]
  };
  TrajectoryOptions chain;
  chain.estimate = argv[2];
  chain.closures = ClosureSource::file;
  chain.closures_file = argv[3];
  const Problem problem = load_trajectory(chain, {{"."}}).problem;
  const double corrected = ate(correct(problem, "dual"));
  std::printf("ATE %.4f m, with dual %.4f m\n", ate(read_trajectory(argv[2])), corrected);
}
