// What the process returns.
#pragma once

namespace wavelobe {

enum ExitCode : int {
    exit_ok = 0,
    exit_failure = 1,        // OpenCL, memory, disk; `doctor`: something is misconfigured
    exit_bad_input = 2,      // arguments, scene files, pictures
    exit_interrupted = 130,  // 128 + SIGINT, as shells report it
};

}  // namespace wavelobe
