#include "metrics/protocols.hpp"

#include <gtest/gtest.h>

#include <set>

#include "support.hpp"

namespace loopbench::test {
namespace {

std::string refusal(const std::string& name, const Params& changes) {
  return why<OptionError>([&] { named_protocol(name, changes); });
}

std::string word(const char* text) { return text; }

TEST(Protocols, AreNamedOnceVersionedAndCoherent) {
  std::set<std::string> names;
  for (const ProtocolEntry& entry : protocols()) {
    EXPECT_TRUE(names.insert(entry.name).second) << entry.name;
    EXPECT_FALSE(entry.version.empty()) << entry.name;
    EXPECT_LT(entry.summary.size(), 90u) << entry.name;
    EXPECT_NO_THROW(check(entry.protocol)) << entry.name;
  }
  for (const char* name : {"loopbench",
                           "evo",
                           "tum",
                           "rpg",
                           "rpg-fixed",
                           "kitti",
                           "kitti-double",
                           "ov_eval",
                           "eth3d"}) {
    EXPECT_EQ(names.count(name), 1u) << name;
  }
}

TEST(Protocols, TheDefaultsAreLoopbench) {
  EXPECT_EQ(echo(named_protocol("loopbench").rules), echo(Protocol{}));
  EXPECT_EQ(echo(NamedProtocol{}.rules), echo(Protocol{}));
  EXPECT_EQ(NamedProtocol{}.name, protocols().front().name);
  EXPECT_EQ(NamedProtocol{}.version, protocols().front().version);
}

TEST(Protocols, ChangesAreToldAndNonChangesAreNot) {
  const NamedProtocol got =
      named_protocol("evo", {{"align", word("se3")}, {"max_diff", 0.01}, {"offset", 1.0}});
  EXPECT_EQ(got.label(), "evo (align=se3, offset=1.0)");
  EXPECT_EQ(got.version, "26d0953");
  EXPECT_EQ(got.rules.association, Association::evo);
  EXPECT_EQ(named_protocol("tum").label(), "tum");
}

TEST(Protocols, AnUnknownNameIsAnsweredWithTheKnownOnes) {
  const std::string got = why<InputError>([] { named_protocol("evoo"); });
  EXPECT_EQ(got.find("no protocol is named 'evoo' (known: loopbench, evo, tum, "), 0u) << got;
}

TEST(Protocols, IncoherentOnesAreRefusedWithTheReason) {
  EXPECT_EQ(refusal("evo", {{"align_first", std::int64_t{100}}}),
            "align_first = 100: only least squares look at several pairs, not origin or none");
  EXPECT_EQ(refusal("loopbench", {{"align_first", std::int64_t{2}}}),
            "align_first = 2: too few for least squares; one pose is align: origin");
  EXPECT_EQ(refusal("kitti", {{"offset", 1.0}}),
            "offset = 1.0: association index does not look at stamps");
  EXPECT_EQ(refusal("tum", {{"pairs_from", word("reference")}}),
            "pairs_from = reference: pairs tum are measured on the estimate");
  EXPECT_EQ(refusal("tum", {{"project", word("xy")}}),
            "project = xy: pairs tum are taken from the files, not flattened");
  EXPECT_EQ(refusal("rpg", {{"segments.precision", word("float32")}}),
            "segments.precision = float32: is the KITTI devkit's: end beyond, form kitti, angle "
            "trace");
  EXPECT_EQ(refusal("kitti", {{"segments.end", word("nearest")}}),
            "segments.tolerance = 0: no end would be near enough");
  EXPECT_EQ(refusal("ov_eval", {{"segments.tolerance", word("8")}}),
            "segments.tolerance = 8: as wide as a length, so a start would end it");
  EXPECT_EQ(refusal("rpg", {{"segments.step", std::int64_t{2}}}),
            "segments.step = 2: end rpg starts at every pose");
  EXPECT_EQ(refusal("evo", {{"segments.lengths", word("ten")}}),
            "segments.lengths: 'ten': expected metres or a share, like 100 or 20%");
  EXPECT_EQ(refusal("evo", {{"ddof", std::int64_t{2}}}), "ddof = 2 breaks 0 <= ddof <= 1");
}

}  // namespace
}  // namespace loopbench::test
