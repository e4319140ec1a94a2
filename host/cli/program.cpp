#include "cli/program.h"

#include <cstdio>
#include <exception>
#include <new>

#include <CLI/App.hpp>
#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>

#include "cl/error.h"
#include "cli/commands.h"
#include "cli/exit_code.h"
#include "scene/fault.h"

namespace wavelobe {
namespace {

// One exit code for every wrong command line, in place of the library's own.
int report_usage(const CLI::App& program, const CLI::ParseError& error) {
    if (error.get_exit_code() == 0) return program.exit(error);  // --help, --version
    std::string command = "wavelobe";
    std::string message = error.what();
    if (program.get_subcommands().empty() && dynamic_cast<const CLI::RequiredError*>(&error) != nullptr) {
        message = "a command is required, one of";
        for (const CLI::App* known : program.get_subcommands(nullptr)) message += " " + known->get_name();
    }
    for (const CLI::App* given : program.get_subcommands()) command += " " + given->get_name();
    std::fprintf(stderr, "error: %s\nSee %s --help\n", message.c_str(), command.c_str());
    return exit_bad_input;
}

int parse_and_run(int argc, const char* const* argv) {
    CLI::App program("Wavelobe, a path tracer whose stages are OpenCL kernels", "wavelobe");
    Chosen chosen;
    add_render_command(program, chosen);
    add_info_command(program, chosen);
    add_doctor_command(program, chosen);
    add_compare_command(program, chosen);
    const char* const version = "wavelobe " WAVELOBE_VERSION;
    program.set_version_flag("--version", version);
    for (CLI::App* command : program.get_subcommands(nullptr)) command->set_version_flag("--version", version);
    program.require_subcommand(1);
    try {
        program.parse(argc, argv);
    } catch (const CLI::ParseError& error) {
        return report_usage(program, error);
    }
    return chosen();
}

}  // namespace

int run_program(int argc, const char* const* argv) {
    try {
        return parse_and_run(argc, argv);
    } catch (const InputError& error) {
        for (const Fault& fault : error.faults()) std::fprintf(stderr, "error: %s\n", fault.text().c_str());
        return exit_bad_input;
    } catch (const ClError& error) {
        std::fprintf(stderr, "error: %s\nTo examine the OpenCL set-up: wavelobe doctor\n", error.what());
        return exit_failure;
    } catch (const std::bad_alloc&) {
        std::fprintf(stderr, "error: out of memory\n");
        return exit_failure;
    } catch (const std::exception& error) {
        std::fprintf(stderr, "error: %s\n", error.what());
        return exit_failure;
    }
}

}  // namespace wavelobe
