#include "harness/eval/evaluate_files.hpp"

#include <algorithm>
#include <atomic>
#include <filesystem>
#include <future>
#include <iterator>

#include "datasets/core/parallel.hpp"
#include "datasets/formats/kitti.hpp"
#include "harness/eval/recorded_evaluation.hpp"
#include "harness/text/write_file.hpp"

namespace loopbench::harness {
namespace {

/// Poses of a file, and its printed matrices if it holds matrices and they are needed.
struct Loaded {
  Trajectory poses;
  std::vector<PoseMatrix> matrices;
  ReadFindings repaired;
  std::string unstamped;  ///< file and format if the stamps were generated, otherwise empty
};

/// The reference of one or more estimates, in their body.
struct Reference {
  std::string name;
  Loaded read;
  std::string content;  ///< see EvaluationResult
};

EvaluationResult failure(const EvalArguments& a,
                         const FilePair& pair,
                         const metrics::NamedProtocol& protocol,
                         const std::string& why) {
  EvaluationResult out;
  out.reference_body = a.reference_body.value_or("");
  out.reference = pair.reference;
  out.estimate = pair.estimate;
  out.protocol = protocol;
  out.why_failed = why;
  return out;
}

/// Reader for reference and estimate, which differ only in format.
struct Reader {
  const EvalArguments& arguments;
  bool reads_matrices = false;
  std::atomic<bool> has_used_times = false;
  std::atomic<bool> has_used_period = false;

  Loaded read(const std::string& file, const std::string& format_word) {
    ReadOptions options;
    FieldType<Format>::assign("format", options.format, format_word);
    FieldType<Repeats>::assign("repeats", options.repeats, arguments.repeats);
    if (arguments.period) options.period = *arguments.period;
    if (options.format == Format::automatic) options.format = detect_format(file);
    const bool is_kitti = options.format == Format::kitti;
    Loaded out;
    options.findings = &out.repaired;
    if (!arguments.times.empty() && is_kitti) {
      options.times = arguments.times;
      has_used_times = true;
    }
    out.poses = read_trajectory(file, options);
    if (options.format == Format::g2o || (is_kitti && !options.times)) {
      out.unstamped = file + ": is " + to_text(options.format);
      has_used_period = true;
    }
    if (out.poses.empty()) throw input_error(file, 0, "has no poses, expected at least one");
    if (is_kitti && reads_matrices) out.matrices = read_kitti_matrices(file);
    return out;
  }

