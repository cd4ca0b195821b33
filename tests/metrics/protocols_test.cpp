#include "metrics/protocols/protocols.hpp"

#include <gtest/gtest.h>

#include <set>

#include "support.hpp"

namespace loopbench::test::protocols_test {
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
  for (const char* name :
       {"loopbench", "evo", "tum", "rpg", "rpg-fixed", "kitti", "kitti-double"}) {
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

TEST(Protocols, WhatIsAskedForHasToMatter) {
  EXPECT_EQ(refusal("kitti", {{"max_diff", 0.001}}),
            "max_diff = 0.001: association index does not use it");
  EXPECT_EQ(refusal("loopbench", {{"association", word("interpolate")}, {"max_diff", 0.02}}),
            "max_diff = 0.02: association interpolate does not use it");
  EXPECT_EQ(refusal("evo", {{"max_gap", 0.5}}), "max_gap = 0.5: association evo does not use it");
  EXPECT_NO_THROW(named_protocol("evo", {{"association", word("interpolate")}, {"max_gap", 0.5}}));
}

TEST(Protocols, AnUnknownNameIsAnsweredWithTheKnownOnes) {
  const std::string got = why<InputError>([] { named_protocol("evoo"); });
  EXPECT_EQ(got.find("no protocol is named 'evoo' (known: loopbench, evo, tum, "), 0u) << got;
}

TEST(Protocols, IncoherentOnesAreRefusedWithTheReason) {
  EXPECT_EQ(refusal("evo", {{"align_first", std::int64_t{100}}}),
            "align_first = 100: applies only to least-squares alignments, not to origin or none");
  EXPECT_EQ(refusal("loopbench", {{"align_first", std::int64_t{2}}}),
            "align_first = 2: too few pairs for least squares; for one pose use align: origin");
  EXPECT_EQ(refusal("evo", {{"planar", word("yes")}}),
            "planar = yes: applies only to alignments se3 and sim3");
  EXPECT_EQ(refusal("tum", {{"pairs_from", word("reference")}}),
            "pairs_from = reference: pairs tum always use the estimate");
  EXPECT_EQ(refusal("tum", {{"project", word("xy")}}),
            "project = xy: pairs tum use the unprojected files");
  EXPECT_EQ(refusal("evo", {{"pairs", word("tum_random")}, {"pairs_from", word("reference")}}),
            "pairs_from = reference: pairs tum_random always use the estimate");
  EXPECT_EQ(refusal("evo", {{"max_pairs", std::int64_t{0}}}),
            "max_pairs = 0: applies only to pairs tum and tum_random");
  EXPECT_EQ(refusal("tum", {{"pairs", word("tum_random")}, {"max_pairs", std::int64_t{0}}}),
            "max_pairs = 0: pairs tum_random needs a limit above 0; for all pairs use tum");
  EXPECT_EQ(refusal("rpg", {{"segments.precision", word("float32")}}),
            "segments.precision = float32: requires end beyond, form kitti, angle trace (KITTI "
            "devkit)");
  EXPECT_EQ(refusal("kitti", {{"segments.end", word("nearest")}}),
            "segments.tolerance = 0: expected more than zero");
  EXPECT_EQ(
      refusal("loopbench", {{"segments.lengths", word("8 16")}, {"segments.tolerance", word("8")}}),
      "segments.tolerance = 8: expected less than every length");
  EXPECT_EQ(refusal("rpg", {{"segments.step", std::int64_t{2}}}),
            "segments.step = 2: segments.end = rpg requires step 1");
  EXPECT_EQ(refusal("evo", {{"segments.lengths", word("ten")}}),
            "segments.lengths: 'ten': expected a length in metres or %, as 100 or 20%");
  EXPECT_EQ(refusal("evo", {{"ddof", std::int64_t{2}}}), "ddof = 2: expected 0 <= ddof <= 1");
}

}  // namespace
}  // namespace loopbench::test::protocols_test
