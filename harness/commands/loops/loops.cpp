#include "harness/commands/loops/loops.hpp"

#include <algorithm>
#include <filesystem>
#include <string_view>
#include <utility>
#include <vector>

#include "datasets/core/error.hpp"
#include "datasets/derive/problem_graph.hpp"
#include "datasets/files/text_writer.hpp"
#include "datasets/formats/formats.hpp"
#include "datasets/formats/g2o_prior_lines.hpp"

namespace loopbench::harness {
namespace {

/// Indices of the anchors that do not agree, ascending.
std::vector<std::size_t> dropped_anchors(const LoopsResult& result) {
  const auto& found = result.ledger.anchors;
  std::vector<std::size_t> out;
  for (std::size_t i = 0; found && i < found->anchors.size(); ++i) {
    if (!found->is_decided || !found->anchors[i].agrees) out.push_back(i);
  }
  return out;
}

}  // namespace

LoopsResult loops(Problem problem,
                  std::string estimate,
                  const std::function<void(const std::string&)>& progress) {
  if (const std::string why = methods::why_no_ledger(problem); !why.empty()) {
    const bool needs_file = problem.closures.empty() && problem.ids.empty();
    throw InputError(estimate + ": " + why + (needs_file ? ", expected --loops FILE" : ""));
  }
  LoopsResult out{std::move(estimate), std::move(problem), {}};
  methods::LedgerSettings settings;
  if (progress) settings.progress = progress;
  try {
    out.ledger = methods::closure_ledger(out.problem, settings);
  } catch (const InputError&) {
    throw;
  } catch (const std::runtime_error& error) {
    throw InputError(out.estimate + ": its measurements cannot be checked: " + error.what());
  }
  return out;
}

methods::NextClosures next_closures(const LoopsResult& result) {
  try {
    return methods::next_closures(methods::trusted_problem(result.problem, result.ledger));
  } catch (const std::runtime_error& error) {
    throw InputError(result.estimate + ": no covariances of the positions: " + error.what());
  }
}

void write_repaired(const LoopsResult& result,
                    const Provenance& provenance,
                    const std::filesystem::path& file) {
  const methods::ClosureLedger& ledger = result.ledger;
  const auto fail = [&](const std::string& why) {
    return InputError(file.string() + " is not written: " + why);
  };
  if (ledger.rows.empty()) {
    if (!ledger.anchors->is_decided) throw fail("which anchors are right is not decided");
  } else if (!ledger.judgement || !ledger.judgement->is_decided()) {
    throw fail("which closures are right is not decided");
  }
  const bool has_anchors = !result.problem.anchors.empty();
  const bool has_lines = detect_format(result.estimate) == Format::g2o;
  if (has_anchors && !has_lines) throw fail("a g2o graph contains no anchors of other files");
  const Problem trusted = methods::trusted_problem(result.problem, ledger);
  PoseGraph graph = problem_graph(trusted, result.problem.keyframes, result.problem.ids);
  std::erase_if(graph.edges, [&](const Edge& edge) {
    return std::ranges::any_of(provenance.held, [&](const Edge& held) {
      return edge.from == held.from && edge.to == held.to &&
             edge.information.isApprox(held.information);
    });
  });
  graph.fixed = provenance.fixed;
  TextWriter out = g2o_text(graph);
  if (has_anchors) {
    const std::vector<std::size_t> dropped = dropped_anchors(result);
    const std::vector<Anchor>& anchors = result.problem.anchors;
    for (const std::string& line : prior_lines(result.estimate, graph, anchors, dropped)) {
      out.word(line).end_line();
    }
    for (const std::size_t i : dropped) {
      out.comment("dropped anchor: " + result.problem.name_of(anchors[i].keyframe));
    }
  }
  for (std::size_t rank = 0; rank < ledger.suspects.size(); ++rank) {
    if (std::string_view(judgement(result, rank)) == "agrees") continue;
    out.comment("dropped: " + closure_name(result.problem, ledger.suspects[rank]));
  }
  if (ledger.judgement) {
    for (const methods::FreedStep& step : ledger.judgement->steps) {
      out.comment("freed: " + step_name(result.problem, step.from));
    }
  }
  out.save(file);
}

}  // namespace loopbench::harness
