/// A library that a plugin brings.
#pragma once

int exit_code_of_success();
