/// The page for users of evo: it names every option of evo, and its commands work.
#include <gtest/gtest.h>

#include <regex>

#include "datasets/formats/formats.hpp"
#include "tests/support/bag_writer.hpp"
#include "tests/support/command.hpp"

namespace loopbench::evo_migration_test {
namespace {

namespace fs = std::filesystem;

const std::string kPage = read_all(LOOPBENCH_CONFIGS "/../metrics/evo.md");

/// All texts in backticks.
std::vector<std::string> quoted_words(const std::string& text) {
  const std::regex quoted("`([^`]*)`");
  std::vector<std::string> out;
  for (std::sregex_iterator it(text.begin(), text.end(), quoted), end; it != end; ++it) {
    out.push_back((*it)[1]);
  }
  return out;
}

TEST(EvoMigration, NamesEveryOptionOfEvo) {
  // Of evo 1.36.5: `evo_ape tum --help` and so on.
  const std::string options =
      "-r --pose_relation -s --correct_scale --n_to_align --change_unit --project_to_plane "
      "--downsample --motion_filter -a --align --align_origin -p --plot --plot_mode "
      "--plot_x_dimension --plot_colormap_max --plot_colormap_min --plot_colormap_max_percentile "
      "--plot_full_ref --ros_map_yaml --map_tile --save_plot --rerun --rerun_rec_id "
      "--save_results --logfile --no_warnings -v --verbose --silent --debug -c --config "
      "--t_max_diff --t_offset --t_start --t_end -d --delta -t --delta_tol -u --delta_unit "
      "--all_pairs --pairs_from_reference -f --full_check --sync --transform_left "
      "--transform_right --propagate_transform --invert_transform --ref --merge "
      "--plot_relative_time --save_table --save_as_tum --save_as_kitti --save_as_bag "
      "--save_as_bag2 --show_full_names --all_topics --all_channels --use_rel_time "
      "--use_filenames --ignore_title --plot_markers --brief --no_color --diff -m --soft -o --out "
      "-y --title --serialize_plot --to_html --version --license --info --location --pyversion "
      "--open_log --clear_log";
  const std::vector<std::string> named = quoted_words(kPage);
  std::istringstream words(options);
  for (std::string word; words >> word;) {
    EXPECT_GT(std::ranges::count(named, word), 0) << word << " has no line";
  }
}

/// An MCAP with the poses of a file on the topic /pose.
std::string mcap_of(const fs::path& file) {
  std::vector<std::string> messages;
  for (const auto& [stamp, pose] : read_trajectory(file)) {
    messages.push_back(test::cdr_pose_stamped(std::llround(1e9 * stamp), pose));
  }
  return test::mcap(messages);
}

TEST(EvoMigration, EveryCommandWorks) {
  const TemporaryFolder folder;
  const fs::path golden = fs::path(LOOPBENCH_TEST_DATA) / "golden";
  for (const auto& [from, to] : {std::pair{"gt.txt", "gt.txt"},
                                 {"est_drift.txt", "a.txt"},
                                 {"est_corrected.txt", "b.txt"},
                                 {"kitti_gt.txt", "gt.kitti"},
                                 {"kitti_est.txt", "a.kitti"}}) {
    fs::copy_file(golden / from, folder.path() / to);
  }
  std::ofstream(folder.path() / "run.mcap") << mcap_of(folder.path() / "a.txt");
  const char* const data = std::getenv("LOOPBENCH_DATA");
  const fs::path tf = fs::path(data == nullptr ? "" : data) / "bags" / "tf_example.bag";
  if (data != nullptr && fs::exists(tf)) fs::copy_file(tf, folder.path() / "tf.bag");
  std::size_t commands = 0;
  for (const std::string& text : quoted_words(kPage)) {
    if (!text.starts_with("loopbench ")) continue;
    const bool draws = text.find("plot") != text.npos || text.find("--report") != text.npos;
    if (draws && !has_matplotlib()) continue;
    if (text.find("tf.bag") != text.npos && !fs::exists(folder.path() / "tf.bag")) continue;
    const CommandResult result = loopbench_command(text.substr(text.find(' ') + 1), folder);
    EXPECT_EQ(result.exit_code, 0) << text << "\n" << result.out << result.err;
    ++commands;
  }
  EXPECT_GT(commands, 40u);
}

}  // namespace
}  // namespace loopbench::evo_migration_test
