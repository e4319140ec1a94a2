// One function a command: adds it to the command line, and stores in `chosen` what to run when it was given.
#pragma once

#include <functional>

namespace CLI {
class App;
}

namespace wavelobe {

using Chosen = std::function<int()>;  // returns an ExitCode

void add_render_command(CLI::App& program, Chosen& chosen);
void add_info_command(CLI::App& program, Chosen& chosen);
void add_doctor_command(CLI::App& program, Chosen& chosen);
void add_compare_command(CLI::App& program, Chosen& chosen);

}  // namespace wavelobe
