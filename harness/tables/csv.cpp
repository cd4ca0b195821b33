#include <fmt/format.h>

#include <cmath>

#include "harness/tables/text.hpp"

namespace loopbench::harness {

std::string quoted(const std::string& text) {
  if (text.find_first_of(",\"\n\r") == std::string::npos) return text;
  std::string out = "\"";
  for (const char c : text) out += c == '"' ? std::string("\"\"") : std::string(1, c);
  return out + "\"";
}

namespace {

/// Incomplete scores have numbers, too; the status column marks them.
bool has_numbers(const Record& r) { return r.status == "ok" || r.status == "incomplete"; }

}  // namespace

std::string csv(const std::vector<Table>& tables) {
  std::string out = "table,row,column,value,records,averaged,status,mark\n";
  for (const Table& table : tables) {
    for (std::size_t r = 0; r < table.rows.size(); ++r) {
      for (std::size_t c = 0; c < table.columns.size(); ++c) {
        const TableEntry& entry = table.entries[r][c];
        if (!entry.value && entry.status.empty()) continue;
        out += fmt::format("{},{},{},{},{},{},{},{}\n",
                           quoted(table.title),
                           quoted(table.rows[r]),
                           quoted(table.columns[c]),
                           entry.value ? fmt::format("{}", *entry.value) : "",
                           entry.records,
                           entry.averaged,
                           entry.value ? "ok" : entry.status,
                           mark_name(entry.mark));
      }
    }
  }
  return out;
}

std::string csv(const std::vector<Record>& records) {
  std::string out =
      "sequence,repeat,method,closures,oracle_closures,oracle_method,protocol,protocol_version,"
      "times,metric,label,"
      "relation,axis,unit,better,target,count,rmse,"
      "mean,median,std,min,max,sse,pairs,possible,milliseconds,status,why\n";
  for (const Record& r : records) {
    const metrics::Statistics& s = r.statistics;
    out += fmt::format("{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},",
                       quoted(r.sequence),
                       r.repeat,
                       quoted(r.method),
                       quoted(r.closures),
                       r.oracle_closures,
                       r.oracle,
                       quoted(r.protocol),
                       quoted(r.protocol_version),
                       r.times,
                       quoted(r.metric),
                       quoted(metric_label(r)),
                       r.relation,
                       r.axis,
                       r.unit,
                       to_text(r.better),
                       r.better == metrics::Better::target ? fmt::format("{}", r.target) : "");
    // An undefined score has empty fields, not zeros.
    const auto number = [](double x) { return std::isfinite(x) ? fmt::format("{}", x) : ""; };
    out += r.metric.empty() || !has_numbers(r) ? std::string(",,,,,,,,,,")
                                               : fmt::format("{},{},{},{},{},{},{},{},{},{},",
                                                             s.count,
                                                             number(s.rmse),
                                                             number(s.mean),
                                                             number(s.median),
                                                             number(s.std),
                                                             number(s.min),
                                                             number(s.max),
                                                             number(s.sse),
                                                             r.pairs,
                                                             r.possible);
    out += fmt::format("{},{},{}\n", r.milliseconds, r.status, quoted(r.why));
  }
  return out;
}

}  // namespace loopbench::harness
