/// Options that several commands share, each declared once.
#pragma once

#include <CLI/CLI.hpp>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "harness/answers/report/draw.hpp"
#include "harness/commands/correct/correct.hpp"
#include "harness/commands/files/named_trajectory.hpp"
#include "harness/sweep/config/entry.hpp"

namespace loopbench::harness {

/// Declares how trajectory files are read: all options of ReadArguments but those in `without`.
void declare_reading(CLI::App& command,
                     ReadArguments& reading,
                     const std::vector<std::string>& without = {});

/// The unit in the brackets of a help text, by convention; empty unless there is exactly one.
std::string unit_in(const std::string& help);

/// A field of a protocol with an option of its own, besides --set.
struct FieldOption {
  std::string field;
  std::string names;  ///< of the option: "--max-diff,--t_max_diff"
};

/// Declares an option with the help and the type of its field for each of these. Values are
/// appended to `given`; whoever applies them checks their ranges.
void declare_fields(CLI::App& command,
                    const std::vector<FieldOption>& options,
                    std::vector<GivenSetting>& given);

/// Declares the estimate, --loops and --set of the dataset that reads them.
void declare_problem(CLI::App& command, CorrectArguments& problem);

/// Declares --downsample and --motion_filter.
void declare_pose_filters(CLI::App& command,
                          std::optional<std::size_t>& downsample,
                          std::vector<double>& motion_filter);

/// Declares the options of figures. `needs`: option without which they have no effect; empty: none.
void declare_figures(CLI::App& command, FigureOptions& options, const std::string& needs = "");

/// Draws the positions of `data` and lists the files. `name`: a figure, or .pdf is added.
void draw_map(FigureData data, const std::filesystem::path& name, const FigureOptions& options);

}  // namespace loopbench::harness
