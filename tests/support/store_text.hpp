/// A store as text, without times, memory and order of writing, which differ from run to run.
#pragma once

#include <cstdio>
#include <filesystem>
#include <string>

#include "harness/sweep/model/note_text.hpp"
#include "harness/sweep/store/read.hpp"
#include "harness/sweep/store/traces.hpp"

namespace loopbench {

using namespace methods;
using namespace metrics;
using namespace harness;

/// One line per cell, score, count, note and trace; numbers in full (%a), in the sweep's order.
inline std::string store_text(const std::filesystem::path& file) {
  std::string out;
  const auto exact = [](double value) {
    char text[40];
    std::snprintf(text, sizeof text, "%a", value);
    return std::string(text);
  };
  Traces traces(file);
  for (const CellRow& c : read_cells(file)) {
    out += std::to_string(c.position) + "|" + c.key + "|" + c.sequence + "|" +
           std::to_string(c.repeat) + "|" + c.method + "|" + c.method_options + "|" +
           c.dataset_options + "|" + c.closures + "|" + std::to_string(c.keyframes) + "|" +
           c.worker + "|" + to_text(c.status) + "|" + c.signal + "|" + c.why + "\n";
    for (const Count& count : c.counts) out += count.name + "=" + exact(count.value) + "\n";
    for (const std::string& note : harness::texts(c.notes)) out += "note " + note + "\n";
    for (const Section& s : traces.sections(c.position)) {
      out += s.kind + " " + exact(s.begin) + " " + exact(s.end) + " " + s.what + "\n";
    }
    if (const auto trace = traces.cell(c.position)) {
      out += "trace " + std::to_string(trace->samples.size());
      for (const TraceSample& s : trace->samples) {
        out +=
            " " + exact(static_cast<double>(s.error_x)) + exact(static_cast<double>(s.estimate.y));
      }
      out += "\n";
    }
    if (const auto trace = traces.sequence(c.position)) {
      out += "sequence " + std::to_string(trace->reference.size()) + " " +
             std::to_string(trace->closures.size()) + "\n";
    }
  }
  for (const Record& r : read_records(file)) {
    const Statistics& s = r.statistics;
    out += std::to_string(r.cell->position) + "|" + r.kind->protocol + "|" + r.kind->times + "|" +
           r.kind->metric + "|" + r.kind->relation + "|" + r.kind->axis + "|" + r.kind->unit + "|" +
           std::to_string(s.count);
    for (const double value : {s.rmse, s.mean, s.median, s.std, s.min, s.max, s.sse}) {
      out += "|" + exact(value);
    }
    out += "|" + std::to_string(r.pairs) + "|" + to_text(r.status) + "|" + r.why + "\n";
  }
  return out;
}

}  // namespace loopbench
