#include "harness/sweep/config/yaml.hpp"

#include <yaml-cpp/depthguard.h>
#include <yaml-cpp/eventhandler.h>
#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <charconv>
#include <optional>
#include <set>
#include <sstream>
#include <string_view>

#include "harness/sweep/text/printable.hpp"

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

Param to_param(const std::string& tag, const std::string& text) {
  if (tag == "!") return text;  // quoted
  if (text == "true") return true;
  if (text == "false") return false;
  if (const auto integer = parse_number<std::int64_t>(text)) return *integer;
  if (const auto real = parse_number<double>(text)) return *real;
  return text;
}

/// Replaces `<<: *base` (or a list of maps) by the entries of these maps that are not set. yaml-cpp
/// leaves merge keys to the caller.
void merge_keys(YamlNode& node) {
  const auto found = std::ranges::find(node.map, std::string("<<"), &YamlEntry::key);
  if (found == node.map.end()) return;
  const YamlNode merged = std::move(found->value);
  node.map.erase(found);
  const std::vector<YamlNode> bases =
      merged.type == YamlNode::Type::list ? merged.list : std::vector<YamlNode>{merged};
  for (const YamlNode& base : bases) {
    if (base.type != YamlNode::Type::map) {
      throw merged.error("<<: expected an alias of a map, or a list of them");
    }
    for (const YamlEntry& entry : base.map) {
      if (node.find(entry.key) == nullptr) node.map.push_back(entry);
    }
  }
}

/// To read past a document. YAML::LoadAll does not terminate for some texts.
struct IgnoredDocument final : YAML::EventHandler {
  using Mark = YAML::Mark;
  using Anchor = YAML::anchor_t;
  using Style = YAML::EmitterStyle::value;
  void OnDocumentStart(const Mark&) override {}
  void OnDocumentEnd() override {}
  void OnNull(const Mark&, Anchor) override {}
  void OnAlias(const Mark&, Anchor) override {}
  void OnScalar(const Mark&, const std::string&, Anchor, const std::string&) override {}
  void OnSequenceStart(const Mark&, const std::string&, Anchor, Style) override {}
  void OnSequenceEnd() override {}
  void OnMapStart(const Mark&, const std::string&, Anchor, Style) override {}
  void OnMapEnd() override {}
};

/// Copies the tree of a document, with all aliases expanded.
class TreeCopy {
 public:
  TreeCopy(const std::string& text, const std::string& file) : text_(text), file_(file) {}

  YamlNode copy(const YAML::Node& node) { return copy(node, place(node.Mark())); }

 private:
  /// `parent` is where too large expansions are reported.
  YamlNode copy(const YAML::Node& node, const Place& parent) {
    constexpr std::size_t kMostLevels = 100;
    YamlNode out(place(node.Mark()));
    if (std::ranges::any_of(open_, [&](const YAML::Node& each) { return each.is(node); })) {
      throw out.error("is a recursive alias");
    }
    if (node.IsScalar()) {
      out.type = YamlNode::Type::scalar;
      out.text = node.Scalar();
      out.scalar = to_param(node.Tag(), out.text);
    }
    spend(out.text.size(), parent);
    if (!node.IsSequence() && !node.IsMap()) return out;
    if (open_.size() == kMostLevels) throw out.error("has too many levels");
    open_.push_back(node);
    out.type = node.IsMap() ? YamlNode::Type::map : YamlNode::Type::list;
    std::set<std::string> keys;
    for (const auto& item : node) {
      if (node.IsMap()) {
        const YamlNode key = copy(item.first, out);
        if (key.type != YamlNode::Type::scalar) throw key.error("a key must be a string");
        if (!keys.insert(key.text).second) throw key.error("'" + key.text + "' is set twice");
        YamlNode value = copy(item.second, out);
        value.line = key.line;
        value.is_anchored = open_.size() == 1 && has_anchor(item.first, item.second);
        out.map.push_back({key.text, std::move(value)});
      } else {
        out.list.push_back(copy(item, out));
        if (item.IsNull()) out.list.back().line = line_before(item.Mark());
      }
    }
    open_.pop_back();
    merge_keys(out);
    return out;
  }

