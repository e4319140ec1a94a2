// A probe: a kernel of a few lines that includes a production header and maps inputs to outputs.
//
//     Probe probe(R"(
//         #include "core/math.h"
//         kernel void run(global const float *x, global float *y) {
//             size_t i = get_global_id(0) * LANES;
//             store(y + i, lane_exp2(load(x + i)));
//         })", {.lanes = 16});
//     probe.run("run", x.size() / 16, x, y);     // vectors in order of the kernel's parameters; non-const ones come back
#pragma once

#include <algorithm>
#include <cstdlib>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "cl/buffer.h"
#include "cl/device.h"
#include "cl/program.h"

namespace wavelobe::test {

inline Device& device() {
    static Device instance;
    return instance;
}

// Under an interpreter that looks for memory errors (scripts/memcheck) a few of the work-items do. Values are wrong then.
inline std::optional<std::size_t> most_items() {
    const char* most = std::getenv("WAVELOBE_PROBE_ITEMS");
    return most == nullptr ? std::nullopt : std::optional<std::size_t>(std::strtoul(most, nullptr, 10));
}

inline bool values_are_judged() { return !most_items(); }
inline std::size_t items_to_run(std::size_t items) { return std::min(items, most_items().value_or(items)); }

struct ProbeOptions {
    int lanes = 16;
    std::string defines;  // such as "-DHAS_TEXTURES=1"
};

class Probe {
public:
    explicit Probe(std::string_view source, const ProbeOptions& options = {})
        : program_(device(), source, "probe.cl", "-DLANES=" + std::to_string(options.lanes) + " " + options.defines) {}

    // Runs `items` work-items. Arguments: std::vector<T> (const: read only), or scalars.
    template <class... Arguments>
    void run(const char* kernel_name, std::size_t items, Arguments&... arguments) {
        Kernel kernel(program_, kernel_name);
        std::vector<Buffer> buffers;
        buffers.reserve(sizeof...(arguments));
        cl_uint index = 0;
        (pass(kernel, index++, buffers, arguments), ...);
        kernel.launch(device(), items_to_run(items));
        device().finish();
        std::size_t next = 0;
        (fetch(buffers, next, arguments), ...);
    }

    const std::string& log() const { return program_.log(); }

private:
    template <class T>
    static void pass(Kernel& kernel, cl_uint index, std::vector<Buffer>& buffers, const std::vector<T>& values) {
        buffers.push_back(Buffer::of<T>(device(), values));
        kernel.set(index, buffers.back().memory());
    }
    template <class T>
    static void pass(Kernel& kernel, cl_uint index, std::vector<Buffer>&, const T& value) {
        kernel.set(index, value);
    }
    template <class T>
    static void fetch(std::vector<Buffer>& buffers, std::size_t& next, std::vector<T>& values) {
        const auto view = buffers[next++].view<T>();
        std::copy_n(view.begin(), values.size(), values.begin());
    }
    template <class T>
    static void fetch(std::vector<Buffer>&, std::size_t& next, const std::vector<T>&) {
        ++next;
    }
    template <class T>
    static void fetch(std::vector<Buffer>&, std::size_t&, const T&) {}

    Program program_;
};

}  // namespace wavelobe::test
