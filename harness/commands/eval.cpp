#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <optional>

#include "datasets/formats/formats.hpp"
#include "harness/commands/commands.hpp"
#include "harness/commands/judgement.hpp"

namespace loopbench {
namespace {

struct EvalArguments {
  std::string reference;
  std::vector<std::string> estimates;
  std::string format = "auto";
  std::string reference_format;  ///< empty: as `format`
  std::string times;             ///< empty: none
  std::string repeats = "refuse";
  double period = ReadOptions{}.period;
  std::string association;  ///< empty: the protocol's default; so below
  std::string align;
  std::optional<double> max_diff;
  std::optional<double> max_gap;
  std::optional<double> offset;
  bool json = false;
};

Protocol protocol(const EvalArguments& a) {
  Params given;
  if (!a.association.empty()) given["association"] = a.association;
  if (!a.align.empty()) given["align"] = a.align;
  if (a.max_diff) given["max_diff"] = *a.max_diff;
  if (a.max_gap) given["max_gap"] = *a.max_gap;
  if (a.offset) given["offset"] = *a.offset;
  return with(Protocol{}, given);
}

/// The same reader for reference and estimate, differing in format only.
struct Reader {
  const EvalArguments& arguments;
  bool has_used_times = false;

  Trajectory read(const std::string& file, const std::string& format_word) {
    ReadOptions options;
    FieldType<Format>::assign("format", options.format, format_word);
    FieldType<Repeats>::assign("repeats", options.repeats, arguments.repeats);
    options.period = arguments.period;
    if (options.format == Format::automatic) options.format = recognise(file);
    if (!arguments.times.empty() && options.format == Format::kitti) {
      options.times = arguments.times;
      has_used_times = true;
    }
    Trajectory poses = read_trajectory(file, options);
    if (poses.empty()) throw input_error(file, 0, "holds no pose, expected at least one");
    return poses;
  }
};

int eval(const EvalArguments& a) {
  const Protocol rules = protocol(a);
  Reader reader{a};
  const Trajectory reference =
      reader.read(a.reference, a.reference_format.empty() ? a.format : a.reference_format);
  std::vector<Judgement> judgements;
  for (const std::string& file : a.estimates) {
    const Trajectory estimate = reader.read(file, a.format);
    try {
      judgements.push_back(judge(reference, estimate, rules));
    } catch (const std::runtime_error& error) {
      throw InputError(file + " against " + a.reference + ": " + error.what());
    }
    judgements.back().reference = a.reference;
    judgements.back().estimate = file;
  }
  if (!a.times.empty() && !reader.has_used_times) {
    throw InputError(a.times + ": is a times file, but no file here is KITTI poses");
  }
  if (a.json) {
    fmt::print("{}", json(judgements));
    return kExitOk;
  }
  for (const Judgement& judgement : judgements) {
    fmt::print("{}{}", &judgement == &judgements.front() ? "" : "\n", text(judgement));
  }
  return kExitOk;
}

}  // namespace

void add_eval(CLI::App& app, int& exit_code) {
  auto a = std::make_shared<EvalArguments>();
  CLI::App* command = app.add_subcommand("eval", "Judge trajectory files against a reference");
  command->add_option("reference", a->reference, "The trajectory held to be true")
      ->required()
      ->type_name("REF");
  command->add_option("estimates", a->estimates, "The trajectories to judge")
      ->required()
      ->type_name("EST");
  const auto word = [&](const char* name, std::string& value, const std::string& help) {
    return command->add_option(name, value, help)->type_name("WORD");
  };
  const Protocol defaults;
  word("--format", a->format, choice_list<Format>())->capture_default_str();
  word("--ref-format", a->reference_format, "Format of REF, when it is another");
  word("--align", a->align, choice_list<Align>() + " [" + to_text(defaults.align) + "]");
  word("--association",
       a->association,
       choice_list<Association>() + " [" + to_text(defaults.association) + "]");
  word("--repeats", a->repeats, "Equal stamps: " + choice_list<Repeats>())->capture_default_str();
  const auto seconds = [&](const char* name, std::optional<double>& value, std::string help) {
    command->add_option(name, value, std::move(help))->type_name("S");
  };
  seconds("--max-diff",
          a->max_diff,
          fmt::format("Largest time difference of a pair [{}]", defaults.max_diff));
  seconds("--max-gap",
          a->max_gap,
          fmt::format("Largest reference gap to interpolate over [{}]", defaults.max_gap));
  seconds(
      "--offset", a->offset, fmt::format("Added to the estimates' stamps [{}]", defaults.offset));
  command->add_option("--times", a->times, "Stamps of KITTI poses, one a line")->type_name("FILE");
  command->add_option("--period", a->period, "Between KITTI or g2o poses without stamps [s]")
      ->type_name("S")
      ->capture_default_str();
  command->add_flag("--json", a->json, "As JSON, in full precision");
  command->callback([a, &exit_code] { exit_code = eval(*a); });
}

}  // namespace loopbench
