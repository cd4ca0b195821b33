/// Detection of trajectory formats.
#pragma once

#include <optional>
#include <string>

#include "datasets/columns/text_file.hpp"
#include "datasets/core/fields.hpp"
#include "datasets/formats/formats.hpp"

namespace loopbench {

struct FormatEntry;

/// Guesses the format of a line of data: of the entries of formats(), the first that fits.
std::optional<Format> guess(const TextFile& file, const Line& line);

/// Detects the format of a text file from the first line of data, without consuming it. Throws
/// InputError with the line and the known formats if none matches.
Format detect_format(TextFile& file);

/// The format of a file that is not text; null: none is detected. Throws InputError.
const FormatEntry* detect_file(const std::filesystem::path& file);

/// Error "has 7 columns, expected `expected`", with a hint if the line is truncated or looks like
/// another format than `reading`.
InputError wrong_columns(const TextFile& file,
                         const Line& line,
                         Format reading,
                         const std::string& expected);

}  // namespace loopbench