  Loaded read_reference(const std::string& file) {
    const bool is_same = arguments.reference_format.empty();
    return read(file, is_same ? arguments.format : arguments.reference_format);
  }
};

std::vector<std::filesystem::path> all_files(const EvalArguments& a,
                                             const std::vector<FilePair>& files) {
  std::vector<std::filesystem::path> out{a.times};
  for (const FilePair& pair : files) out.insert(out.end(), {pair.reference, pair.estimate});
  return out;
}

/// True if a protocol computes with the digits of KITTI files instead of rotations.
bool uses_digits(const std::vector<metrics::NamedProtocol>& protocols) {
  return std::ranges::any_of(protocols, [](const metrics::NamedProtocol& p) {
    return p.rules.form == metrics::ErrorForm::kitti ||
           p.rules.association == metrics::Association::evo;
  });
}

std::vector<EvaluationResult> unreadable(const EvalArguments& a,
                                         const std::vector<metrics::NamedProtocol>& rules,
                                         const Reference& reference,
                                         const FilePair& pair,
                                         const std::string& why) {
  std::vector<EvaluationResult> out;
  for (const metrics::NamedProtocol& each : rules) {
    out.push_back(failure(a, pair, each, why));
    out.back().reference_content = reference.content;
    out.back().content = unreadable_content(reference.content, pair.estimate);
  }
  return out;
}

/// `files`: number of all estimates; a failure of one of several is a result, not an exception.
std::vector<EvaluationResult> evaluated(Reader& reader,
                                        const std::vector<metrics::NamedProtocol>& rules,
                                        const Reference& reference,
                                        const std::string& estimate,
                                        std::size_t files) {
  const EvalArguments& a = reader.arguments;
  const bool is_alone = files * rules.size() == 1;
  Loaded loaded;
  try {
    loaded = reader.read(estimate, a.format);
  } catch (const InputError& error) {
    if (is_alone) throw;
    return unreadable(a, rules, reference, {reference.name, estimate}, error.what());
  }
  const Loaded& truth = reference.read;
  const bool are_printed = !truth.matrices.empty() && !loaded.matrices.empty();
  metrics::PrintedPoses printed;
  if (are_printed) printed = {truth.matrices, std::move(loaded.matrices)};
  const EvaluationInput input{{truth.poses,
                               loaded.poses,
                               reference.name,
                               estimate,
                               truth.unstamped.empty() && loaded.unstamped.empty()},
                              {std::max(truth.repaired.off_unit, loaded.repaired.off_unit),
                               truth.repaired.repeated + loaded.repaired.repeated,
                               loaded.repaired.damage},
                              are_printed ? &printed : nullptr,
                              truth.unstamped,
                              loaded.unstamped,
                              reference.content,
                              files > 1 ? pair_content(truth.poses, loaded.poses) : ""};
  return evaluate_read(a, rules, input, is_alone);
}

}  // namespace

std::string why_two_clocks(const EvalArguments& a,
                           const metrics::Protocol& protocol,
                           const std::string& one,
                           const std::string& other) {
  const bool uses_stamps = protocol.association != metrics::Association::index;
  if (a.period || !uses_stamps || one.empty() == other.empty()) return "";
  return one + other +
         ", poses without stamps, and the other file has stamps: expected --times FILE (KITTI), "
         "--period S or --association index";
}

std::vector<EvaluationResult> evaluate_read(const EvalArguments& a,
                                            const std::vector<metrics::NamedProtocol>& rules,
                                            const EvaluationInput& input,
                                            bool throws_failures) {
  const auto& [reference, estimate, reference_name, estimate_name, has_stamps] = input.read;
  const bool is_large = estimate.size() >= kMinItemsPerThread;
  std::future<std::vector<std::string>> doctor =
      std::async(is_large ? std::launch::async : std::launch::deferred,
                 [&] { return doctor_notes(input.read, rules); });
  std::vector<EvaluationResult> out;
  for (const metrics::NamedProtocol& protocol : rules) {
    const EvaluationOptions options{metric_requests(a, protocol.rules),
                                    !a.per_pose.empty(),
                                    !a.plot.empty() || !a.report.empty(),
                                    a.min_coverage.value_or(0.0),
                                    input.printed,
                                    input.findings,
                                    pose_of(reference_body(a))};
    const FilePair pair{reference_name, estimate_name};
    const std::string why =
        why_two_clocks(a, protocol.rules, input.reference_unstamped, input.estimate_unstamped);
    if (throws_failures && !why.empty()) throw InputError(why);
    if (!why.empty()) {
      out.push_back(failure(a, pair, protocol, why));
      continue;
    }
    try {
      out.push_back(evaluate_estimate(reference, estimate, protocol, options));
    } catch (const std::runtime_error& error) {
      if (throws_failures) {
        throw InputError(estimate_name + " with reference " + reference_name + ": " + error.what());
      }
      out.push_back(failure(a, pair, protocol, error.what()));
    }
    out.back().reference = reference_name;
    out.back().reference_body = a.reference_body.value_or("");
    out.back().estimate = estimate_name;
    out.back().reference_content = input.reference_content;
    out.back().content = input.content;
  }
  std::vector<std::string> remarks = doctor.get();
  if (!input.findings.damage.empty()) remarks.insert(remarks.begin(), input.findings.damage);
  for (EvaluationResult& result : out) {
    if (!result.why_failed.empty()) continue;
    result.notes.insert(result.notes.end(), remarks.begin(), remarks.end());
  }
  return out;
}

InputError unused_times(const EvalArguments& a) {
  return InputError(a.times + ": is a times file, but no file has KITTI poses");
}

InputError unused_period(const EvalArguments& a) {
  return InputError("--period " + to_text(*a.period) +
                    ": all files have stamps, expected KITTI poses without --times, or g2o");
}

std::vector<EvaluationResult> evaluate_files(const EvalArguments& a) {
  const std::vector<metrics::NamedProtocol> rules = protocols(a);
  for (const metrics::NamedProtocol& protocol : rules)
    metric_requests(a, protocol.rules);  // rejects invalid options before reading files
  const ReferenceBody body = reference_body(a);
  const std::vector<FilePair> files = file_pairs(a);
  reject_overwriting(all_files(a, files), a.per_pose);
  Reader reader{a, !has_offset(body) && uses_digits(rules)};
  std::vector<EvaluationResult> out;
  for (std::size_t begin = 0, end = 0; begin < files.size(); begin = end) {
    while (end < files.size() && files[end].reference == files[begin].reference) ++end;
    Reference reference{files[begin].reference, reader.read_reference(files[begin].reference), ""};
    reference.read.poses = to_estimate_body(std::move(reference.read.poses), body);
    if (files.size() > 1) reference.content = reference_content(reference.read.poses);
    std::vector<std::vector<EvaluationResult>> results(end - begin);
    parallel_for_tasks(results.size(), [&](std::size_t i) {
      results[i] = evaluated(reader, rules, reference, files[begin + i].estimate, files.size());
    });
    for (auto& each : results) std::ranges::move(each, std::back_inserter(out));
  }
  if (!a.times.empty() && !reader.has_used_times) throw unused_times(a);
  if (a.period && !reader.has_used_period) throw unused_period(a);
  return out;
}

}  // namespace loopbench::harness
