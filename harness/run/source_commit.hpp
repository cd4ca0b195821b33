/// Source of the program; defined in files that the build links only into the executable, so that a
/// commit does not relink anything else.
#pragma once

extern char source_commit[];  ///< 40 hexadecimal digits, or "unknown"
extern char source_state[];   ///< clean | dirty | unknown
extern char code_hash[];      ///< of the libraries whose code decides the results of cells
