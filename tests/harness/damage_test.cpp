/// Stores with changed bytes: an error or the original result, never another number.
#include <random>
#include <tuple>

#include "harness/sweep/store/merge.hpp"
#include "harness/sweep/store/open.hpp"
#include "tests/support/command.hpp"
#include "tests/support/tiny_store.hpp"

namespace loopbench::tiny_store::damage_test {
namespace {

using testing::HasSubstr;

class Damage : public TinyStore {
 protected:
  void put(const std::string& bytes) const {
    for (const char* tail : {"-wal", "-shm", "-journal"}) {
      std::filesystem::remove(file_.string() + tail);
    }
    std::ofstream(file_, std::ios::binary) << bytes;
  }

  /// A byte on a used page, since most pages of such a small store are empty.
  static std::size_t place(const std::string& bytes, std::mt19937_64& random) {
    std::size_t at = random() % bytes.size();
    while (bytes[at] == 0) at = random() % bytes.size();
    return at;
  }

  void change(const std::string& sql) const { Database(file_, Database::Mode::read).execute(sql); }

  /// Without the traces of sequences: a lost one is only not drawn.
  static std::string stored_cells(const std::filesystem::path& file) {
    std::istringstream in(store_text(file));
    std::string out;
    for (std::string line; std::getline(in, line);) {
      if (!line.starts_with("sequence ")) out += line + "\n";
    }
    return out;
  }

  static std::string description(const std::filesystem::path& file) {
    std::string out;
    for (const auto& [key, value] : read_run(file)) {
      if (key != "cells") out += key + value + "\n";  // counts those that are set aside, too
    }
    for (const auto& [key, value] : read_provenance(file)) out += key + value + "\n";
    for (const auto& [key, files] : read_inputs(file)) {
      for (const InputFile& each : files) out += key + each.option + each.path + each.hash + "\n";
    }
    return out;
  }

  /// All that is read of the cells, including times and memory.
  static std::string answers(const std::filesystem::path& file) {
    std::string out = stored_cells(file);
    for (const CellRow& c : read_cells(file)) {
      out += c.build + std::to_string(c.seconds) + std::to_string(c.peak_memory.value_or(-1)) +
             std::to_string(c.closure_count) + std::to_string(c.oracle) + "\n";
      for (const Phase& p : c.phases) out += p.name + std::to_string(p.seconds) + "\n";
    }
    for (const Record& r : read_records(file)) {
      out += r.cell->sequence + r.cell->method + r.kind->protocol_version +
             std::to_string(r.possible) + r.cell->closures +
             std::to_string(r.cell->milliseconds()) + "\n";
    }
    for (const auto& [key, value] : read_dataset_options(file)) out += key + value + "\n";
    return out + description(file);
  }

