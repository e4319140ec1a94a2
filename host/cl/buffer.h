// A device buffer in host memory: on a CPU both are the same bytes and nothing is copied.
#pragma once

#include <cstring>
#include <span>

#include "cl/device.h"

namespace wavelobe {

// Memory aligned to huge pages, zero-filled, shared with the device.
class Buffer {
public:
    // Throws ClError if `bytes` exceeds the device's largest allocation or memory is short.
    Buffer(const Device& device, std::size_t bytes);

    template <class T>
    static Buffer of(const Device& device, std::span<const T> values) {
        static_assert(std::is_trivially_copyable_v<T>);
        Buffer buffer(device, values.size_bytes());
        if (!values.empty()) std::memcpy(buffer.host_.get(), values.data(), values.size_bytes());
        return buffer;
    }

    cl_mem memory() const { return memory_.get(); }
    std::size_t bytes() const { return bytes_; }

    // The bytes as the host may read and write them while no kernel runs (after Device::finish).
    template <class T>
    std::span<T> view() const {
        return {reinterpret_cast<T*>(host_.get()), bytes_ / sizeof(T)};
    }

private:
    struct Free {
        void operator()(std::byte* pointer) const;
    };
    std::unique_ptr<std::byte, Free> host_;  // outlives memory_
    ClMemory memory_;
    std::size_t bytes_ = 0;
};

}  // namespace wavelobe
