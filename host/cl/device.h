// The OpenCL device everything runs on: one context, one in-order profiling queue.
#pragma once

#include <CL/cl.h>

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <type_traits>
#include <vector>

#include "cl/error.h"

namespace wavelobe {

struct DeviceOptions {
    int threads = 0;          // compute threads; 0: all cores
    std::string name;         // part of a device's or platform's name; empty: the first CPU device
};

template <class T, cl_int (*release)(T)>
struct ClReleaser {
    using pointer = T;
    void operator()(T handle) const { release(handle); }
};
using ClContext = std::unique_ptr<cl_context, ClReleaser<cl_context, clReleaseContext>>;
using ClQueue = std::unique_ptr<cl_command_queue, ClReleaser<cl_command_queue, clReleaseCommandQueue>>;
using ClMemory = std::unique_ptr<cl_mem, ClReleaser<cl_mem, clReleaseMemObject>>;
using ClProgram = std::unique_ptr<cl_program, ClReleaser<cl_program, clReleaseProgram>>;
using ClKernel = std::unique_ptr<cl_kernel, ClReleaser<cl_kernel, clReleaseKernel>>;
using ClEvent = std::unique_ptr<cl_event, ClReleaser<cl_event, clReleaseEvent>>;

struct DeviceInfo {
    std::string name;
    std::string platform;  // with its version
    std::string driver;
    std::uint64_t memory_bytes = 0;          // as the device reports it
    std::uint64_t max_allocation_bytes = 0;  // largest single buffer
    unsigned compute_units = 0;
    unsigned native_float_width = 0;
};

class Device {
public:
    // Sets the variables PoCL reads (thread count, cache folder) and opens the device. They are read when OpenCL is first
    // touched: a process opens one device. Throws ClError if there is none that fits, naming those there are.
    explicit Device(const DeviceOptions& options = {});

    cl_context context() const { return context_.get(); }
    cl_command_queue queue() const { return queue_.get(); }
    cl_device_id id() const { return id_; }
    const DeviceInfo& info() const { return info_; }
    void finish() const { CL_CHECK(clFinish(queue_.get())); }

private:
    cl_device_id id_ = nullptr;
    ClContext context_;
    ClQueue queue_;
    DeviceInfo info_;
};

// Folder of compiled kernels: $POCL_CACHE_DIR, or `wavelobe/pocl` in the user's cache folder.
std::string kernel_cache_folder();

}  // namespace wavelobe
