#include "harness/sweep/catalogue/command_metric.hpp"

#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <string_view>

#include "datasets/core/fields.hpp"
#include "datasets/files/replace_file.hpp"
#include "harness/sweep/catalogue/message.hpp"
#include "harness/sweep/catalogue/scratch.hpp"
#include "harness/sweep/catalogue/server.hpp"
#include "harness/sweep/process/write_file.hpp"

namespace loopbench::harness {
namespace {

struct CommandMetricOptions {
  CommandOptions program;
};

template <class Visit>
void fields(CommandMetricOptions& o, Visit visit) {
  fields(o.program, [&](const char* name, auto& member, const char* help, const auto&... rule) {
    const std::string_view option = name;
    if (option == "output") return;
    visit(name,
          member,
          option == "run" ? "program and arguments; {evaluation}: folder to read, {result}: file"
                          : help,
          rule...);
  });
}

void check_combination(const CommandMetricOptions& o) {
  check_combination(o.program, "evaluation");
}

std::vector<metrics::Score> score_here(const metrics::Evaluation& evaluation,
                                       const CommandMetricOptions& options) {
  return command_scores(evaluation, options.program);
}

/// What a program reads about the poses.
nlohmann::json description(const metrics::Evaluation& evaluation) {
  return {{"exchange", kExchangeVersion},
          {"kind", "metric"},
          {"pairs", evaluation.coverage.pairs},
          {"possible", evaluation.coverage.possible},
          {"span", evaluation.coverage.span},
          {"scale", evaluation.alignment.scale},
          {"reference_length", evaluation.reference_length},
          {"times", to_text(evaluation.context.times)},
          {"units", {{"stamps", "s"}, {"translation", "m"}}}};
}

/// Lines of TUM with all digits; stamps can repeat.
std::string lines_of(const Trajectory& poses) {
  std::string out;
  for (const auto& [stamp, pose] : poses) {
    out += fmt::format("{}", stamp);
    for (const double x : pose.translation) out += fmt::format(" {}", x);
    for (const double x : pose.rotation.coeffs()) out += fmt::format(" {}", x);
    out += '\n';
  }
  return out;
}

std::string answer_of_run(const metrics::Evaluation& evaluation, const CommandOptions& options) {
  const ExchangeFolder folder;
  const std::filesystem::path input = folder.path() / "evaluation";
  std::filesystem::create_directory(input);
  const WithoutSync of_exchange;
  write_file(input / "reference.txt", lines_of(evaluation.reference));
  write_file(input / "estimate.txt", lines_of(evaluation.estimate));
  write_file(input / "evaluation.json", description(evaluation).dump() + "\n");
  const ProgramRun ran = run_in_folder(options, "evaluation", folder.path());
  const std::string text = result_text(folder.path() / "result");
  if (text.empty())
    throw std::runtime_error(with_output("the program wrote no result", ran.output));
  return text;
}

metrics::Score score_of(const nlohmann::json& entry, int ddof, std::size_t pairs) {
  static const std::vector<std::string> kKeys{
      "name", "axis", "unit", "value", "values", "better", "target"};
  require_keys(entry, kKeys, "result: a score");
  metrics::Score out;
  if (!entry.contains("name")) throw std::runtime_error("result: a score has no name");
  const auto name = entry.at("name").get<std::string>();
  if (!entry.contains("unit")) throw std::runtime_error("result: " + name + ": has no unit");
  if (entry.contains("value") == entry.contains("values")) {
    throw std::runtime_error("result: " + name + ": expected either value or values");
  }
  const auto unit = entry.at("unit").get<std::string>();
  const std::string axis = entry.value("axis", "");
  if (entry.contains("values")) {
    const auto values = entry.at("values").get<std::vector<double>>();
    if (values.empty()) throw metrics::Undefined(name + ": has no values");
    out = {name, axis, unit, metrics::statistics(values, ddof)};
    if (values.size() == pairs) out.per_pose = values;
  } else {
    out = metrics::single(name, axis, unit, entry.at("value").get<double>());
  }
  FieldType<metrics::Better>::assign("better", out.better, entry.value("better", "lower"));
  out.target = entry.value("target", 0.0);
  return out;
}

}  // namespace

CommandOptions as_metric(CommandOptions program) {
  program.role = "metric";
  return program;
}

metrics::MetricEntry command_metric() {
  return metrics::metric<CommandMetricOptions>(
      kCommand, "any program; see metrics/programs.md", score_here);
}

std::vector<metrics::Score> parse_scores(const std::string& text, int ddof, std::size_t pairs) {
  require_ok(parse_metadata(text));
  try {
    std::vector<metrics::Score> out;
    const nlohmann::json answer = nlohmann::json::parse(text);
    if (!answer.contains("scores")) throw std::runtime_error("result: has no scores");
    for (const nlohmann::json& entry : answer.at("scores")) {
      out.push_back(score_of(entry, ddof, pairs));
    }
    return out;
  } catch (const nlohmann::json::exception& error) {
    throw std::runtime_error(std::string("result: ") + error.what());
  } catch (const OptionError& error) {
    throw std::runtime_error(std::string("result: ") + error.what());
  }
}

std::vector<metrics::Score> command_scores(const metrics::Evaluation& evaluation,
                                           const CommandOptions& given) {
  const CommandOptions program = as_metric(given);
  const int ddof = evaluation.protocol.ddof;
  const std::size_t pairs = evaluation.reference.size();
  if (program.serve.empty()) return parse_scores(answer_of_run(evaluation, program), ddof, pairs);
  std::string errors;
  try {
    const auto bytes = [&](std::uint64_t number) {
      return request(description(evaluation),
                     {{"reference", &evaluation.reference}, {"estimate", &evaluation.estimate}},
                     {},
                     number);
    };
    return parse_scores(ask_served(program, bytes, pairs, errors).text, ddof, pairs);
  } catch (const metrics::Undefined&) {
    throw;
  } catch (const std::runtime_error& error) {
    throw std::runtime_error(with_output(error.what() + hidden_note(program_sandbox()), errors));
  }
}

}  // namespace loopbench::harness
