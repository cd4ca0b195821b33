#include "harness/store/store.hpp"

#include <algorithm>

#include "datasets/core/error.hpp"
#include "harness/store/schema.hpp"
#include "harness/version.hpp"

namespace loopbench {
namespace {

const std::filesystem::path& set_aside(const std::filesystem::path& file) {
  try {
    if (file.has_parent_path()) std::filesystem::create_directories(file.parent_path());
    if (std::filesystem::exists(file)) {
      std::filesystem::rename(file, file.parent_path() / "previous.sqlite");
    }
    // Left by a kill: they belong to the file just moved and would corrupt the new one.
    for (const char* tail : {"-wal", "-shm"}) std::filesystem::remove(file.string() + tail);
  } catch (const std::filesystem::filesystem_error& error) {
    throw InputError(file.string() + ": cannot be written: " + error.code().message());
  }
  return file;
}

double median(std::vector<double> values) {
  if (values.empty()) return 0.0;
  std::ranges::sort(values);
  const std::size_t middle = values.size() / 2;
  return values.size() % 2 == 1 ? values[middle] : 0.5 * (values[middle - 1] + values[middle]);
}

std::string option_text(const std::vector<Choice>& stages) {
  std::string out;
  for (const Choice& stage : stages) {
    if (stage.options.empty()) continue;
    out += (out.empty() ? "" : "; ") + stage.name + ": " + to_text(stage.options);
  }
  return out;
}

std::filesystem::path store_file(const std::filesystem::path& given) {
  const std::filesystem::path file =
      std::filesystem::is_directory(given) ? given / "results.sqlite" : given;
  if (!std::filesystem::exists(file)) {
    throw InputError(file.string() + ": no such file, expected a store of results");
  }
  return file;
}

Database open_store(const std::filesystem::path& given) {
  const std::filesystem::path file = store_file(given);
  Database database(file, Database::Mode::read);
  Statement version = database.prepare("PRAGMA user_version");
  const std::int64_t found = version.step() ? version.integer() : 0;
  if (found != kSchemaVersion) {
    throw InputError(file.string() + ": is not a store of results of this version (schema " +
                     std::to_string(found) + ", expected " + std::to_string(kSchemaVersion) + ")");
  }
  return database;
}

}  // namespace

Store::Store(const std::filesystem::path& file, const Sweep& sweep)
    : database_(set_aside(file), Database::Mode::create) {
  // WAL with NORMAL survives a killed process; only a power cut may lose the last cells, whole.
  database_.execute("PRAGMA journal_mode = WAL; PRAGMA synchronous = NORMAL;");
  database_.execute("BEGIN");
  database_.execute(kSchema);
  database_.execute("PRAGMA user_version = " + std::to_string(kSchemaVersion));
  Statement insert = database_.prepare("INSERT INTO run VALUES (?, ?)");
  const auto say = [&](const std::string& key, const std::string& text) {
    insert.bind(key).bind(text).run();
  };
  say("loopbench", kVersion);
  say("sweep", sweep.name);
  say("config", sweep.text);
  std::string rules;  // in full, one protocol a line
  for (const NamedProtocol& protocol : sweep.protocols) {
    rules +=
        protocol.label() + " [" + protocol.version + "]: " + to_text(echo(protocol.rules)) + "\n";
  }
  say("protocol", rules);
  say("baseline", sweep.baseline);
  database_.execute("COMMIT");
}

Store::~Store() {
  try {
    database_.execute("PRAGMA journal_mode = DELETE");  // leaves one file, nothing beside it
  } catch (const std::exception&) {
    // Another reader holds it: the -wal file stays and is merged by the next one to open it.
  }
}

void Store::write(const Sweep& sweep, const CellResult& result) {
  const DatasetChoice& dataset = sweep.datasets[result.cell.dataset];
  const MethodChoice& method = sweep.methods[result.cell.method];
  const auto id = static_cast<std::int64_t>(result.cell.index);
  const auto [low, high] = std::ranges::minmax_element(result.seconds);
  const bool timed = !result.seconds.empty();

  database_.execute("BEGIN");
  database_.prepare("INSERT INTO cell VALUES (?,?,?,?,?,?,?,?,?,?,?,?,?,?,?)")
      .bind(id)
      .bind(dataset.label)
      .bind(std::int64_t{result.cell.repeat})
      .bind(method.label)
      .bind(option_text({dataset.dataset}))
      .bind(option_text(method.stages))
      .bind(result.closures)
      .bind(std::int64_t{result.oracle_closures})
      .bind(std::int64_t{result.oracle_method})
      .bind(static_cast<std::int64_t>(result.seconds.size()))
      .bind(median(result.seconds))
      .bind(timed ? *low : 0.0)
      .bind(timed ? *high : 0.0)
      .bind(to_text(result.status))
      .bind(result.why)
      .run();
  Statement score =
      database_.prepare("INSERT INTO score VALUES (?,?,?,?,?,?,?,?,?,?,?,?,?,?,?,?,?,?,?,?,?)");
  for (const ScoreResult& row : result.scores) {
    const Statistics& s = row.score.statistics;
    const NamedProtocol& protocol = sweep.protocols[row.protocol];
    score.bind(id)
        .bind(protocol.label())
        .bind(protocol.version)
        .bind(to_text(row.times))
        .bind(row.metric)
        .bind(row.score.relation)
        .bind(row.score.axis)
        .bind(row.score.unit)
        .bind(static_cast<std::int64_t>(s.count))
        .bind(s.rmse)
        .bind(s.mean)
        .bind(s.median)
        .bind(s.std)
        .bind(s.min)
        .bind(s.max)
        .bind(s.sse)
        .bind(static_cast<std::int64_t>(row.coverage.pairs))
        .bind(static_cast<std::int64_t>(row.coverage.possible))
        .bind(row.coverage.span)
        .bind(to_text(row.status))
        .bind(row.why)
        .run();
  }
  Statement phase = database_.prepare("INSERT INTO phase VALUES (?,?,?)");
  for (const Phase& p : result.report.phases) phase.bind(id).bind(p.name).bind(p.seconds).run();
  Statement count = database_.prepare("INSERT INTO count VALUES (?,?,?)");
  for (const Count& c : result.report.counts) count.bind(id).bind(c.name).bind(c.value).run();
  Statement note = database_.prepare("INSERT INTO note VALUES (?,?)");
  for (const std::string& text : result.report.notes) note.bind(id).bind(text).run();
  database_.execute("COMMIT");
}

std::vector<Record> read_records(const std::filesystem::path& file) {
  Database database = open_store(file);
  // A declined or failed cell has no score: the left join keeps it, with empty score columns.
  Statement rows = database.prepare(R"sql(
    SELECT c.id, c.sequence, c.repeat, c.method, c.closures, c.oracle_closures, c.oracle_method,
           c.seconds_median * 1000, s.protocol, s.protocol_version, s.times, s.metric, s.relation, s.axis, s.unit,
           s.count, s.rmse, s.mean, s.median, s.std, s.min, s.max, s.sse, s.pairs, s.possible,
           -- An incomplete cell may be complete at other times: its scores know.
           CASE WHEN c.status IN ('ok', 'incomplete') THEN coalesce(s.status, c.status)
                ELSE c.status END,
           CASE WHEN c.why = '' OR c.status = 'incomplete' THEN coalesce(s.why, c.why)
                ELSE c.why END
    FROM cell c LEFT JOIN score s ON s.cell = c.id ORDER BY c.id, s.rowid)sql");
  std::vector<Record> out;
  while (rows.step()) {
    Record r;
    r.cell = rows.integer();
    r.sequence = rows.text();
    r.repeat = rows.integer();
    r.method = rows.text();
    r.closures = rows.text();
    r.oracle_closures = rows.integer() != 0;
    r.oracle_method = rows.integer() != 0;
    r.milliseconds = rows.real();
    r.protocol = rows.text();
    r.protocol_version = rows.text();
    r.times = rows.text();
    r.metric = rows.text();
    r.relation = rows.text();
    r.axis = rows.text();
    r.unit = rows.text();
    r.statistics.count = static_cast<std::size_t>(rows.integer());
    for (double* number : {&r.statistics.rmse,
                           &r.statistics.mean,
                           &r.statistics.median,
                           &r.statistics.std,
                           &r.statistics.min,
                           &r.statistics.max,
                           &r.statistics.sse}) {
      *number = rows.real();
    }
    r.pairs = rows.integer();
    r.possible = rows.integer();
    r.status = rows.text();
    r.why = rows.text();
    out.push_back(std::move(r));
  }
  return out;
}

std::map<std::string, std::string> read_run(const std::filesystem::path& file) {
  Database database = open_store(file);
  Statement rows = database.prepare("SELECT key, value FROM run");
  std::map<std::string, std::string> out;
  while (rows.step()) {
    std::string key = rows.text();
    out.emplace(std::move(key), rows.text());
  }
  return out;
}

}  // namespace loopbench
