#include <sstream>
#include <stdexcept>

#include "harness/answers/gate/gate.hpp"
#include "harness/commands/eval/arguments.hpp"
#include "harness/commands/eval/evaluate_files.hpp"
#include "harness/sweep/model/where.hpp"
#include "harness/sweep/run/pack.hpp"
#include "tests/fuzz/scratch_file.hpp"
#include "tests/fuzz/targets.hpp"

namespace loopbench {

using namespace harness;

namespace {

std::vector<std::string> lines_of(const std::string& text) {
  std::istringstream in(text);
  std::vector<std::string> out;
  for (std::string line; std::getline(in, line);) out.push_back(line);
  return out;
}

template <class Act>
void or_rejected(Act act) {
  try {
    unless_rejected(act);
  } catch (const OptionError&) {
    // an option, as expected
  }
}

}  // namespace

void fuzz_gate(const std::filesystem::path& file) {
  or_rejected([&] { read_limits(file); });
  or_rejected([&] {
    const std::string text = json(read_baseline(file));
    std::string again;
    try {
      again = json(parse_baseline(text, "again"));
    } catch (const InputError& error) {
      throw std::logic_error("a written baseline is rejected: " + std::string(error.what()));
    }
    if (again != text) throw std::logic_error("a baseline changes when it is written and read");
  });
}

void fuzz_where(const std::filesystem::path& file) {
  or_rejected([&] {
    Record record;
    record.cell.edit().sequence = "room";
    record.cell.edit().method = "uniform";
    record.kind.edit().metric = "ate";
    where(lines_of(fuzz_bytes(file)))(record);
  });
}

/// The input is split at lines into the text arguments of `eval`.
void fuzz_eval(const std::filesystem::path& file) {
  const std::vector<std::string> lines = lines_of(fuzz_bytes(file));
  const auto line = [&](std::size_t i) { return i < lines.size() ? lines[i] : std::string(); };
  EvalArguments arguments;
  arguments.reference_body = line(0);
  arguments.protocols = {line(1)};
  arguments.settings = {{line(2)}};
  const auto set = [&](const std::string& field, const std::string& value) {
    if (!value.empty()) arguments.settings.push_back({field + "=" + value, "--" + field});
  };
  set("association", line(3));
  set("align", line(4));
  set("project", line(5));
  arguments.relation = line(6);
  arguments.delta_unit = line(7);
  arguments.times = line(8);
  or_rejected([&] { reference_body(arguments); });
  if (!line(9).empty()) arguments.metrics = {line(9)};
  or_rejected([&] { metric_choices(arguments, catalogue({}), protocols(arguments)); });
}

/// The input is the reference and the estimate.
void fuzz_eval_files(const std::filesystem::path& file) {
  or_rejected([&] {
    EvalArguments arguments;
    arguments.reference = file;
    arguments.estimates = {file};
    evaluate_files(arguments);
  });
}

void fuzz_messages(const std::filesystem::path& file) {
  const std::string bytes = fuzz_bytes(file);
  try {
    CellResult result;
    Unpacker unpack(bytes);
    unpack(result);
  } catch (const std::runtime_error&) {
    // truncated, as expected
  }
  try {
    SequenceMetadata metadata;
    Unpacker unpack(bytes);
    unpack(metadata);
  } catch (const std::runtime_error&) {
  }
}

}  // namespace loopbench
