#include "harness/config/read_claim.hpp"

#include <fmt/format.h>

#include <cmath>
#include <limits>

#include "harness/config/values.hpp"

namespace loopbench::harness {
namespace {

ClaimAnswer as_answer(const YamlNode& node, const std::string& key) {
  const auto value = from_text<ClaimAnswer>(as_text(node, key));
  if (!value) throw node.error(key + ": expected " + choice_list<ClaimAnswer>());
  return *value;
}

/// A number that may be infinite or, as null, not a number.
double as_any_number(const YamlNode& node, const std::string& key) {
  if (node.type == YamlNode::Type::null) return std::nan("");
  if (node.text == ".inf") return std::numeric_limits<double>::infinity();
  return as_number(node, key);
}

std::size_t as_size(const YamlNode& node, const std::string& key) {
  const double value = as_number(node, key, Between{0.0, 1e9});
  if (value != std::floor(value)) throw node.error(key + ": expected a whole number");
  return static_cast<std::size_t>(value);
}

std::vector<Look> as_looks(const YamlNode& node, const std::string& name) {
  std::vector<Look> out;
  if (node.type == YamlNode::Type::null) return out;
  if (node.type != YamlNode::Type::list) throw node.error(name + ": expected a list");
  for (const YamlNode& entry : node.list) {
    require_keys(
        entry,
        name,
        {"date", "commit", "level", "answer", "ratio", "low", "high", "mean", "wins", "losses"});
    Look& look = out.emplace_back();
    read_key(entry, "looks.date", look.date, as_text);
    read_key(entry, "looks.commit", look.commit, as_text);
    read_key(entry, "looks.level", look.level, as_any_number);
    read_key(entry, "looks.answer", look.answer, as_answer);
    read_key(entry, "looks.ratio", look.ratio, as_any_number);
    read_key(entry, "looks.low", look.low, as_any_number);
    read_key(entry, "looks.high", look.high, as_any_number);
    read_key(entry, "looks.mean", look.mean, as_any_number);
    read_key(entry, "looks.wins", look.wins, as_size);
    read_key(entry, "looks.losses", look.losses, as_size);
  }
  return out;
}

std::map<std::string, std::string> as_sequences(const YamlNode& node, const std::string& key) {
  std::map<std::string, std::string> out;
  if (node.type == YamlNode::Type::null) return out;
  require_map(node, key, "run: hash");
  for (const YamlEntry& entry : node.map) out[entry.key] = as_text(entry.value, key);
  return out;
}

/// In single quotes, so that no text is a number, a date or an alias.
std::string quoted(const std::string& text) {
  std::string out = "'";
  for (const char c : text) out += c == '\'' ? "''" : std::string(1, c);
  return out + "'";
}

std::string number_text(double value) {
  if (std::isnan(value)) return "null";
  return std::isinf(value) ? ".inf" : fmt::format("{:.6g}", value);
}

std::string line_of(const Look& look) {
  return fmt::format(
      "  - {{date: {}, commit: {}, level: {}, answer: {}, ratio: {}, low: {}, high: {}, mean: {}, "
      "wins: {}, losses: {}}}\n",
      quoted(look.date),
      quoted(look.commit),
      number_text(look.level),
      to_text(look.answer),
      number_text(look.ratio),
      number_text(look.low),
      number_text(look.high),
      number_text(look.mean),
      look.wins,
      look.losses);
}

}  // namespace

Claim parse_claim(const std::string& text, const std::filesystem::path& file) {
  const YamlNode root = parse_yaml(text, file.string());
  require_map(root, "claim", "a map with config, method and baseline");
  const std::vector<std::string> known{"statement",
                                       "config",
                                       "method",
                                       "baseline",
                                       "metric",
                                       "where",
                                       "value",
                                       "over",
                                       "margin",
                                       "alpha",
                                       "expected",
                                       "sequences",
                                       "looks"};
  for (const InputError& error : unknown_keys(root, known)) throw error;
  for (const char* key : {"config", "method", "baseline"}) {
    if (root.find(key) == nullptr) throw root.error("'" + std::string(key) + "' is missing");
  }
  Claim out;
  out.file = file;
  read_key(root, "statement", out.statement, as_text);
  read_key(root, "config", out.config, as_text);
  read_key(root, "method", out.method, as_text);
  read_key(root, "baseline", out.baseline, as_text);
  read_key(root, "metric", out.metric, as_text);
  read_key(root, "where", out.where, as_texts);
  read_key(root, "value", out.value, as_text);
  read_key(root, "over", out.over, as_text);
  const auto number = [&](const char* key, double& value, const Between& range) {
    read_key(root, key, value, [&](const YamlNode& node, const std::string& name) {
      return as_number(node, name, range);
    });
  };
  number("margin", out.margin, Between{-10.0, 0.99});
  number("alpha", out.alpha, Between{1e-6, 0.5});
  read_key(root, "expected", out.expected, as_answer);
  read_key(root, "sequences", out.sequences, as_sequences);
  read_key(root, "looks", out.looks, as_looks);
  if (out.over != "groups" && out.over != "sequences") {
    throw root.find("over")->error("over: expected groups|sequences");
  }
  return out;
}

std::string yaml(const Claim& claim) {
  std::string out;
  const auto add = [&](const char* key, const std::string& value) {
    out += fmt::format("{}: {}\n", key, value);
  };
  add("statement", quoted(claim.statement));
  add("config", quoted(claim.config));
  add("method", quoted(claim.method));
  add("baseline", quoted(claim.baseline));
  add("metric", quoted(claim.metric));
  if (!claim.where.empty()) {
    out += "where:\n";
    for (const std::string& rule : claim.where) out += "  - " + quoted(rule) + "\n";
  }
  add("value", claim.value);
  add("over", claim.over);
  add("margin", fmt::format("{:g}", claim.margin));
  add("alpha", fmt::format("{:g}", claim.alpha));
  add("expected", to_text(claim.expected));
  out += "sequences:\n";
  for (const auto& [run, hash] : claim.sequences) {
    out += fmt::format("  {}: {}\n", quoted(run), quoted(hash));
  }
  out += "looks:\n";
  for (const Look& look : claim.looks) out += line_of(look);
  return out;
}

std::string with_look(const std::string& text,
                      const std::filesystem::path& file,
                      const Look& look) {
  const Claim before = parse_claim(text, file);
  std::string out = text;
  if (!out.empty() && out.back() != '\n') out += '\n';
  const bool has_key = out.starts_with("looks:") || out.find("\nlooks:") != std::string::npos;
  out += (has_key ? "" : "looks:\n") + line_of(look);
  try {
    if (parse_claim(out, file).looks.size() == before.looks.size() + 1) return out;
  } catch (const InputError&) {  // reported below
  }
  throw InputError(file.string() +
                   ": a look cannot be appended; expected looks: to be the last key");
}

}  // namespace loopbench::harness
