// Attacks the real program at random and checks that nothing is lost:
//   campaign --seed 1 --histories 5          a few seconds, in ctest
//   campaign --seed 2 --kills 1000           until the program was killed 1000 times
//   campaign --seed 3 --minutes 600          for a night
// A history is a series of attacks on one results folder. At its end the sweep is finished, and the
// store must equal that of a sweep without attacks; no other file and no process may be left.
// `--config FILE --plugin FILE` attack another sweep, for example one of misbehaving methods.
#include <fmt/format.h>
#include <getopt.h>

#include <chrono>
#include <fstream>
#include <numeric>

#include "tests/campaign/attacks.hpp"
#include "tests/support/temporary_folder.hpp"

namespace loopbench::campaign {
namespace {

const char* const kConfig =
    "datasets: [{dataset: simulated, path: room, keyframes: 40, label: a},\n"
    "           {dataset: simulated, path: office, keyframes: 40, closures: {max: 0}, label: b}]\n"
    "methods: [raw, uniform, cubic_spline, uniform + cubic_spline]\nmetrics: [ate, axis_error]\n"
    "repeats: 6\n";

struct Arguments {
  std::uint64_t seed = 1;
  double minutes = 0.0;
  int kills = 0;
  int histories = 0;
  Settings settings;
};

Arguments parsed(int count, char** words) {
  Arguments out;
  out.settings.binary = LOOPBENCH_BINARY;
  const option options[] = {{"seed", required_argument, nullptr, 's'},
                            {"minutes", required_argument, nullptr, 'm'},
                            {"kills", required_argument, nullptr, 'k'},
                            {"histories", required_argument, nullptr, 'h'},
                            {"config", required_argument, nullptr, 'c'},
                            {"plugin", required_argument, nullptr, 'p'},
                            {"binary", required_argument, nullptr, 'b'},
                            {nullptr, 0, nullptr, 0}};
  for (int code = 0; (code = getopt_long(count, words, "", options, nullptr)) != -1;) {
    switch (code) {
      case 's':
        out.seed = std::stoull(optarg);
        break;
      case 'm':
        out.minutes = std::stod(optarg);
        break;
      case 'k':
        out.kills = std::stoi(optarg);
        break;
      case 'h':
        out.histories = std::stoi(optarg);
        break;
      case 'c':
        out.settings.config = std::filesystem::absolute(optarg);
        break;
      case 'p':
        out.settings.plugins.push_back(std::filesystem::absolute(optarg));
        break;
      case 'b':
        out.settings.binary = std::filesystem::absolute(optarg);
        break;
      default:
        throw std::invalid_argument("see the top of tests/campaign/main.cpp");
    }
  }
  if (out.minutes <= 0.0 && out.kills <= 0 && out.histories <= 0) out.histories = 5;
  return out;
}

const Attack& chosen(const std::vector<Attack>& all, std::mt19937_64& random) {
  unsigned total = 0;
  for (const Attack& attack : all) total += attack.weight;
  unsigned left = static_cast<unsigned>(random() % total);
  for (const Attack& attack : all) {
    if (left < attack.weight) return attack;
    left -= attack.weight;
  }
  return all.back();
}

class Campaign {
 public:
  explicit Campaign(const Arguments& arguments)
      : arguments_(arguments), settings_(arguments.settings), random_(arguments.seed) {
    settings_.folder = folder_.path();
    if (settings_.config.empty()) settings_.config = folder_.file("c.yaml", kConfig);
    // Everything that the program puts elsewhere is found as a stray file.
    std::filesystem::create_directories(folder_.path() / "tmp");
    setenv("TMPDIR", (folder_.path() / "tmp").c_str(), 1);
  }

  int run() {
    adopt_orphans();
    undisturbed_ = undisturbed_sweep(settings_);
    const std::vector<Attack> all = attacks();
    for (int number = 1; !is_done(number); ++number) {
      const std::uint64_t seed = random_();
      History history(settings_, undisturbed_, seed);
      std::string steps;
      try {
        const std::uint64_t count = 1 + history.random() % 8;
        for (std::uint64_t i = 0; i < count; ++i) {
          const Attack& attack = chosen(all, history.random);
          steps += (steps.empty() ? "" : ", ") + attack.name;
          attack.act(history);
          ++done_[attack.name];
        }
        history.finish();
        if (!std::filesystem::is_empty(folder_.path() / "tmp")) throw Broken("files in TMPDIR");
      } catch (const Broken& broken) {
        ++broken_;
        fmt::print("history {} ({}): {}\n", number, steps, broken.what());
        std::fflush(stdout);
      }
      for (const auto& [name, count] : history.counts) counts_[name] += count;
      histories_ = number;
    }
    report();
    return broken_ == 0 ? 0 : 1;
  }

 private:
  bool is_done(int number) const {
    const std::chrono::duration<double> passed = std::chrono::steady_clock::now() - begin_;
    if (arguments_.histories > 0 && number > arguments_.histories) return true;
    if (arguments_.minutes > 0.0 && passed.count() > 60.0 * arguments_.minutes) return true;
    const auto kills = counts_.find("kills");
    return arguments_.kills > 0 && kills != counts_.end() && kills->second >= arguments_.kills;
  }

  void report() const {
    fmt::print("seed {}: {} histories, {} broken; {} cells each\n",
               arguments_.seed,
               histories_,
               broken_,
               undisturbed_.cells.size());
    for (const auto& [name, count] : done_) fmt::print("  {:20} {:6}\n", name, count);
    fmt::print("of which\n");
    for (const auto& [name, count] : counts_) fmt::print("  {:20} {:6}\n", name, count);
  }

  const Arguments& arguments_;
  TemporaryFolder folder_;
  Settings settings_;
  Undisturbed undisturbed_;
  std::mt19937_64 random_;
  std::map<std::string, int> done_;    ///< attacks
  std::map<std::string, int> counts_;  ///< see History::counts
  int histories_ = 0;
  int broken_ = 0;
  std::chrono::steady_clock::time_point begin_ = std::chrono::steady_clock::now();
};

}  // namespace
}  // namespace loopbench::campaign

int main(int count, char** words) {
  try {
    const loopbench::campaign::Arguments arguments = loopbench::campaign::parsed(count, words);
    return loopbench::campaign::Campaign(arguments).run();
  } catch (const std::exception& error) {
    fmt::print(stderr, "campaign: {}\n", error.what());
    return 2;
  }
}
