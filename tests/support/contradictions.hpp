/// Contradictions between the numbers of `compare --format json` and its sentence.
#pragma once

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <regex>
#include <string>
#include <vector>

namespace loopbench {

/// What the texts and numbers of one comparison (of a score of which lower values are better)
/// contradict; empty for none. Reads only the JSON.
inline std::vector<std::string> contradictions(const nlohmann::json& c) {
  std::vector<std::string> out;
  const std::string text = c.at("verdict");
  const double relevant = c.at("relevant");
  const auto say = [&](const std::string& what) { out.push_back(what + ": " + text); };
  const auto is_said = [&](const std::string& part) {
    return text.find(part) != std::string::npos;
  };
  if (is_said("inf") || is_said("nan")) say("no number");
  const auto& methods = c.at("methods");
  const auto find = [&](const std::string& name) -> const nlohmann::json* {
    for (const auto& m : methods) {
      if (m.at("method") == name) return &m;
    }
    return nullptr;
  };
  const nlohmann::json* const baseline = find(c.at("baseline"));
  if (baseline == nullptr) return out;
  const bool is_decidable = !is_said("cannot decide") && !is_said("a test needs");
  // One that fails on a run, or covers less, is not shown to be better.
  const auto is_clean = [](const nlohmann::json& m) {
    return m.at("fails") == 0 && m.at("coverage") == 1.0;
  };
  std::size_t first = 0;
  for (const auto& m : methods) {
    const std::string name = m.at("method");
    first += m.at("place") == "=" ? 1 : 0;
    if (&m == baseline || name == c.at("baseline")) continue;
    if (m.at("interval").is_null()) continue;
    const double low = m.at("interval")[0];
    const double high = m.at("interval")[1];
    const double ratio = m.at("ratio");
    if (low > ratio * (1.0 + 1e-9) || high < ratio * (1.0 - 1e-9)) say(name + " is outside");
    const bool is_excluded = low > 1.0 || high < 1.0;
    if (!m.at("p").is_null() && is_excluded != (m.at("p") <= c.at("alpha")))
      say(name + ": p and interval differ");
    if (!is_decidable) continue;
    if (m.at("place") == "=" && low > 1.0 + relevant && is_clean(*baseline))
      say(name + " is = but shown to be worse than the baseline");
    if (baseline->at("place") == "=" && high < 1.0 / (1.0 + relevant) && is_clean(m))
      say("the baseline is = but shown to be worse than " + name);
  }
  if (first == 0) say("no first place");
  std::smatch found;
  const bool is_none = is_said("no method is best") || is_said("nothing is decided") ||
                       is_said("no method beats") || !is_decidable;
  const std::regex kBest(R"(: (?:the baseline )?(\S+) is best(?:[,:]|$))");
  if (!is_none && std::regex_search(text, found, kBest)) {
    const nlohmann::json* const best = find(found[1]);
    if (best == nullptr || best->at("place") != "=" || first != 1) {
      say("best and places differ");
    } else if (best != baseline) {
      const auto& interval = best->at("interval");
      if (!interval.is_null() && interval[1] >= 1.0) say("best, but not below the baseline");
    }
  }
  const std::regex kBelow(R"(no method is best: (\S+) is [\d.e-]+ % below)");
  if (std::regex_search(text, found, kBelow)) {
    const nlohmann::json* const m = find(found[1]);
    // An interval can have an end beyond all numbers; p is that of the same test.
    const bool has_interval = m != nullptr && !m->at("interval").is_null();
    if (m == nullptr || m->at("p").is_null() || m->at("p") > c.at("alpha") ||
        (has_interval && m->at("interval")[1] >= 1.0))
      say("below, but not shown");
  }
  if (is_said("nothing is decided") && first != methods.size()) say("some method is worse");
  const std::regex kFew(R"((\d+) (?:run|sequence|group).* cannot decide .* methods: (\d+) would)");
  if (std::regex_search(text, found, kFew) && !is_said("two methods solved") &&
      std::stoi(found[1]) >= std::stoi(found[2]))
    say("so many would do");
  return out;
}

}  // namespace loopbench
