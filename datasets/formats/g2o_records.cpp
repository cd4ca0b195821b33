#include "datasets/formats/g2o_records.hpp"

#include <string>
#include <utility>

#include "datasets/columns/columns.hpp"
#include "datasets/columns/parts.hpp"
#include "datasets/formats/g2o_lines.hpp"

namespace loopbench {
namespace {

Records read_g2o_part(TextFile& file, const InformationRules& rules) {
  first_line(file);
  Records out;
  const PoseTag* first = nullptr;
  std::size_t first_line_number = 0;
  for (Line line; file.next(line);) {
    const std::string_view word = Columns(file, line).peek();
    if (word == "PARAMS_SE3OFFSET") out.offsets.push_back(read_offset(file, line));
    if (word.starts_with("PARAMS")) continue;
    if (word == "FIX") {
      Columns columns(file, line);
      for (columns.word(); !columns.done();) {
        out.fixed.push_back({columns.integer("id"), 0, line.number});
      }
      continue;
    }
    if (auto prior = read_prior(file, line, word)) {
      out.priors.push_back(std::move(*prior));
      continue;
    }
    if (is_unused_tag(word)) {
      ++out.skipped[std::string(word)];
      Columns columns(file, line);
      if (columns.word() == "VERTEX_PLANE") out.planes.push_back(columns.integer("id"));
      continue;
    }
    const PoseTag& tag = find_pose_tag(file, line, word);
    if (first == nullptr) {
      first = &tag;
      first_line_number = line.number;
      out.kind = tag.kind();
    }
    if (tag.kind() != out.kind) {
      throw file.error(line.number,
                       "found " + std::string(tag.word) + " in a file with " +
                           std::string(first->word) + " on line " +
                           std::to_string(first_line_number) + ", expected one kind of pose");
    }
    if (tag.is_edge()) {
      if (out.edges.empty()) {
        out.edges.reserve(file.estimated_lines(line));
        out.ends.reserve(file.estimated_lines(line));
      }
      read_edge(file, line, tag, rules, out);
    } else {
      if (out.vertices.empty()) out.vertices.reserve(file.estimated_lines(line));
      out.vertices.push_back(read_vertex(file, line, tag));
    }
  }
  if (first == nullptr) throw file.error(0, "contains no vertices and no edges");
  out.lines = file.lines();
  return out;
}

}  // namespace

Records read_records(TextFile& file, const InformationRules& rules) {
  std::vector<Records> parts = read_parallel(
      file,
      [&rules](TextFile& part) { return read_g2o_part(part, rules); },
      [](const Records& a, const Records& b) { return a.kind == b.kind; });
  Records out = std::move(parts.front());
  for (std::size_t i = 1; i < parts.size(); ++i) {
    Records& more = parts[i];
    for (VertexRecord& vertex : more.vertices) vertex.line += out.lines;
    for (EdgeEnds& ends : more.ends) ends.line += out.lines;
    for (EdgeEnds& fixed : more.fixed) fixed.line += out.lines;
    for (PriorRecord& prior : more.priors) prior.line += out.lines;
    append(out.vertices, std::move(more.vertices));
    append(out.ends, std::move(more.ends));
    append(out.edges, std::move(more.edges));
    append(out.fixed, std::move(more.fixed));
    append(out.priors, std::move(more.priors));
    append(out.offsets, std::move(more.offsets));
    append(out.planes, std::move(more.planes));
    for (const auto& [tag, count] : more.skipped) out.skipped[tag] += count;
    out.lines += more.lines;
    out.altered += more.altered;
    out.scale_correlations += more.scale_correlations;
  }
  return out;
}

}  // namespace loopbench
