#include "harness/config/yaml.hpp"

#include <yaml-cpp/eventhandler.h>
#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <charconv>
#include <optional>
#include <set>
#include <sstream>

#include "datasets/core/error.hpp"

namespace loopbench::harness {
namespace {

template <class Number>
std::optional<Number> parse_number(const std::string& text) {
  Number value{};
  const char* begin = text.data() + (text.starts_with('+') ? 1 : 0);
  const char* end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(begin, end, value);
  if (error != std::errc{} || stop != end) return std::nullopt;
  return value;
}

Param to_param(const YAML::Node& node) {
  const std::string& text = node.Scalar();
  if (node.Tag() == "!") return text;  // quoted
  if (text == "true") return true;
  if (text == "false") return false;
  if (const auto integer = parse_number<std::int64_t>(text)) return *integer;
  if (const auto real = parse_number<double>(text)) return *real;
  return text;
}

std::size_t line_of(const YAML::Node& node) {
  return static_cast<std::size_t>(node.Mark().line + 1);
}

/// Limits on expanded aliases: a few lines can expand beyond memory, or contain themselves.
struct Budget {
  std::size_t values = 100'000;
  std::size_t bytes = 10'000'000;  ///< of text
  std::size_t levels = 100;
};

/// Replaces `<<: *base` (or a list of maps) by the entries of these maps that are not set. yaml-cpp
/// leaves merge keys to the caller.
void merge_keys(YamlNode& node, const std::string& file) {
  const auto found = std::ranges::find(node.map, std::string("<<"), &YamlEntry::key);
  if (found == node.map.end()) return;
  const YamlNode merged = std::move(found->value);
  node.map.erase(found);
  const std::vector<YamlNode> bases =
      merged.type == YamlNode::Type::list ? merged.list : std::vector<YamlNode>{merged};
  for (const YamlNode& base : bases) {
    if (base.type != YamlNode::Type::map) {
      throw input_error(file, merged.line, "<<: expected an alias of a map, or a list of them");
    }
    for (const YamlEntry& entry : base.map) {
      if (node.find(entry.key) == nullptr) node.map.push_back(entry);
    }
  }
}

YamlNode convert(const YAML::Node& node, const std::string& file, Budget& left) {
  YamlNode out;
  out.line = line_of(node);
  if (left.values == 0 || left.levels == 0) {
    throw input_error(file, out.line, "has too many values or levels (a recursive alias?)");
  }
  --left.values;
  --left.levels;
  const std::size_t length = node.IsScalar() ? node.Scalar().size() : 0;
  if (length > left.bytes) throw input_error(file, out.line, "is too long after expanding aliases");
  left.bytes -= length;
  std::set<std::string> keys;
  switch (node.Type()) {
    case YAML::NodeType::Scalar:
      out.type = YamlNode::Type::scalar;
      out.scalar = to_param(node);
      out.text = node.Scalar();
      break;
    case YAML::NodeType::Sequence:
      out.type = YamlNode::Type::list;
      for (const YAML::Node& item : node) out.list.push_back(convert(item, file, left));
      break;
    case YAML::NodeType::Map:
      out.type = YamlNode::Type::map;
      for (const auto& item : node) {
        if (!item.first.IsScalar()) {
          throw input_error(file, line_of(item.first), "a key must be a string");
        }
        const std::string& key = item.first.Scalar();
        // yaml-cpp keeps both and returns the first, so the second would be lost silently.
        if (!keys.insert(key).second) {
          throw input_error(file, line_of(item.first), "'" + key + "' is set twice");
        }
        out.map.push_back({key, convert(item.second, file, left)});
        out.map.back().value.line = line_of(item.first);
      }
      merge_keys(out, file);
      break;
    case YAML::NodeType::Null:
    case YAML::NodeType::Undefined:
      break;
  }
  ++left.levels;
  return out;
}

/// Rejects bytes that are not UTF-8: yaml-cpp 0.7 does not terminate for some of them.
void expect_utf8(const std::string& text, const std::string& file) {
  std::size_t line = 1;
  int more = 0;  // continuation bytes that the current character still needs
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    const bool is_continuation = (byte & 0xC0U) == 0x80U;
    const bool is_start = byte < 0x80U || (byte >= 0xC2U && byte < 0xF5U);
    if (more > 0 ? !is_continuation : !is_start) {
      throw input_error(file, line, "is not UTF-8 text, expected YAML");
    }
    if (more > 0) {
      --more;
    } else if (byte >= 0xC2U) {
      more = byte < 0xE0U ? 1 : (byte < 0xF0U ? 2 : 3);
    }
    line += c == '\n' ? 1 : 0;
  }
  if (more > 0) throw input_error(file, line, "is not UTF-8 text, expected YAML");
}

/// Counts the documents and collects the keys of the first map whose values have an anchor. LoadAll
/// cannot be used: yaml-cpp 0.7 returns endless documents after a leading comma.
class Documents final : public YAML::EventHandler {
 public:
  std::size_t count = 0;
  std::set<std::string> anchored;

