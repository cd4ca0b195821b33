#include "harness/store/sequence_rows.hpp"

namespace loopbench::harness {

SequenceRows read_sequence_rows(Database& database) {
  SequenceRows out;
  Statement rows = database.prepare(
      "SELECT sequence_key, configuration_hash, options, keyframes, closures, content, group_name "
      "FROM sequence");
  while (rows.step()) {
    SequenceRow& s = out[rows.text()];
    s.configuration_hash = rows.text();
    s.options = rows.text();
    s.keyframes = rows.integer();
    s.closures = rows.integer();
    s.content = rows.text();
    s.group = rows.text();
  }
  Statement files = database.prepare(
      "SELECT sequence_key, option, path, bytes, hash FROM input ORDER BY sequence_key, number");
  while (files.step()) {
    const auto found = out.find(files.text());
    if (found == out.end()) continue;
    InputFile& file = found->second.inputs.emplace_back();
    file.option = files.text();
    file.path = files.text();
    file.bytes = static_cast<std::uint64_t>(files.integer());
    file.hash = files.text();
  }
  return out;
}

}  // namespace loopbench::harness
