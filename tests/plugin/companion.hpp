/// A shared library that a plugin depends on.
#pragma once

int exit_code_of_success();
