// A program built from kernel sources, and its kernels with arguments bound by name.
#pragma once

#include <map>
#include <string>
#include <string_view>

#include "cl/buffer.h"

namespace wavelobe {

// Named buffers: each kernel takes those whose names it declares as parameters.
using BufferTable = std::map<std::string, const Buffer*, std::less<>>;

class Program {
public:
    // `source` may include embedded kernel files. Throws ClError with the build log.
    Program(const Device& device, std::string_view source, std::string_view name, const std::string& options = {});

    cl_program handle() const { return program_.get(); }
    const std::string& log() const { return log_; }  // warnings

private:
    ClProgram program_;
    std::string log_;
};

class Kernel {
public:
    Kernel(const Program& program, const char* name);

    const std::string& name() const { return name_; }
    cl_kernel handle() const { return kernel_.get(); }

    // Binds every parameter to the buffer of its name. Throws ClError naming one that is not in the table.
    void bind(const BufferTable& buffers);

    template <class T>
    void set(cl_uint index, const T& value) {
        CL_CHECK(clSetKernelArg(kernel_.get(), index, sizeof value, &value));
    }

    // Work-items in groups of one: each owns a block of paths.
    ClEvent launch(const Device& device, std::size_t items);

private:
    std::string name_;
    ClKernel kernel_;
};

// Start to end on the device. Call after Device::finish.
double event_seconds(const ClEvent& event);

}  // namespace wavelobe
