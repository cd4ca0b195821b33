#include "harness/tables/record_csv.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>

#include "harness/base/printable.hpp"

namespace loopbench::harness {
namespace {

/// Whether a spreadsheet would evaluate the text. Numbers with a sign, also with a unit, and a dash
/// are no formulas.
bool is_formula(const std::string& text) {
  if (text.empty() || text == "-") return false;
  if (text[0] == '=' || text[0] == '@') return true;
  if (text[0] != '+' && text[0] != '-') return false;
  double value = 0.0;
  const auto [rest, error] =
      std::from_chars(text.data() + (text[0] == '+' ? 1 : 0), text.data() + text.size(), value);
  const auto is_unit = [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == ' ' || c == '%' || c == '/';
  };
  return error != std::errc{} || !std::all_of(rest, text.data() + text.size(), is_unit);
}

}  // namespace

std::string quoted(const std::string& raw) {
  const std::string text = (is_formula(raw) ? "'" : "") + printable(raw);
  if (text.find_first_of(",\"\n\r") == std::string::npos) return text;
  std::string out = "\"";
  for (const char c : text) out += c == '"' ? std::string("\"\"") : std::string(1, c);
  return out + "\"";
}

const char* const kRowsHeader =
    "sequence,repeat,method,closures,oracle_closures,oracle_method,protocol,protocol_version,"
    "times,metric,label,"
    "relation,axis,unit,better,target,count,rmse,"
    "mean,median,std,min,max,sse,p90,p95,p99,pairs,possible,milliseconds,status,why\n";

std::string csv_row(const Record& r) {
  const metrics::Statistics& s = r.statistics;
  std::string out =
      fmt::format("{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},",
                  quoted(r.sequence),
                  r.repeat,
                  quoted(r.method),
                  quoted(r.closures),
                  r.oracle_closures,
                  r.oracle,
                  quoted(r.protocol),
                  quoted(r.protocol_version),
                  quoted(r.times),
                  quoted(r.metric),
                  quoted(metric_label(r)),
                  quoted(r.relation),
                  quoted(r.axis),
                  quoted(r.unit),
                  to_text(r.better),
                  r.better == metrics::Better::target ? fmt::format("{}", r.target) : "");
  // An undefined score has empty fields, not zeros.
  const auto number = [](double x) { return std::isfinite(x) ? fmt::format("{}", x) : ""; };
  out += r.metric.empty() || !has_numbers(r.status)
             ? std::string(",,,,,,,,,,,,,")
             : fmt::format("{},{},{},{},{},{},{},{},{},{},{},{},{},",
                           s.count,
                           number(s.rmse),
                           number(s.mean),
                           number(s.median),
                           number(s.std),
                           number(s.min),
                           number(s.max),
                           number(s.sse),
                           number(s.p90),
                           number(s.p95),
                           number(s.p99),
                           r.pairs,
                           r.possible);
  out +=
      fmt::format("{},{},{}\n", number(r.milliseconds), quoted(to_text(r.status)), quoted(r.why));
  return out;
}

std::string csv(const std::vector<Record>& records) {
  std::string out = kRowsHeader;
  for (const Record& r : records) out += csv_row(r);
  return out;
}

}  // namespace loopbench::harness
