#include <cstdio>
#include <memory>

#include <CLI/App.hpp>

#include "cli/commands.h"
#include "cli/exit_code.h"
#include "cli/health.h"

namespace wavelobe {
namespace {

// Prints at once, so that what was examined last is seen even if the driver ends the process.
bool print(const Finding& finding) {
    std::printf("%-14s %s\n", finding.subject.c_str(), finding.state.c_str());
    if (!finding.remedy.empty()) std::printf("%-14s -> bad; remedy: %s\n", "", finding.remedy.c_str());
    std::fflush(stdout);
    return finding.remedy.empty();
}

int run(const std::string& device_name) {
    print({"wavelobe", WAVELOBE_VERSION, ""});
    const Machine machine = this_machine();
    // Before the device is opened: PoCL gives none when it cannot create its cache.
    bool healthy = print(examine_cache(kernel_cache_folder(), process_environment));
    std::unique_ptr<const Device> device;
    try {
        device = std::make_unique<const Device>(DeviceOptions{0, device_name});
    } catch (const ClError& error) {
        print({"device", error.what(),
               healthy ? "apt-get install pocl-opencl-icd, or name one of the devices listed" : "mend the kernel cache first"});
        return exit_failure;
    }
    const DeviceInfo& info = device->info();
    print({"device", info.name, ""});
    print({"platform", info.platform, ""});
    print({"driver", info.driver, ""});
    healthy &= print(examine_threads(info, machine, process_environment));
    healthy &= print(examine_simd(info, process_environment));
    healthy &= print(examine_vectorisation(process_environment));
    healthy &= print(examine_memory(info, machine, process_environment));
    healthy &= print(examine_compiler(*device));
    std::printf("%s\n", healthy ? "all is well" : "see the remedies above");
    return healthy ? exit_ok : exit_failure;
}

}  // namespace

void add_doctor_command(CLI::App& program, Chosen& chosen) {
    CLI::App* command = program.add_subcommand("doctor", "Examine the OpenCL set-up; bad findings come with a remedy");
    auto device_name = std::make_shared<std::string>();
    command->add_option("--device", *device_name, "Part of the name of the OpenCL device or platform")->type_name("TEXT");
    command->callback([device_name, &chosen] { chosen = [device_name] { return run(*device_name); }; });
}

}  // namespace wavelobe
