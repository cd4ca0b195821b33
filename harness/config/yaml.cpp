#include "harness/config/yaml.hpp"

#include <yaml-cpp/eventhandler.h>
#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <charconv>
#include <map>
#include <optional>
#include <set>
#include <sstream>

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

/// Builds the tree of the only document, with all aliases expanded.
class TreeBuilder final : public YAML::EventHandler {
 public:
  TreeBuilder(const std::string& text, const std::string& file) : file_(file), root_(file_) {
    std::istringstream in(text);
    for (std::string line; std::getline(in, line);) lines_.push_back(line);
    bytes_ = text.size();
  }

  bool is_empty() const { return documents_ == 0; }
  YamlNode take() { return std::move(root_); }

  void OnDocumentStart(const YAML::Mark&) override {
    if (++documents_ > 1) throw file_.error("has more than one YAML document");
  }
  void OnDocumentEnd() override {}
  void OnNull(const YAML::Mark& mark, YAML::anchor_t anchor) override {
    YamlNode node(at(mark));
    if (!open_.empty() && open_.back().node.type == YamlNode::Type::list) {
      node.line = line_before(mark);
    }
    spend(node, node);
    add(std::move(node), anchor);
  }
  void OnScalar(const YAML::Mark& mark,
                const std::string& tag,
                YAML::anchor_t anchor,
                const std::string& text) override {
    YamlNode node(at(mark), YamlNode::Type::scalar);
    node.scalar = to_param(tag, text);
    node.text = text;
    spend(node, node);
    add(std::move(node), anchor);
  }
  void OnAlias(const YAML::Mark& mark, YAML::anchor_t anchor) override {
    const auto found = anchored_.find(anchor);
    if (found == anchored_.end()) throw at(mark).error("is a recursive alias");
    spend(found->second, at(mark));
    add(found->second, YAML::NullAnchor);
  }
  void OnSequenceStart(const YAML::Mark& mark,
                       const std::string&,
                       YAML::anchor_t anchor,
                       YAML::EmitterStyle::value) override {
    open(YamlNode(at(mark), YamlNode::Type::list), anchor);
  }
  void OnMapStart(const YAML::Mark& mark,
                  const std::string&,
                  YAML::anchor_t anchor,
                  YAML::EmitterStyle::value) override {
    open(YamlNode(at(mark), YamlNode::Type::map), anchor);
  }
  void OnSequenceEnd() override { close(); }
  void OnMapEnd() override { close(); }

 private:
  /// A list or map that has not ended.
  struct Open {
    YamlNode node;
    YAML::anchor_t anchor;
    std::set<std::string> keys;   ///< so far
    std::optional<YamlNode> key;  ///< whose value comes next
  };

  Place at(const YAML::Mark& mark) const {
    Place out = file_;
    out.line = static_cast<std::size_t>(mark.line + 1);
    return out;
  }

  /// The line of an empty item of a list: that of the last text before `mark`, which is the next
  /// token or the end.
  std::size_t line_before(const YAML::Mark& mark) const {
    const bool is_end = static_cast<std::size_t>(mark.pos) >= bytes_;  // its column is 0
    auto number = is_end ? lines_.size() : static_cast<std::size_t>(mark.line) + 1;
    auto columns = is_end ? std::string::npos : static_cast<std::size_t>(mark.column);
    for (; number > 1; --number, columns = std::string::npos) {
      if (number > lines_.size()) continue;
      const std::string text = lines_[number - 1].substr(0, columns);
      const std::size_t begin = text.find_first_not_of(" \t\r");
      if (begin != std::string::npos && text[begin] != '#') break;
    }
    return number;
  }

  void open(YamlNode node, YAML::anchor_t anchor) {
    constexpr std::size_t kMostLevels = 100;
    if (open_.size() == kMostLevels) throw node.error("has too many levels");
    spend(node, node);
    open_.push_back({std::move(node), anchor, {}, {}});
  }

  void close() {
    Open ended = std::move(open_.back());
    open_.pop_back();
    merge_keys(ended.node);
    add(std::move(ended.node), ended.anchor);
  }

  void add(YamlNode node, YAML::anchor_t anchor) {
    node.is_anchored = anchor != YAML::NullAnchor && open_.size() == 1;
    if (anchor != YAML::NullAnchor) {
      spend(node, node);  // of the copy
      anchored_.insert_or_assign(anchor, node).first->second.is_anchored = false;
    }
    if (open_.empty()) {
      root_ = std::move(node);
    } else if (open_.back().node.type == YamlNode::Type::list) {
      open_.back().node.list.push_back(std::move(node));
    } else {
      add_to_map(open_.back(), std::move(node));
    }
  }

  static void add_to_map(Open& parent, YamlNode node) {
    if (!parent.key) {
      if (node.type != YamlNode::Type::scalar) throw node.error("a key must be a string");
      if (!parent.keys.insert(node.text).second) {
        throw node.error("'" + node.text + "' is set twice");
      }
      parent.key = std::move(node);
      return;
    }
    node.line = parent.key->line;
    parent.node.map.push_back({parent.key->text, std::move(node)});
    parent.key.reset();
  }

  /// Limits the size with all aliases expanded: a few lines can expand beyond memory.
  void spend(const YamlNode& node, const Place& place) {
    if (values_left_ == 0) throw place.error("has too many values after expanding aliases");
    if (node.text.size() > bytes_left_) throw place.error("is too long after expanding aliases");
    --values_left_;
    bytes_left_ -= node.text.size();
    for (const YamlNode& item : node.list) spend(item, place);
    for (const YamlEntry& entry : node.map) spend(entry.value, place);
  }

  std::vector<std::string> lines_;
  std::size_t bytes_ = 0;  // of all lines
  Place file_;
  YamlNode root_;
  std::size_t documents_ = 0;
  std::vector<Open> open_;  // from the root to the innermost
  std::map<YAML::anchor_t, YamlNode> anchored_;
  std::size_t values_left_ = 100'000;
  std::size_t bytes_left_ = 10'000'000;  // of text
};

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
    std::istringstream in(text);
    YAML::Parser parser(in);
    TreeBuilder tree(text, file);
    while (parser.HandleNextDocument(tree)) {
    }
    if (tree.is_empty()) throw InputError(file + ": is empty, expected a map of settings");
    return tree.take();
  } catch (const YAML::Exception& error) {
    if (const std::size_t line = line_with_tab(text); line > 0) {
      throw input_error(file, line, "is indented with a tab; YAML accepts only spaces");
    }
    const auto line = error.mark.is_null() ? 0 : static_cast<std::size_t>(error.mark.line + 1);
    throw input_error(file, line, "invalid YAML: " + error.msg);
  }
}

}  // namespace loopbench::harness