  std::string refusal() const {
    return refusal_of<InputError>([&] { answers(file_); });
  }
};

/// One method fails, so that reasons and states can be damaged, too.
const std::string kConfigWithFailures = config(
    "straight, {method: shift, by: 1, label: shifted}, {method: shift, fail: true, label: "
    "fails}");

TEST_F(Damage, AChangedByteIsAnErrorOrChangesNothing) {
  run(kConfigWithFailures);
  const std::string sound = read_all(file_);
  const std::string expected = answers(file_);
  std::mt19937_64 random(11);
  int errors = 0;
  int harmless = 0;
  for (int i = 0; i < 400; ++i) {
    std::string bytes = sound;
    const std::size_t at = i % 4 == 0 ? random() % bytes.size() : place(bytes, random);
    bytes[at] = static_cast<char>(bytes[at] ^ static_cast<char>(1u << (random() % 8)));
    put(bytes);
    try {
      ASSERT_EQ(answers(file_), expected) << "byte " << at;
      ++harmless;
    } catch (const InputError& error) {
      EXPECT_NE(std::string(error.what()).find(file_.string()), std::string::npos) << error.what();
      ++errors;
    }
  }
  RecordProperty("errors", errors);
  RecordProperty("harmless", harmless);
  EXPECT_GT(errors, 50) << harmless << " harmless";
}

TEST_F(Damage, RunMakesTheDamagedCellsAgain) {
  run(kConfigWithFailures);
  const std::string sound = read_all(file_);
  const std::string expected = stored_cells(file_);
  std::mt19937_64 random(12);
  int repaired = 0;
  for (int i = 0; i < 100; ++i) {
    std::string bytes = sound;
    const std::size_t at = place(bytes, random);
    bytes[at] = static_cast<char>(random());
    put(bytes);
    try {
      const Ran again = run(kConfigWithFailures);
      if (!again.cells.empty()) ++repaired;
    } catch (const InputError&) {
      continue;  // cannot be repaired, which the message states
    }
    try {
      ASSERT_EQ(stored_cells(file_), expected) << "byte " << at;
      ASSERT_EQ(run(kConfigWithFailures).cells, Labels{}) << "byte " << at;
    } catch (const InputError& error) {  // in a page that the run had no need to read
      ASSERT_THAT(error.what(), HasSubstr("--fresh starts a new store")) << "byte " << at;
    }
  }
  EXPECT_GT(repaired, 10);
}

TEST_F(Damage, RunMendsAChangedKeyAndAChangedIndex) {
  run(kUsual);
  const std::string sound = read_all(file_);
  const std::string expected = stored_cells(file_);
  int count = 0;  // one of them in the table, another in its index
  for (std::size_t at = sound.find("baseline"); at != std::string::npos;
       at = sound.find("baseline", at + 1)) {
    std::string bytes = sound;
    bytes[at + 1] = 'b';
    put(bytes);
    EXPECT_THAT(refusal(), HasSubstr("is damaged")) << "byte " << at;
    run(kUsual);
    EXPECT_EQ(stored_cells(file_), expected) << "byte " << at;
    EXPECT_EQ(run(kUsual).cells, Labels{}) << "byte " << at;
    ++count;
  }
  EXPECT_GE(count, 2);
}

TEST_F(Damage, ALostOrChangedRowIsNoticedWhereverItWas) {
  run(kUsual);
  const std::string sound = read_all(file_);
  const std::string expected = store_text(file_);
  const char* const other_definition =
      "UPDATE score_value SET definition = (SELECT definition FROM score_value WHERE number = 1) "
      "WHERE cell = 2 AND number = 0";
  for (const std::string damage :
       {"DELETE FROM cell WHERE id = 2",
        "DELETE FROM score_value WHERE cell = 2 AND number = 1",
        "DELETE FROM section WHERE cell = 2",
        "UPDATE score_definition SET metric = 'other' WHERE times = 'dense'",
        other_definition,
        "UPDATE score_value SET status = 'failed' WHERE cell = 2 AND number = 0",
        "UPDATE cell SET method = 'other' WHERE id = 2",
        "UPDATE sequence SET group_name = 'other'",
        "UPDATE sequence SET group_kind = 'files'",
        "UPDATE sequence SET recording = 'other'",
        "UPDATE sequence SET sequence_key = 'f' || sequence_key"}) {
    put(sound);
    change(damage);
    EXPECT_NE(refusal().find("is damaged"), std::string::npos) << damage;
    EXPECT_FALSE(run(kUsual).cells.empty()) << damage;
    EXPECT_EQ(store_text(file_), expected) << damage;
    EXPECT_EQ(run(kUsual).cells, Labels{}) << damage;
  }
  put(sound);  // names the cell and what to do
  change("UPDATE score_value SET rmse = 0 WHERE cell = (SELECT id FROM cell WHERE position = 3)");
  EXPECT_THAT(refusal(), HasSubstr("results.sqlite: is damaged: b / shifted is corrupted"));
  EXPECT_THAT(refusal(), HasSubstr("recomputes it"));
  const Ran again = run(kUsual);
  EXPECT_EQ(again.cells, Labels{"b / shifted"});
  EXPECT_EQ(again.resumed.damaged, Labels{"b / shifted"});
  EXPECT_EQ(store_text(file_), expected);
}

TEST_F(Damage, ADescriptionIsRejectedByItsRowAndWrittenAgain) {
  folder_.file("bias", "0.1");
  const std::string text =
      "datasets: [{dataset: file, path: bias, label: f}, {dataset: line, label: g}]\n"
      "methods: [straight]\nmetrics: [ate]\n";
  run(text);
  const std::string sound = read_all(file_);
  const std::string expected = stored_cells(file_) + description(file_);
  const Labels none, with_file{"f / straight"};
  for (const auto& [damage, row, recomputed] :
       {std::tuple("UPDATE run SET value = 'x' WHERE key = 'config'", "row config of", none),
        std::tuple("UPDATE run SET key = 'x' WHERE key = 'baseline'", "row x of", none),
        std::tuple("UPDATE run SET value = 9 WHERE key = 'cells'", "row cells of", none),
        std::tuple("DELETE FROM run WHERE key = 'alignment'", "row alignment of", none),
        std::tuple("UPDATE provenance SET value = 'x'", "of its table provenance", none),
        std::tuple("UPDATE provenance SET row_hash = 1", "of its table provenance", none),
        std::tuple("UPDATE input SET path = 'x'", "of its table input", with_file),
        std::tuple("UPDATE input SET sequence_key = 'x'", "row x of its table input", with_file)}) {
    put(sound);
    change(damage);
    EXPECT_NE(refusal().find(row), std::string::npos) << damage << ": " << refusal();
    EXPECT_EQ(run(text).cells, recomputed) << damage;
    EXPECT_EQ(stored_cells(file_) + description(file_), expected) << damage;
  }
  put(sound);
  change("UPDATE provenance SET value = 'other'");
  commit_ = "decaf";  // the provenance of the cells is not known
  EXPECT_EQ(run(text).cells.size(), 2u);
  EXPECT_EQ(read_provenance(file_).at("commit"), "decaf");
}

TEST_F(Damage, NotesOfASequenceAreNeitherChangedNorLost) {
  known_.datasets.push_back(dataset<tiny::LineOptions>(
      "talks", "", [](const tiny::LineOptions& options, const DataRoot& root) {
        Sequence out = tiny::load_line(options, root);
        out.provenance.notes = {"skipped 3 rows", "sorted 2 rows"};
        return out;
      }));
  const std::string text =
      "datasets: [{dataset: talks, label: t}, {dataset: line, label: l}]\nmethods: [straight]\n"
      "metrics: [ate]\n";
  run(text);
  const std::string sound = read_all(file_);
  for (const char* const damage : {"UPDATE sequence_note SET text = 'x' WHERE number = 1",
                                   "UPDATE sequence_note SET notes_key = 'x' WHERE number = 1",
                                   "DELETE FROM sequence_note WHERE number = 1"}) {
    put(sound);
    change(damage);
    EXPECT_NE(refusal(), "") << damage;
    EXPECT_EQ(run(text).cells, Labels{"t / straight"}) << damage;
    EXPECT_EQ(read_notes(file_).notes.size(), 4u) << damage;
  }
}

TEST_F(Damage, ADamagedStoreIsNotMerged) {
  run(kUsual);
  change("UPDATE trace SET samples = zeroblob(length(samples)) WHERE cell = 1");
  const std::filesystem::path out = folder_.path() / "merged.sqlite";
  EXPECT_THROW(merge_stores({file_}, out), InputError);
  EXPECT_FALSE(std::filesystem::exists(out));
  EXPECT_EQ(run(kUsual).cells, Labels{"a / straight"});
  EXPECT_EQ(merge_stores({file_}, out).cells, 4u);
}

TEST_F(Damage, AnotherToolMayPackItButNotExtendIt) {
  run(kUsual);
  const std::string sound = read_all(file_);
  const std::string expected = answers(file_);
  change("VACUUM");
  EXPECT_EQ(answers(file_), expected);
  EXPECT_EQ(run(kUsual).cells, Labels{});
  for (const auto& [added, name] :
       {std::pair("CREATE VIEW best AS SELECT min(rmse) FROM score", "view best"),
        std::pair("CREATE TRIGGER zero AFTER INSERT ON score_value BEGIN UPDATE score_value SET "
                  "rmse = 0 WHERE cell = new.cell; END",
                  "trigger zero"),
        std::pair("CREATE TABLE other (a)", "table other"),
        std::pair("DROP TABLE phase", "table phase"),
        std::pair("ALTER TABLE note ADD COLUMN more TEXT", "table note")}) {
    put(sound);
    change(added);
    EXPECT_NE(refusal().find(name), std::string::npos) << refusal();
    expect_refused(name);
  }
}

}  // namespace
}  // namespace loopbench::tiny_store::damage_test
