#include <fmt/format.h>

#include <CLI/CLI.hpp>

#include "harness/commands/commands.hpp"
#include "harness/commands/eval_arguments.hpp"
#include "harness/export/write_file.hpp"

namespace loopbench {
namespace {

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

  Trajectory read_reference(const std::string& file) {
    const bool is_same = arguments.reference_format.empty();
    return read(file, is_same ? arguments.format : arguments.reference_format);
  }
};

std::vector<Judgement> judgements(const EvalArguments& a) {
  const std::vector<NamedProtocol> rules = protocols(a);
  for (const NamedProtocol& protocol : rules) questions(a, protocol.rules);  // refuses slips early
  const std::vector<FilePair> files = file_pairs(a);
  Reader reader{a};
  std::vector<Judgement> out;
  std::string read_last;
  Trajectory reference;
  for (const FilePair& pair : files) {
    if (read_last != pair.reference) reference = reader.read_reference(pair.reference);
    read_last = pair.reference;
    const Trajectory estimate = reader.read(pair.estimate, a.format);
    for (const NamedProtocol& protocol : rules) {
      try {
        out.push_back(judge(
            reference, estimate, protocol, questions(a, protocol.rules), !a.per_pose.empty()));
      } catch (const std::runtime_error& error) {
        throw InputError(pair.estimate + " against " + pair.reference + ": " + error.what());
      }
      out.back().reference = pair.reference;
      out.back().estimate = pair.estimate;
    }
  }
  if (!a.times.empty() && !reader.has_used_times) {
    throw InputError(a.times + ": is a times file, but no file here is KITTI poses");
  }
  return out;
}

int eval(const EvalArguments& a) {
  const std::vector<Judgement> all = judgements(a);
  if (!a.per_pose.empty()) write_file(a.per_pose, pose_csv(all));
  if (a.json) {
    fmt::print("{}", json(all));
  } else if (a.csv) {
    fmt::print("{}", csv(all));
  } else {
    fmt::print("{}", all.size() == 1 ? text(all.front()) : comparison(all));
  }
  return kExitOk;
}

}  // namespace

void add_eval(CLI::App& app, int& exit_code) {
  auto a = std::make_shared<EvalArguments>();
  CLI::App* command = app.add_subcommand("eval", "Judge trajectory files against a reference");
  declare(*command, *a);
  command->callback([a, &exit_code] { exit_code = eval(*a); });
}

}  // namespace loopbench
