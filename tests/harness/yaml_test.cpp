#include "harness/sweep/config/yaml.hpp"

#include <gtest/gtest.h>

#include "tests/support/refusal_of.hpp"

namespace loopbench::yaml_test {

using namespace harness;

namespace {

std::string why(const std::string& text) {
  return refusal_of([&] { parse_yaml(text, "c.yaml"); });
}

TEST(Yaml, KeepsTypesAndLines) {
  const YamlNode root = parse_yaml("a: 1\nb: 2.5\nc: true\nd: word\ne: '7'\nf: 1e-3\ng: +4\n", "c");
  EXPECT_EQ(root.find("a")->scalar, Param(std::int64_t{1}));
  EXPECT_EQ(root.find("b")->scalar, Param(2.5));
  EXPECT_EQ(root.find("c")->scalar, Param(true));
  EXPECT_EQ(root.find("d")->scalar, Param(std::string("word")));
  EXPECT_EQ(root.find("e")->scalar, Param(std::string("7")));
  EXPECT_EQ(root.find("f")->scalar, Param(1e-3));
  EXPECT_EQ(root.find("g")->scalar, Param(std::int64_t{4}));
  EXPECT_EQ(root.find("d")->line, 4u);
  EXPECT_EQ(root.find("z"), nullptr);
}

TEST(Yaml, KeepsTheLinesOfEmptyItems) {
  const YamlNode root = parse_yaml("a:\n  - x\n  -\n\n  # c\n  - y\n  - # d\nb:\n  - ~\n  -", "c");
  EXPECT_EQ(root.find("a")->list.at(1).line, 3u);
  EXPECT_EQ(root.find("a")->list.at(3).line, 7u);
  EXPECT_EQ(root.find("b")->list.at(0).line, 9u);
  EXPECT_EQ(root.find("b")->list.at(1).line, 10u);
}

TEST(Yaml, RefusesWhatWouldBeLostSilently) {
  EXPECT_EQ(why("a: 1\nb: 2\na: 3\n"), "c.yaml:3: 'a' is set twice");
  EXPECT_EQ(why(""), "c.yaml: is empty, expected a map of settings");
  EXPECT_EQ(why("a: 1\n---\nb: 2\n"), "c.yaml: has more than one YAML document");
  EXPECT_EQ(why("a: 1\n[x]: 2\n"), "c.yaml:2: a key must be a string");
}

TEST(Yaml, RefusesAliasesThatNeverEnd) {
  EXPECT_EQ(why("a: 1\nb: &b [*b]\n"), "c.yaml:2: is a recursive alias");
  EXPECT_EQ(why(std::string(200, '[') + std::string(200, ']')), "c.yaml:1: has too many levels");
  std::string laughs = "a: &a [x, x, x, x, x, x, x, x, x, x]\n";
  for (char c = 'b'; c < 'i'; ++c) {
    const std::string alias = std::string(", *") + static_cast<char>(c - 1);
    std::string list;
    for (int i = 0; i < 10; ++i) list += alias;
    laughs += std::string{c} + ": &" + c + " [" + list.substr(2) + "]\n";
  }
  EXPECT_NE(why(laughs).find(": has too many values after expanding aliases"), std::string::npos);
}

TEST(Yaml, RefusesWhatIsFarTooLong) {
  EXPECT_EQ(why("a: " + std::string(1'000'000, 'x')),
            "c.yaml: has 1000003 bytes, expected at most 1000000");
  std::string copies = "a: &a " + std::string(100'000, 'x') + "\nb: [*a";
  for (int i = 0; i < 100; ++i) copies += ", *a";
  EXPECT_EQ(why(copies + "]\n"), "c.yaml:2: is too long after expanding aliases");
}

TEST(Yaml, TellsTheLineOfBrokenSyntax) {
  const std::string text = why("a: 1\nb: [1, 2\nc: 3\n");
  EXPECT_TRUE(text.starts_with("c.yaml:3: invalid YAML")) << text;
}

}  // namespace
}  // namespace loopbench::yaml_test
