#include "cli/health.h"

#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <thread>

#include <fmt/format.h>

#include "cl/program.h"
#include "cli/format.h"

namespace wavelobe {
namespace {

namespace fs = std::filesystem;

// The first of these variables that is set, as `NAME=value`; empty when none is.
std::string first_set(Environment environment, std::initializer_list<const char*> names) {
    for (const char* name : names) {
        if (const std::string value = environment(name); !value.empty()) return fmt::format("{}={}", name, value);
    }
    return {};
}

std::string unset(const std::string& assignment) { return "unset " + assignment.substr(0, assignment.find('=')); }

std::uint64_t folder_bytes(const fs::path& folder) {
    std::uint64_t sum = 0;
    std::error_code error;
    const auto options = fs::directory_options::skip_permission_denied;
    for (fs::recursive_directory_iterator it(folder, options, error), end; !error && it != end; it.increment(error)) {
        std::error_code ignored;  // files come and go while other processes compile
        if (!it->is_regular_file(ignored)) continue;
        const auto size = it->file_size(ignored);
        if (!ignored) sum += size;
    }
    return sum;
}

}  // namespace

std::string process_environment(const char* name) {
    const char* value = std::getenv(name);
    return value != nullptr ? value : "";
}

Machine this_machine() {
    Machine machine;
    machine.threads = std::thread::hardware_concurrency();
    machine.memory_bytes =
        static_cast<std::uint64_t>(sysconf(_SC_PHYS_PAGES)) * static_cast<std::uint64_t>(sysconf(_SC_PAGESIZE));
    std::uint64_t limit = 0;
    if (std::ifstream("/sys/fs/cgroup/memory.max") >> limit) machine.memory_bytes = std::min(machine.memory_bytes, limit);
    return machine;
}

Finding examine_threads(const DeviceInfo& device, const Machine& machine, Environment environment) {
    Finding finding{"threads", fmt::format("{} of {}", device.compute_units, machine.threads), ""};
    if (device.compute_units >= machine.threads) return finding;
    const std::string set = first_set(environment, {"POCL_MAX_PTHREAD_COUNT", "POCL_CPU_MAX_CU_COUNT", "POCL_DEVICES"});
    if (!set.empty()) {
        finding.state += " (" + set + ")";
        finding.remedy = unset(set);
    } else {
        finding.remedy = "let the process use all cores (taskset, the container's limits)";
    }
    return finding;
}

Finding examine_simd(const DeviceInfo& device, Environment environment) {
    const unsigned width = device.native_float_width;
    Finding finding{"SIMD", fmt::format("{} floats ({} bits)", width, 32 * width), ""};
    const std::string set = first_set(environment, {"POCL_LLVM_CPU_NAME", "POCL_KERNELLIB_NAME"});
    if (!set.empty()) {
        finding.state += ", but kernels are compiled for " + set;
        finding.remedy = unset(set);
    } else if (width < 4) {
        finding.remedy = "use an OpenCL driver that knows this CPU's vector instructions: apt-get install pocl-opencl-icd";
    }
    return finding;
}

Finding examine_vectorisation(Environment environment) {
    Finding finding{"vectorisation", "on", ""};
    // PoCL vectorises with its default method and with no other.
    const std::string set = first_set(environment, {"POCL_WORK_GROUP_METHOD"});
    if (set.empty()) return finding;
    finding.state = "off (" + set + ")";
    finding.remedy = unset(set);
    return finding;
}

Finding examine_memory(const DeviceInfo& device, const Machine& machine, Environment environment) {
    Finding finding{"memory",
                    fmt::format("{} reported by the device, {} in one buffer; the machine has {}",
                                format_bytes(device.memory_bytes), format_bytes(device.max_allocation_bytes),
                                format_bytes(machine.memory_bytes)),
                    ""};
    const std::string set = first_set(environment, {"POCL_MEMORY_LIMIT"});
    if (set.empty()) return finding;
    finding.state += " (" + set + ", in GiB)";
    finding.remedy = unset(set) + ", or raise it";
    return finding;
}

Finding examine_cache(const std::string& folder, Environment environment) {
    Finding finding{"kernel cache", folder, ""};
    if (environment("POCL_KERNEL_CACHE") == "0") {
        finding.state = "off (POCL_KERNEL_CACHE=0): every run compiles its kernels again";
        finding.remedy = "unset POCL_KERNEL_CACHE";
        return finding;
    }
    std::error_code error;
    fs::create_directories(folder, error);
    if (!fs::is_directory(folder, error)) {
        finding.state += ": no such folder, and it could not be created";
        finding.remedy = "set POCL_CACHE_DIR to a folder that can be written";
        return finding;
    }
    if (access(folder.c_str(), R_OK | W_OK | X_OK) != 0) {
        finding.state += ": not writable, every run compiles its kernels again";
        finding.remedy = "chown or chmod it, or set POCL_CACHE_DIR to a folder that can be written";
        return finding;
    }
    const fs::space_info space = fs::space(folder, error);
    finding.state += ", " + format_bytes(folder_bytes(folder));
    // A scene's kernels take a few MiB; PoCL aborts when it cannot store one.
    constexpr std::uintmax_t least_free_bytes = std::uintmax_t{64} << 20;
    if (!error && space.available < least_free_bytes) {
        finding.state += fmt::format(", only {} free", format_bytes(space.available));
        finding.remedy = "free some disk space, or set POCL_CACHE_DIR to a folder on another disk";
    }
    return finding;
}

Finding examine_compiler(const Device& device) {
    Finding finding{"compiler", "", ""};
    const auto start = std::chrono::steady_clock::now();
    try {
        const Program program(device, "kernel void doctor(global float* x) { x[get_global_id(0)] += 1.0f; }\n", "doctor.cl");
        Kernel kernel(program, "doctor");
        const Buffer buffer(device, sizeof(float));
        kernel.set(0, buffer.memory());
        kernel.launch(device, 1);
        device.finish();
        if (buffer.view<float>()[0] == 1.0F) {
            const std::chrono::duration<double> passed = std::chrono::steady_clock::now() - start;
            finding.state = fmt::format("a kernel compiled and ran in {:.3f} s", passed.count());
            return finding;
        }
        finding.state = "a kernel ran and gave a wrong result";
    } catch (const ClError& error) {
        finding.state = error.what();
    }
    finding.remedy = "delete the kernel cache; if that does not help: apt-get install --reinstall pocl-opencl-icd libpocl2";
    return finding;
}

}  // namespace wavelobe