  /// Whether the value is not an alias, whose mark is that of its anchor, and has an anchor.
  bool has_anchor(const YAML::Node& key, const YAML::Node& value) const {
    const auto begin = static_cast<std::size_t>(value.Mark().pos);
    return value.Mark().pos > key.Mark().pos && begin < text_.size() && text_[begin] == '&';
  }

  Place place(const YAML::Mark& mark) const {
    Place out = file_;
    out.line = static_cast<std::size_t>(mark.line + 1);
    return out;
  }

  /// The line of an empty item of a list, whose mark is the next token or the end: that of the last
  /// text before it.
  std::size_t line_before(const YAML::Mark& mark) const {
    auto end = std::min(static_cast<std::size_t>(mark.pos), text_.size());
    const bool is_end = end == text_.size();  // its line is not that of the text
    auto number = 1 + (is_end ? std::ranges::count(text_, '\n') : mark.line);
    for (; number > 1; --number) {
      const std::size_t newline = text_.rfind('\n', end - 1);
      const std::size_t begin = text_.find_first_not_of(" \t\r", newline + 1);
      if (begin < end && text_[begin] != '#') break;
      end = newline;
    }
    return static_cast<std::size_t>(number);
  }

  /// Limits the size with all aliases expanded: a few lines can expand beyond memory.
  void spend(std::size_t bytes, const Place& parent) {
    if (values_left_ == 0) throw parent.error("has too many values after expanding aliases");
    if (bytes > bytes_left_) throw parent.error("is too long after expanding aliases");
    --values_left_;
    bytes_left_ -= bytes;
  }

  const std::string& text_;
  Place file_;
  std::vector<YAML::Node> open_;  // from the root to the innermost
  std::size_t values_left_ = 100'000;
  std::size_t bytes_left_ = 10'000'000;  // of text
};

/// Rejects bytes that are not UTF-8: yaml-cpp 0.7 does not terminate for some of them.
void expect_utf8(const std::string& text, const std::string& file) {
  for (std::string_view rest = text; !rest.empty();) {
    const std::size_t size = code_point_bytes(rest);
    if (size == 0) {
      const auto line = std::count(text.begin(), text.end() - std::ssize(rest), '\n') + 1;
      throw input_error(file, static_cast<std::size_t>(line), "is not UTF-8 text, expected YAML");
    }
    rest.remove_prefix(size);
  }
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

YamlNode parse_yaml(const std::string& text, const std::string& file) {
  constexpr std::size_t kLargest = 1'000'000;
  if (text.size() > kLargest) {
    throw InputError(file + ": has " + std::to_string(text.size()) + " bytes, expected at most " +
                     std::to_string(kLargest));
  }
  expect_utf8(text, file);
  try {
    const YAML::Node root = YAML::Load(text);
    if (root.Mark().is_null()) throw InputError(file + ": is empty, expected a map of settings");
    std::istringstream in(text);
    YAML::Parser parser(in);
    IgnoredDocument first;
    parser.HandleNextDocument(first);
    if (parser.HandleNextDocument(first)) {
      throw InputError(file + ": has more than one YAML document");
    }
    return TreeCopy(text, file).copy(root);
  } catch (const YAML::DeepRecursion& error) {
    throw input_error(file, static_cast<std::size_t>(error.mark.line + 1), "has too many levels");
  } catch (const YAML::Exception& error) {
    if (const std::size_t line = line_with_tab(text); line > 0) {
      throw input_error(file, line, "is indented with a tab; YAML accepts only spaces");
    }
    const auto line = error.mark.is_null() ? 0 : static_cast<std::size_t>(error.mark.line + 1);
    throw input_error(file, line, "invalid YAML: " + error.msg);
  }
}

}  // namespace loopbench::harness
