/// Paths in configs: `~`, environment variables and patterns.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "harness/sweep/config/grid.hpp"

namespace loopbench::harness {

using Folders = std::vector<std::filesystem::path>;

/// `text` with `~` at its start and $NAME or ${NAME} replaced. Throws InputError for a variable
/// that is not set.
std::string expanded_path(const std::string& text);

/// The texts that the wildcards (`*`, `?`, `[...]`) of `pattern` stand for in `path`, where `*`
/// does not match `/`; empty if they do not match or `pattern` has no wildcard.
std::vector<std::string> wildcard_texts(const std::string& pattern, const std::string& path);

/// Replaces the wildcards of `pattern` by these texts, in order.
std::string with_wildcard_texts(const std::string& pattern, const std::vector<std::string>& texts);

/// Expands paths among the settings of a dataset: `~` and variables; a pattern becomes one point
/// per file, sorted by name and searched in `folders` if relative. Of several patterns the first is
/// searched; in the others, the wildcards stand for the same texts. `matched` of the points
/// contains these texts. Throws InputError `file:line:` without a matching file, or if the number
/// of wildcards differs.
std::vector<GridPoint> expand_paths(const GridPoint& point,
                                    const std::vector<OptionInfo>& options,
                                    const Folders& folders);

}  // namespace loopbench::harness
