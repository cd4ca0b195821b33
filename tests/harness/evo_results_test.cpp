/// Result files of evo.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "datasets/compressed/zip.hpp"
#include "tests/support/command.hpp"
#include "tests/support/eval_command.hpp"

namespace loopbench::evo_results_test {
namespace {

using namespace test;
using testing::HasSubstr;

TEST(EvoResults, AreWrittenAndRead) {
  const TemporaryFolder folder;
  const std::string file = (folder.path() / "a.zip").string();
  eval({golden("gt.txt"), golden("est_drift.txt"), "--protocol=evo", "-a", "--save_results", file});
  std::map<std::string, std::string> members;
  for (const ZipMember& member : zip_members(read_all(file), 1 << 20)) {
    members[member.name] = member.content;
  }
  const Json info = Json::parse(members["info.json"]);
  EXPECT_EQ(info["title"], "APE w.r.t. translation part (m)\n(with SE(3) Umeyama alignment)");
  EXPECT_NEAR(Json::parse(members["stats.json"])["rmse"], 0.676208260682124, 1e-12);
  EXPECT_THAT(members["error_array.npy"], HasSubstr("'shape': (635,)"));
  EXPECT_EQ((members["error_array.npy"].size() - 635 * sizeof(double)) % 64, 0u);
  EXPECT_THAT(members["alignment_transformation_sim3.npy"], HasSubstr("'shape': (4, 4)"));
  const std::string text = loopbench_command("table a.zip a.zip", folder).out;
  EXPECT_THAT(text, HasSubstr("APE w.r.t. translation part (m) (with SE(3) Umeyama alignment)"));
  EXPECT_THAT(text, HasSubstr("| 0.6762 |"));
  EXPECT_THAT(text, HasSubstr(" 635 |"));
  EXPECT_THROW(
      eval({golden("gt.txt"), golden("est_drift.txt"), "--save_results", file, "-r", "full"}),
      InputError);
}

TEST(EvoResults, OfEvoItself) {
  const char* const data = std::getenv("LOOPBENCH_DATA");
  const std::filesystem::path files =
      std::filesystem::path(data == nullptr ? "" : data) / "systems" / "evo" / "res_files";
  if (!std::filesystem::exists(files)) GTEST_SKIP() << "needs LOOPBENCH_DATA";
  const TemporaryFolder folder;
  const auto output = [&](const std::string& command, const std::vector<const char*>& names) {
    std::string words = command;
    for (const char* name : names) words += " " + (files / name).string();
    const CommandResult result = loopbench_command(words, folder);
    return result.out + result.err;
  };
  const std::string text = output("table", {"orb_ape.zip", "sptam_ape.zip", "orb_rpe.zip"});
  EXPECT_THAT(text, HasSubstr("KITTI_00_ORB   | 1.303 |"));
  EXPECT_THAT(text, HasSubstr("KITTI_00_SPTAM | 3.738 |"));
  EXPECT_THAT(text, HasSubstr(" 4541 |"));
  EXPECT_THAT(text, HasSubstr("RPE w.r.t. translation part (m) for delta = 10.0 (m)"));
  EXPECT_THAT(output("table", {"orb_ape.zip", "orb_rpe-for-each.zip"}),
              HasSubstr("stats.json has no number 'rmse'"));
}

TEST(EvoResults, AreTabulatedAndCompared) {
  const TemporaryFolder folder;
  const auto write = [&](const char* estimate, const char* name) {
    eval({golden("gt.txt"),
          golden(estimate),
          "--protocol=evo",
          "-a",
          "--save_results",
          (folder.path() / name).string()});
  };
  write("est_drift.txt", "a.zip");
  write("est_corrected.txt", "b.zip");
  const CommandResult latex = loopbench_command("table a.zip b.zip --format latex", folder);
  EXPECT_EQ(latex.exit_code, 0) << latex.err;
  EXPECT_THAT(latex.out, HasSubstr("& 0.6762 &"));
  EXPECT_THAT(latex.out, HasSubstr("\\toprule"));
  const CommandResult compared = loopbench_command("compare a.zip b.zip", folder);
  EXPECT_EQ(compared.exit_code, 0) << compared.err;
  EXPECT_THAT(compared.out, HasSubstr("APE w.r.t. translation part (m)"));
  EXPECT_THAT(compared.out, HasSubstr("| est_corrected"));
  EXPECT_THAT(compared.out, HasSubstr("| est_drift"));
  EXPECT_EQ(loopbench_command("table a.zip b.zip --format json", folder).out.front(), '[');
  EXPECT_EQ(loopbench_command("table a.zip --rows method", folder).exit_code, 2);
  EXPECT_EQ(loopbench_command("table a.zip b.zip -o a.zip", folder).exit_code, 2);
  const CommandResult two = loopbench_command("compare one_store another_store", folder);
  EXPECT_EQ(two.exit_code, 2);
  for (const char* files : {"eval a.zip", "eval a.zip b.zip"}) {
    const CommandResult evaluated = loopbench_command(files, folder);
    EXPECT_EQ(evaluated.exit_code, 2);
    EXPECT_THAT(evaluated.err,
                HasSubstr("is a result of evo, expected trajectories; `loopbench table"));
  }
  EXPECT_THAT(two.err, HasSubstr("expected one store"));
  folder.file("c.zip",
              zip_of({{"info.json", "{\"title\": \"APE\"}"}, {"stats.json", "{\"mean\": 1.0}"}}));
  const CommandResult others = loopbench_command("table a.zip c.zip b.zip", folder);
  EXPECT_EQ(others.exit_code, 1);
  EXPECT_EQ(others.err, "loopbench: c.zip: stats.json has no number 'rmse'\n");
  EXPECT_EQ(others.out, loopbench_command("table a.zip b.zip", folder).out);
  EXPECT_EQ(loopbench_command("table c.zip", folder).exit_code, 2);
}

TEST(EvoResults, OfRunsAreNamedByTheirFiles) {
  const TemporaryFolder folder;
  const auto write = [&](const char* source, const std::string& estimate, const char* name) {
    folder.file(estimate, read_all(golden(source)));
    eval({golden("gt.txt"),
          (folder.path() / estimate).string(),
          "--protocol=evo",
          "-a",
          "--save_results",
          (folder.path() / name).string()});
  };
  const auto output = [&](const std::string& words) {
    return loopbench_command(words, folder).out;
  };
  write("est_drift.txt", "est_1.txt", "s.zip");
  write("est_corrected.txt", "est_2.txt", "s1.zip");
  const std::string text = output("table s.zip s1.zip");
  EXPECT_THAT(text, HasSubstr("/ s  | 0.6762 |"));
  EXPECT_THAT(text, HasSubstr("/ s1 | 0.0406 |"));
  const std::string compared = output("compare s.zip s1.zip");
  EXPECT_THAT(compared, HasSubstr("s1 is "));
  EXPECT_THAT(compared, Not(HasSubstr("one method alone")));
  // Beside another method they stay its runs.
  write("est_corrected.txt", "other_1.txt", "t1.zip");
  write("est_corrected.txt", "other_2.txt", "t2.zip");
  const std::string runs = output("table s.zip s1.zip t1.zip t2.zip");
  for (const char* row : {"/ est (s)    |", "/ est (s1)   |", "/ other (t1) |", "/ other (t2) |"}) {
    EXPECT_THAT(runs, HasSubstr(row));
  }
  EXPECT_THAT(output("compare s.zip s1.zip t1.zip t2.zip"), HasSubstr("2 runs of 1 sequence"));
}

}  // namespace
}  // namespace loopbench::evo_results_test
