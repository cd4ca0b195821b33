#include "harness/sweep/catalogue/command.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <chrono>
#include <fstream>
#include <iterator>

#include "datasets/core/error.hpp"
#include "datasets/core/polyline.hpp"
#include "harness/sweep/catalogue/arguments.hpp"
#include "harness/sweep/catalogue/scratch.hpp"
#include "harness/sweep/catalogue/server.hpp"
#include "harness/sweep/text/hash.hpp"
#include "harness/sweep/text/printable.hpp"

namespace loopbench::harness {
namespace {

using ExchangeClock = std::chrono::steady_clock;

double seconds_since(ExchangeClock::time_point begin) {
  return std::chrono::duration<double>(ExchangeClock::now() - begin).count();
}

/// Runs the program on one problem; `own` becomes the method's time [s].
Trajectory run_once(const CommandOptions& options,
                    const Problem& problem,
                    methods::Report& report,
                    double& own) {
  const ExchangeFolder folder;
  const std::filesystem::path input = folder.path() / "problem";
  const std::filesystem::path result = folder.path() / "result";
  std::filesystem::create_directory(input);
  write_problem(input, problem);
  const ProgramRun ran = run_in_folder(options, "problem", folder.path());
  const std::string stated = result_text(result.string() + ".json");
  const ResultMetadata metadata = stated.empty() ? ResultMetadata{} : parse_metadata(stated);
  require_ok(metadata);
  Trajectory out;
  try {
    out = read_result(result, problem, options.output);
  } catch (const std::runtime_error& error) {
    throw std::runtime_error(
        with_output(error.what() + hidden_note(program_sandbox()), ran.output));
  }
  add_statements(report, metadata);
  own = time_of_run(report, metadata, ran.seconds);
  add_costs(ran.end.cpu_seconds, ran.end.peak_memory);
  add_output(report, ran.output);
  return out;
}

Trajectory corrected(const CommandOptions& options,
                     const Problem& problem,
                     methods::Report& report) {
  if (!options.serve.empty()) return ask_server(options, problem, report);
  const auto begin = ExchangeClock::now();
  double own = 0.0;
  Trajectory out = run_once(options, problem, report, own);
  program_costs().exchange_seconds += seconds_since(begin) - own;  // with its end
  return out;
}

class CommandCorrector final : public methods::Corrector {
 public:
  explicit CommandCorrector(CommandOptions options) : options_(std::move(options)) {}
  Trajectory correct(const Problem& problem, methods::Report& report) const override {
    return corrected(options_, problem, report);
  }
  std::unique_ptr<methods::Incremental> incremental(bool planar) const override {
    return options_.updates ? served_updates(options_, planar) : nullptr;
  }

 private:
  CommandOptions options_;
};

class DenseCommand final : public methods::Estimator {
 public:
  explicit DenseCommand(CommandOptions options) : options_(std::move(options)) {}
  std::string why_declined(const Problem& problem) const override {
    if (problem.keyframes.size() < 2) return "fewer than two keyframes";
    return "";
  }
  std::unique_ptr<const Curve> estimate(const Problem& problem,
                                        methods::Report& report) const override {
    return std::make_unique<Polyline>(corrected(options_, problem, report));
  }

