// What can be wrong with the set-up of OpenCL, and how to mend it.
#pragma once

#include <cstdint>
#include <string>

#include "cl/device.h"

namespace wavelobe {

struct Finding {
    std::string subject;  // such as `cache`
    std::string state;
    std::string remedy;   // empty: nothing is wrong
};

// Value of an environment variable; empty when it is not set.
using Environment = std::string (*)(const char* name);
std::string process_environment(const char* name);

struct Machine {
    unsigned threads = 0;            // of the hardware
    std::uint64_t memory_bytes = 0;  // physical, or the limit of the control group if that is lower
};
Machine this_machine();

Finding examine_threads(const DeviceInfo& device, const Machine& machine, Environment environment);
Finding examine_simd(const DeviceInfo& device, Environment environment);
Finding examine_vectorisation(Environment environment);
Finding examine_memory(const DeviceInfo& device, const Machine& machine, Environment environment);
Finding examine_cache(const std::string& folder, Environment environment);  // creates it, as rendering does

// Compiles and runs a kernel.
Finding examine_compiler(const Device& device);

}  // namespace wavelobe
