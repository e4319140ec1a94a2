#include "cl/program.h"

#include "cl/kernel_source.h"

namespace wavelobe {
namespace {

std::string build_log(cl_program program, cl_device_id device) {
    std::size_t size = 0;
    CL_CHECK(clGetProgramBuildInfo(program, device, CL_PROGRAM_BUILD_LOG, 0, nullptr, &size));
    std::string log(size, '\0');
    CL_CHECK(clGetProgramBuildInfo(program, device, CL_PROGRAM_BUILD_LOG, size, log.data(), nullptr));
    while (!log.empty() && (log.back() == '\0' || log.back() == '\n')) log.pop_back();
    return log;
}

std::string argument_name(cl_kernel kernel, cl_uint index) {
    char name[128] = {};
    CL_CHECK(clGetKernelArgInfo(kernel, index, CL_KERNEL_ARG_NAME, sizeof name, name, nullptr));
    return name;
}

}  // namespace

Program::Program(const Device& device, std::string_view source, std::string_view name, const std::string& options) {
    const std::string text = flatten_includes(source, name);
    const char* pointer = text.c_str();
    cl_int code = CL_SUCCESS;
    program_.reset(clCreateProgramWithSource(device.context(), 1, &pointer, nullptr, &code));
    cl_check(code, "clCreateProgramWithSource");
    const std::string all = "-cl-std=CL1.2 -cl-kernel-arg-info " + options;
    const cl_device_id id = device.id();
    code = clBuildProgram(program_.get(), 1, &id, all.c_str(), nullptr, nullptr);
    log_ = build_log(program_.get(), id);
    if (code != CL_SUCCESS) {
        throw ClError("building the kernels of " + std::string(name) + " failed: " + cl_error_name(code) + "\n" + log_);
    }
}

Kernel::Kernel(const Program& program, const char* name) : name_(name) {
    cl_int code = CL_SUCCESS;
    kernel_.reset(clCreateKernel(program.handle(), name, &code));
    if (code != CL_SUCCESS) throw ClError("kernel " + name_ + " could not be created: " + cl_error_name(code));
}

void Kernel::bind(const BufferTable& buffers) {
    cl_uint count = 0;
    CL_CHECK(clGetKernelInfo(kernel_.get(), CL_KERNEL_NUM_ARGS, sizeof count, &count, nullptr));
    for (cl_uint i = 0; i < count; ++i) {
        const std::string argument = argument_name(kernel_.get(), i);
        const auto found = buffers.find(argument);
        if (found == buffers.end()) throw ClError("kernel " + name_ + ": no buffer named " + argument);
        set(i, found->second->memory());
    }
}

ClEvent Kernel::launch(const Device& device, std::size_t items) {
    const std::size_t group = 1;
    cl_event event = nullptr;
    CL_CHECK(clEnqueueNDRangeKernel(device.queue(), kernel_.get(), 1, nullptr, &items, &group, 0, nullptr, &event));
    return ClEvent(event);
}

double event_seconds(const ClEvent& event) {
    cl_ulong start = 0;
    cl_ulong end = 0;
    CL_CHECK(clGetEventProfilingInfo(event.get(), CL_PROFILING_COMMAND_START, sizeof start, &start, nullptr));
    CL_CHECK(clGetEventProfilingInfo(event.get(), CL_PROFILING_COMMAND_END, sizeof end, &end, nullptr));
    return static_cast<double>(end - start) * 1e-9;
}

}  // namespace wavelobe
