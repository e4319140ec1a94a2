// The command line program: options, commands, exit codes.
#pragma once

namespace wavelobe {

// Prints faults as `error: ...` on stderr and returns an ExitCode; lets no exception out.
int run_program(int argc, const char* const* argv);

}  // namespace wavelobe
