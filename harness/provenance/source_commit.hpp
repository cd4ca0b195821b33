/// Which commit the program was built from; defined by a file that the build writes into the
/// executable alone, so that a commit links nothing else again.
#pragma once

extern char source_commit[];  ///< 40 hexadecimal digits, or "unknown"
extern char source_state[];   ///< clean | dirty | unknown
