#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <set>

#include "datasets/core/error.hpp"
#include "harness/answers/compare/derived.hpp"
#include "harness/answers/compare/distributions.hpp"
#include "harness/answers/tables/growth.hpp"
#include "harness/answers/tables/store_tables.hpp"
#include "harness/answers/tables/success.hpp"
#include "harness/commands/checks.hpp"
#include "harness/commands/commands.hpp"
#include "harness/commands/write_output.hpp"
#include "harness/sweep/model/record_columns.hpp"
#include "harness/sweep/model/where.hpp"
#include "harness/sweep/store/read.hpp"

namespace loopbench::harness {
namespace {

struct TableArguments {
  std::string store;
  TableSpec spec;
  std::vector<std::string> where;
  std::optional<double> success;  ///< limit of the error of a successful run
  OutputOptions output;
  bool growth = false;
  bool intervals = false;          ///< of means, instead of standard deviations
  bool has_default_layout = true;  ///< no --rows, --columns, --split
  bool is_for_paper = false;       ///< --format latex or markdown

  bool is_selected() const { return !where.empty() || !spec.show.empty() || success; }
};

/// Half of the 95 % interval of the mean of so many values with this sample deviation, by Student's
/// distribution. More than one value; a mean with unequal weights has fewer of equal weight.
double half_interval(double deviation, double count) {
  double low = 1.0, high = 1e6;
  const double degrees = count - 1.0;
  for (int step = 0; step < 60; ++step) {
    const double middle = 0.5 * (low + high);
    (student_two_sided(middle, degrees) > 0.05 ? low : high) = middle;
  }
  return low * deviation / std::sqrt(count);
}

/// Replaces standard deviations by half of the intervals of the means.
void set_intervals(std::vector<Table>& tables) {
  for (Table& table : tables) {
    for (std::vector<TableCell>& line : table.lines) {
      for (TableCell& cell : line) {
        if (cell.deviation) cell.deviation = half_interval(*cell.deviation, cell.effective);
      }
    }
    format_means(table);
    if (!table.averages) continue;
    Averages now = *table.averages;
    now.deviation = Deviation::half_interval;
    std::ranges::replace(
        table.notes, TableNote(averages_text(*table.averages)), TableNote(averages_text(now)));
    table.averages = now;
  }
}

std::string tables_text(const TableArguments& arguments) {
  const ExportFormat format = arguments.output.format();
  std::vector<Table> tables;
  if (arguments.growth) {
    tables = {growth_table(read_cells(arguments.store))};
    if (tables.front().lines.empty()) {
      throw InputError(arguments.store + ": has no sweep over three sizes of a sequence, such as " +
                       "{dataset: simulated, sweep: {keyframes: [60, 240, 960]}}");
    }
  } else if (arguments.success) {
    std::vector<Record> records = read_records(arguments.store);
    keep_where(records, arguments.where);
    tables = {success_table(records, arguments.spec.value, *arguments.success)};
  } else {
    tables = store_tables(arguments.store, arguments.where, arguments.spec);
  }
  if (arguments.intervals) set_intervals(tables);
  if (format == ExportFormat::csv) return csv(tables);
  if (format == ExportFormat::json) return json(tables);
  return text(tables, arguments.output, arguments.store, arguments.where);
}

/// The first record of a score with a direction; empty if there is none.
Record first_score(const std::string& store) {
  RecordReader reader(store);
  Record out;
  reader.for_each_chunk([&](std::vector<Record>& records) {
    const auto found = std::ranges::find_if(records, [](const Record& r) {
      return r.has_score() && r.kind->better != metrics::Better::neither;
    });
    if (found != records.end()) out = *found;
    return found == records.end();
  });
  return out;
}

/// If the records that are shown have one score and several sequences: a column for each sequence,
/// or a row for each of many. Returns whether that is so.
bool choose_sequences(TableArguments& arguments) {
  constexpr std::size_t kMostColumns = 12;  // as in the summary of `run`
  TableSpec& spec = arguments.spec;
  const std::string baseline = read_run(arguments.store).at("baseline");
  const auto is_kept = where(arguments.where);
  std::set<std::string> scores, known;
  std::set<SharedText> sequences;
  RecordReader reader(arguments.store);
  reader.for_each_chunk([&](std::vector<Record>& records) {
    add_derived(records, baseline, asked_by(spec, arguments.where));
    for (const Record& r : records) {
      if (!is_kept(r)) continue;
      sequences.insert(r.cell->sequence);
      if (!r.has_score()) continue;
      const std::string score = r.kind->short_name();
      known.insert(score);
      if (spec.show.empty() || std::ranges::count(spec.show, score) > 0) scores.insert(score);
    }
    return scores.size() < 2;
  });
  if (scores.empty() && !known.empty()) {
    throw InputError("--show: " +
                     unknown_name("score", spec.show.front(), {known.begin(), known.end()}));
  }
  if (scores.size() != 1 || sequences.size() < 2) return false;
  spec.columns = {"sequence"};
  if (sequences.size() > kMostColumns) std::swap(spec.rows, spec.columns);
  spec.split = {"score", "relation", "times"};
  return true;
}

/// For a paper: the first score of each sequence; of one sequence its translation and rotation,
/// change and processor time.
void choose_for_paper(TableArguments& arguments) {
  const Record first = first_score(arguments.store);
  if (!first.has_score()) return;
  const std::string score = first.kind->short_name();
  arguments.spec.show = {score};
  arguments.where = {"relation=\"" + first.kind->relation + "\""};
  if (choose_sequences(arguments)) {
    arguments.spec.split = {"score", "relation"};
    return;
  }
  arguments.where.clear();
  arguments.spec.show = {score, "change", "cpu"};
  arguments.spec.split = {"sequence"};
}

int print_table(TableArguments arguments) {
  std::vector<std::string> show;
  for (const std::string& word : arguments.spec.show) {
    for (std::string& score : split_list(word)) show.push_back(std::move(score));
  }
  arguments.spec.show = std::move(show);
  if (arguments.has_default_layout && !arguments.success && !arguments.growth) {
    if (arguments.is_selected()) {  // otherwise there are several scores
      choose_sequences(arguments);
    } else if (arguments.is_for_paper) {
      choose_for_paper(arguments);
    }
  }
  write_output(tables_text(arguments), arguments.output, "tables", arguments.store);
  return kExitOk;
}

}  // namespace

void add_table(CLI::App& app, int& exit_code) {
  auto arguments = std::make_shared<TableArguments>();
  TableArguments& a = *arguments;
  CLI::App& command = *app.add_subcommand("table", "Print tables of a sweep's results");
  declare_store(command, a.store);
  const auto layout = [&](const char* name, std::vector<std::string>& fields, const char* help) {
    add(command, name, fields, help)->delimiter(',')->capture_default_str();
  };
  layout("--rows", a.spec.rows, "Fields whose values are the rows, comma-separated");
  layout("--columns", a.spec.columns, "Fields whose values are the columns");
  layout("--split",
         a.spec.split,
         "Fields for whose values there is a table each; '' makes one table. Without --rows, "
         "--columns and --split, a single score of several sequences gives one table of methods by "
         "sequences");
  command.footer(fmt::format("Fields: {}, and options of methods (planar).",
                             fmt::join(record_columns(), ", ")));
  add(command,
      "--value",
      a.spec.value,
      fmt::format("Statistic: {}", fmt::join(statistic_names(), " ")))
      ->capture_default_str();
  command.add_flag("--plus-minus",
                   a.spec.plus_minus,
                   "Add the standard deviation over the averaged cells to each number");
  command
      .add_flag("--intervals",
                a.intervals,
                "Add half of the 95 % interval of the mean of the averaged cells to each number")
      ->excludes("--plus-minus");
  add(command,
      "--show",
      a.spec.show,
      "Scores to show: ate,error x,change,gain,time,cpu,wall,memory; change is relative to the "
      "baseline in percent, gain is minus the change. Default: all but change and costs; with "
      "--format latex or markdown the first one (of a single sequence also change and cpu)");
  add(command,
      "--success",
      a.success,
      "Print the share of runs of each method whose error is at most this (in its unit); failed "
      "and incomplete runs do not succeed. Default: the first score, usually ATE; others by "
      "--where and --value")
      ->check(finite_number());
  command.add_flag(
      "--growth",
      a.growth,
      "Print how processor time and memory of each method grow in a sweep over the number "
      "of keyframes or closures: fitted exponents with intervals");
  add(command,
      "--where",
      a.where,
      "Filter of rows: FIELD=TEXT, FIELD!=TEXT, FIELD~REGEX, comma-separated; FIELD=\"TEXT\" if "
      "TEXT contains commas");
  declare(command, a.output);
  command.callback([arguments, &a, &command, &exit_code] {
    for (const char* name : {"--rows", "--columns", "--split"}) {
      if (command.count(name) > 0) a.has_default_layout = false;
    }
    const ExportFormat format = a.output.format();
    a.is_for_paper = command.count("--format") > 0 &&
                     (format == ExportFormat::latex || format == ExportFormat::markdown);
    if (command.count("--split") == 0) {
      std::erase_if(a.spec.split, [&](const std::string& field) {
        return std::ranges::count(a.spec.rows, field) > 0 ||
               std::ranges::count(a.spec.columns, field) > 0;
      });
    }
    if (a.intervals && (format == ExportFormat::csv || format == ExportFormat::json))
      throw InputError("--intervals: needs a format for reading; in csv and json use --plus-minus");
    if (a.intervals) a.spec.plus_minus = true;
    exit_code = print_table(a);
  });
}

}  // namespace loopbench::harness
