#include "harness/store/sequence_rows.hpp"

#include "harness/store/cell_rows.hpp"
#include "harness/store/digest.hpp"
#include "harness/store/write_digests.hpp"

namespace loopbench::harness {

SequenceRows read_sequence_rows(Database& database) {
  SequenceRows out;
  std::map<std::string, std::string> input_digests;
  SumOfDigests sum;
  Statement rows = database.prepare("SELECT * FROM sequence ORDER BY sequence_key");
  while (rows.step()) {
    const std::string sequence_key = rows.text();
    SequenceRow& s = out.by_key[sequence_key];
    s.configuration_hash = rows.text();
    s.options = rows.text();
    s.keyframes = rows.integer();
    rows.integer();  // odometry
    s.closures = rows.integer();
    rows.integer();  // frames
    rows.integer();  // reference
    s.content = rows.text();
    s.group = rows.text();
    input_digests[sequence_key] = rows.text();
    s.trace_digest = rows.text();
    s.digest = rows.text();
    s.intact = digest_of_columns(rows, 0, rows.columns() - 1) == s.digest;
    sum.add(s.digest);
  }
  out.complete = sum.text() == written_digest(database, "sequence");

  std::map<std::string, RowsDigest> inputs;
  Statement files = database.prepare("SELECT * FROM input ORDER BY sequence_key, number");
  while (files.step()) {
    const auto found = out.by_key.find(files.text());
    if (found == out.by_key.end()) continue;
    inputs[found->first].add(files, 1, files.columns());
    files.integer();  // number
    InputFile& file = found->second.inputs.emplace_back();
    file.option = files.text();
    file.path = files.text();
    file.bytes = static_cast<std::uint64_t>(files.integer());
    file.hash = files.text();
  }
  for (auto& [sequence_key, row] : out.by_key) {
    if (inputs[sequence_key].text() != input_digests[sequence_key]) row.intact = false;
  }
  return out;
}

void require_intact(const SequenceRows& rows, const std::filesystem::path& file) {
  if (!rows.complete) throw_damaged(file, "the table of sequences is");
  for (const auto& [sequence_key, row] : rows.by_key) {
    if (!row.intact) throw_damaged(file, "the metadata of sequence " + row.options + " is");
  }
}

}  // namespace loopbench::harness
