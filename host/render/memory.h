// What a scene takes of the machine's memory, known before its hierarchy is built.
#pragma once

#include <cstdint>

#include "render/flatten.h"

namespace wavelobe {

struct MemoryEstimate {
    std::uint64_t device_bytes = 0;  // of the kernels' buffers
    std::uint64_t peak_bytes = 0;    // of the process at its largest, kernels compiled before: buffers, the scene itself, and what builds the hierarchy
};

MemoryEstimate estimate_memory(const Scene& scene, const DeviceScene& data);

// Throws InputError, with the sum, where the machine has less than that.
void refuse_beyond(const MemoryEstimate& estimate, std::uint64_t memory_bytes);

// Of the machine; as much as can be where it does not say.
std::uint64_t physical_memory();

}  // namespace wavelobe
