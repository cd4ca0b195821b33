#include "harness/config/yaml.hpp"

#include <yaml-cpp/eventhandler.h>
#include <yaml-cpp/yaml.h>

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

/// Detects a second document. LoadAll cannot be used: yaml-cpp 0.7 returns endless documents after
/// a leading comma.
class Documents final : public YAML::EventHandler {
 public:
  std::size_t count = 0;

  void OnDocumentStart(const YAML::Mark&) override { ++count; }
  void OnDocumentEnd() override {}
  void OnNull(const YAML::Mark&, YAML::anchor_t) override {}
  void OnAlias(const YAML::Mark&, YAML::anchor_t) override {}
  void OnScalar(const YAML::Mark&,
                const std::string&,
                YAML::anchor_t,
                const std::string&) override {}
  void OnSequenceStart(const YAML::Mark&,
                       const std::string&,
                       YAML::anchor_t,
                       YAML::EmitterStyle::value) override {}
  void OnSequenceEnd() override {}
  void OnMapStart(const YAML::Mark&,
                  const std::string&,
                  YAML::anchor_t,
                  YAML::EmitterStyle::value) override {}
  void OnMapEnd() override {}
};

void expect_one_document(const std::string& text, const std::string& file) {
  std::istringstream in(text);
  YAML::Parser parser(in);
  Documents documents;
  while (documents.count < 2 && parser.HandleNextDocument(documents)) {
  }
  if (documents.count == 0) throw InputError(file + ": is empty, expected a map of settings");
  if (documents.count > 1) throw InputError(file + ": has more than one YAML document");
}

}  // namespace

YamlNode parse_yaml(const std::string& text, const std::string& file) {
  constexpr std::size_t kLargest = 1'000'000;
  if (text.size() > kLargest) {
    throw InputError(file + ": has " + std::to_string(text.size()) + " bytes, expected at most " +
                     std::to_string(kLargest));
  }
  expect_utf8(text, file);
  try {
    expect_one_document(text, file);
    Budget budget;
    return convert(YAML::Load(text), file, budget);
  } catch (const YAML::Exception& error) {
    const auto line = error.mark.is_null() ? 0 : static_cast<std::size_t>(error.mark.line + 1);
    throw input_error(file, line, "invalid YAML: " + error.msg);
  }
}

}  // namespace loopbench::harness