 private:
  CommandOptions options_;
};

}  // namespace

void check_combination(const CommandOptions& o, const std::string& input) {
  if (o.run.empty() == o.serve.empty()) {
    throw OptionError("run", "run: expected either run or serve, and not both");
  }
  const bool serves = o.run.empty();
  if (o.updates && (!serves || o.output == ResultPoses::dense)) {
    throw OptionError("updates", "updates: needs serve and output: keyframes");
  }
  command_words(serves ? "serve" : "run", serves ? o.serve : o.run, o.shell);
  split_arguments("version", o.version.empty() ? "-" : o.version);
  split_arguments("depends", o.depends.empty() ? "-" : o.depends);
  for (const std::string& name : {"{" + input + "}", std::string("{result}")}) {
    if (!serves && o.run.find(name) == std::string::npos) {
      throw OptionError("run", "run: does not contain " + name + ": " + o.run);
    }
  }
}

ProgramStart start_on(const std::map<std::string, std::filesystem::path>& files,
                      const std::filesystem::path& writable,
                      const std::string& run,
                      bool shell,
                      std::map<std::string, std::string> values) {
  ProgramStart out;
  for (const auto& [name, file] : files) {
    std::string variable = "LOOPBENCH_" + name;
    std::ranges::transform(
        variable, variable.begin(), [](unsigned char c) { return std::toupper(c); });
    out.environment.emplace_back(variable, file.string());
    values[name] = shell ? "${" + variable + "}" : file.string();
  }
  out.environment.emplace_back("TMPDIR", writable.string());
  out.arguments = with_values(command_words("run", run, shell), values);
  out.writable = writable;
  return out;
}

ProgramRun run_in_folder(const CommandOptions& options,
                         const std::string& name,
                         const std::filesystem::path& folder) {
  ProgramStart start = start_on(
      {{name, folder / name}, {"result", folder / "result"}}, folder, options.run, options.shell);
  start.folder = options.folder;
  start.sandbox = &program_sandbox();
  start.network = options.network;
  ProgramRun out;
  const auto started = ExchangeClock::now();
  RunningProgram tree(start);
  out.end = tree.wait(out.output);
  out.seconds = seconds_since(started);
  if (out.end.exit_code != 0) {
    throw std::runtime_error(
        with_output("the program " + text(out.end) + hidden_note(program_sandbox()), out.output));
  }
  return out;
}

std::string result_text(const std::filesystem::path& file) {
  std::error_code none;
  if (!std::filesystem::is_regular_file(std::filesystem::symlink_status(file, none))) return "";
  constexpr std::uintmax_t kMost = std::uintmax_t{256} << 20;  // [bytes]
  if (const std::uintmax_t bytes = std::filesystem::file_size(file, none); bytes > kMost) {
    throw std::runtime_error(fmt::format(
        "{}: has {} bytes, expected at most {}", file.filename().string(), bytes, kMost));
  }
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

std::vector<std::string> command_words(const std::string& option,
                                       const std::string& text,
                                       bool shell) {
  if (shell) return {"sh", "-c", text};
  return split_arguments(option, text);
}

methods::Stage make_command(const CommandOptions& options) {
  check_combination(options);
  if (options.output == ResultPoses::dense) {
    return std::unique_ptr<const methods::Estimator>(std::make_unique<DenseCommand>(options));
  }
  return std::unique_ptr<const methods::Corrector>(std::make_unique<CommandCorrector>(options));
}

std::string with_output(const std::string& why, const std::string& output) {
  return output.empty() ? why : why + "; its output ends with: " + output;
}

void add_output(methods::Report& report, const std::string& output) {
  constexpr std::size_t kLongestOutput = 1900;  // [bytes], of a note
  std::string text = printable(output);
  std::ranges::replace(text, '\n', ' ');
  while (!text.empty() && text.back() == ' ') text.pop_back();
  if (text.size() > kLongestOutput) text.erase(0, text.size() - kLongestOutput);
  const auto continues = [](char c) { return (static_cast<unsigned char>(c) & 0xc0) == 0x80; };
  while (!text.empty() && continues(text.front()))
    text.erase(0, 1);  // of a code point that was cut
  if (!text.empty()) report.notes.push_back("output: " + text);
}

namespace {

std::string output_of_version(const CommandOptions& options, const ProcessLimits& limits) {
  const ExchangeFolder folder;
  ProgramStart start;
  start.arguments = split_arguments("version", options.version);
  start.folder = options.folder;
  start.sandbox = &program_sandbox();
  start.environment = {{"TMPDIR", folder.path().string()}};
  start.writable = folder.path();
  start.network = options.network;
  const std::string what = "version: " + options.version + ": ";
  const auto run = [&] {
    std::string output;
    const ProgramEnd end = RunningProgram(start).wait(output);
    if (end.exit_code != 0) throw InputError(with_output(what + text(end), output));
    return output;
  };
  try {
    return in_own_process(run, limits);
  } catch (const ProcessFailure& error) {
    throw InputError(what + error.what());
  }
}

}  // namespace

std::string command_version(const CommandOptions& options, const ProcessLimits& limits) {
  Fields fields;
  const std::string& line = options.run.empty() ? options.serve : options.run;
  for (const std::string& name : named_files(line, options.depends, options.folder)) {
    fields.add(name).add(hex(hash_of_file(options.folder / name)));
  }
  if (options.version.empty()) return fields.hashed();
  return fields.add(output_of_version(options, limits)).hashed();
}

}  // namespace loopbench::harness
