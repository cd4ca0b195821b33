/// Commit from which the program was built; defined in a file that the build links only into the
/// executable, so that a commit does not relink anything else.
#pragma once

extern char source_commit[];  ///< 40 hexadecimal digits, or "unknown"
extern char source_state[];   ///< clean | dirty | unknown
