#include "harness/tables/origin.hpp"

#include <nlohmann/json.hpp>
#include <sstream>

#include "harness/store/read.hpp"

namespace loopbench::harness {
namespace {

using OriginJson = nlohmann::ordered_json;

/// "key: value", or "key:" and indented lines for a multi-line value.
void add_fact(std::vector<std::string>& out, const std::string& key, const std::string& value) {
  std::istringstream in(value);
  std::vector<std::string> lines;
  for (std::string line; std::getline(in, line);) lines.push_back(line);
  if (lines.empty()) return;
  if (lines.size() == 1) return out.push_back(key + ": " + lines.front());
  out.push_back(key + ":");
  for (const std::string& line : lines) out.push_back("  " + line);
}

std::vector<std::string> facts_of(const Origin& origin) {
  std::vector<std::string> out;
  for (const auto& [key, value] : origin.provenance) add_fact(out, key, value);
  for (const auto& [sequence, files] : origin.inputs) {
    std::string text;
    for (const InputFile& file : files) {
      text += file.path + " " + std::to_string(file.bytes) + " bytes " + file.hash + "\n";
    }
    add_fact(out, "read for " + sequence, text);
  }
  for (const auto& [key, value] : origin.run) {
    if (key != "exported") add_fact(out, key, value);
  }
  return out;
}

OriginJson json_of(const Origin& origin) {
  OriginJson inputs = OriginJson::object();
  for (const auto& [sequence, files] : origin.inputs) {
    OriginJson list = OriginJson::array();
    for (const InputFile& file : files) {
      list.push_back({{"path", file.path}, {"bytes", file.bytes}, {"murmur3_x64_128", file.hash}});
    }
    inputs[sequence] = std::move(list);
  }
  std::map<std::string, std::string> run = origin.run;
  run.erase("exported");
  return {{"run", run}, {"provenance", origin.provenance}, {"inputs", std::move(inputs)}};
}

std::string dumped(const OriginJson& value) {
  return value.dump(2, ' ', false, OriginJson::error_handler_t::replace);
}

}  // namespace

Origin read_origin(const std::filesystem::path& store) {
  return {read_run(store), read_provenance(store), read_inputs(store)};
}

std::string json(const Origin& origin) { return dumped(json_of(origin)) + "\n"; }

std::string with_origin(const Origin& origin, const std::string& key, const std::string& value) {
  std::string body = value;
  while (body.ends_with('\n')) body.pop_back();
  return "{\n\"provenance\": " + dumped(json_of(origin)) + ",\n" + dumped(key) + ": " + body +
         "\n}\n";
}

std::string origin_lines(const Origin& origin, const std::string& mark) {
  std::string out;
  for (std::string line : facts_of(origin)) {
    for (char& c : line) {
      if (static_cast<unsigned char>(c) < 0x20) c = ' ';
    }
    out += mark + line + "\n";
  }
  return out;
}

std::string origin_comment(const Origin& origin) {
  std::string text = origin_lines(origin, "");
  for (std::size_t at = text.find("--"); at != std::string::npos; at = text.find("--", at)) {
    text.insert(at + 1, " ");
  }
  return "<!-- provenance\n" + text + "-->\n";
}

std::filesystem::path origin_file(const std::filesystem::path& file) {
  std::filesystem::path out = file;
  return out.replace_extension(".provenance.json");
}

}  // namespace loopbench::harness
