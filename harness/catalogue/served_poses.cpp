#include <algorithm>
#include <chrono>

#include "harness/catalogue/message.hpp"
#include "harness/catalogue/server.hpp"
#include "metrics/evaluation/evaluation.hpp"

namespace loopbench::harness {
namespace {

using AskClock = std::chrono::steady_clock;

/// Poses of the program's answer, checked against the keyframes of `known`.
Trajectory ask_poses(const CommandOptions& options,
                     const CommandSetting& setting,
                     const Request& request,
                     const Problem& known,
                     methods::Report& report) {
  const auto begin = AskClock::now();
  std::string errors;
  ResultMetadata metadata;
  ServedAnswer answer;
  Trajectory out;
  try {
    answer = ask_served(options, setting, request, known.keyframes.size(), errors);
    out = checked_result(
        answer_poses(answer.text, answer.data, metadata), known, options.output, "the answer");
  } catch (const metrics::Undefined&) {
    throw;
  } catch (const std::runtime_error& error) {
    const std::string hidden = hidden_note(program_sandbox());
    throw std::runtime_error(with_output(error.what() + hidden, errors));
  }
  add_statements(report, metadata);
  report.notes.emplace_back("time: from request to answer");
  add_output(report, errors);
  report.count(kProgramTime, answer.cost.cpu_seconds);
  report.count(kProgramMemory, static_cast<double>(answer.cost.peak_memory));
  const std::chrono::duration<double> all = AskClock::now() - begin;
  report.phases.push_back({kExchangePhase, all.count() - answer.seconds});
  return out;
}

class ServedUpdates final : public methods::Incremental {
 public:
  ServedUpdates(const CommandOptions& options, const CommandSetting& setting, bool planar)
      : options_(options), setting_(setting) {
    known_.planar = planar;
  }

  Trajectory update(const methods::Increment& added, methods::Report& report) override {
    known_.keyframes.insert(known_.keyframes.end(), added.keyframes.begin(), added.keyframes.end());
    const std::size_t update = updates_++;
    return ask_poses(
        options_,
        setting_,
        [&](std::uint64_t number) { return request(added, update, known_.planar, number); },
        known_,
        report);
  }

 private:
  CommandOptions options_;
  CommandSetting setting_;
  Problem known_;  ///< keyframes only
  std::size_t updates_ = 0;
};

}  // namespace

Trajectory ask_server(const CommandOptions& options,
                      const CommandSetting& setting,
                      const Problem& problem,
                      methods::Report& report) {
  return ask_poses(
      options,
      setting,
      [&](std::uint64_t number) { return request(problem, options.output, number); },
      problem,
      report);
}

std::unique_ptr<methods::Incremental> served_updates(const CommandOptions& options,
                                                     const CommandSetting& setting,
                                                     bool planar) {
  return std::make_unique<ServedUpdates>(options, setting, planar);
}

}  // namespace loopbench::harness
