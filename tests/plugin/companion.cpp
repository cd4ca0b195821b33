#include "companion.hpp"

int exit_code_of_success() { return 0; }