  void OnDocumentStart(const YAML::Mark&) override { ++count; }
  void OnDocumentEnd() override {}
  void OnNull(const YAML::Mark&, YAML::anchor_t anchor) override { scalar("", anchor); }
  void OnAlias(const YAML::Mark&, YAML::anchor_t) override { scalar("", YAML::NullAnchor); }
  void OnScalar(const YAML::Mark&,
                const std::string&,
                YAML::anchor_t anchor,
                const std::string& text) override {
    scalar(text, anchor);
  }
  void OnSequenceStart(const YAML::Mark&,
                       const std::string&,
                       YAML::anchor_t anchor,
                       YAML::EmitterStyle::value) override {
    begin(anchor);
  }
  void OnSequenceEnd() override { end(); }
  void OnMapStart(const YAML::Mark&,
                  const std::string&,
                  YAML::anchor_t anchor,
                  YAML::EmitterStyle::value) override {
    begin(anchor);
  }
  void OnMapEnd() override { end(); }

 private:
  void note(YAML::anchor_t anchor) {
    if (levels_ == 1 && has_key_ && anchor != YAML::NullAnchor) anchored.insert(key_);
  }
  void scalar(const std::string& text, YAML::anchor_t anchor) {
    note(anchor);
    if (levels_ != 1) return;
    if (!has_key_) key_ = text;
    has_key_ = !has_key_;
  }
  void begin(YAML::anchor_t anchor) {
    note(anchor);
    ++levels_;
  }
  void end() {
    --levels_;
    if (levels_ == 1) has_key_ = false;
  }

  std::size_t levels_ = 0;
  bool has_key_ = false;  // the next event is the value of `key_`
  std::string key_;
};

/// Returns the keys at top level whose values have an anchor.
std::set<std::string> expect_one_document(const std::string& text, const std::string& file) {
  std::istringstream in(text);
  YAML::Parser parser(in);
  Documents documents;
  while (documents.count < 2 && parser.HandleNextDocument(documents)) {
  }
  if (documents.count == 0) throw InputError(file + ": is empty, expected a map of settings");
  if (documents.count > 1) throw InputError(file + ": has more than one YAML document");
  return documents.anchored;
}

/// The first line that is indented with a tab; 0: none.
std::size_t line_with_tab(const std::string& text) {
  std::istringstream in(text);
  std::size_t number = 0;
  for (std::string line; std::getline(in, line);) {
    ++number;
    const std::size_t begin = line.find_first_not_of(" \t");
    if (begin != std::string::npos && line.substr(0, begin).find('\t') != std::string::npos) {
      return number;
    }
  }
  return 0;
}

}  // namespace

YamlNode scalar_node(const std::string& text) {
  YamlNode out;
  out.type = YamlNode::Type::scalar;
  out.scalar = text;
  out.text = text;
  return out;
}

YamlNode parse_yaml(const std::string& text, const std::string& file) {
  constexpr std::size_t kLargest = 1'000'000;
  if (text.size() > kLargest) {
    throw InputError(file + ": has " + std::to_string(text.size()) + " bytes, expected at most " +
                     std::to_string(kLargest));
  }
  expect_utf8(text, file);
  try {
    const std::set<std::string> anchored = expect_one_document(text, file);
    Budget budget;
    YamlNode out = convert(YAML::Load(text), file, budget);
    for (YamlEntry& entry : out.map) entry.value.is_anchored = anchored.contains(entry.key);
    return out;
  } catch (const YAML::Exception& error) {
    if (const std::size_t line = line_with_tab(text); line > 0) {
      throw input_error(file, line, "is indented with a tab; YAML accepts only spaces");
    }
    const auto line = error.mark.is_null() ? 0 : static_cast<std::size_t>(error.mark.line + 1);
    throw input_error(file, line, "invalid YAML: " + error.msg);
  }
}

}  // namespace loopbench::harness
